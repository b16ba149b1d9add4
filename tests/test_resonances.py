"""Resonances of a spin's modes: which there are, which a mirror forbids, which burst, and when.

References: the closed form of a rigid body's frequencies, sums over all whole numbers, the signs of
the cubic terms themselves, and flights.
"""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import product
from math import gcd

import numpy as np
import pytest
from scipy.optimize import brentq

import somersault as so
from somersault import stability as st
from somersault.cli import main
from somersault.model import Model
from somersault.stability import LinearSpin, _burst, _reduced_motion, _resonances
from somersault.stability._reflection import parities

DOLL, ARMS, RATE = "doll_weighted", 1.6, 16.6


def layout(stiffness: float, model: str | Model = "furrer", angle: float = 1.3) -> LinearSpin:
    pose = {"left_shoulder": angle, "right_shoulder": -angle}
    return so.spin(model, pose=pose).linear(dict.fromkeys(pose, stiffness))


def detuned(stiffness: float) -> float:
    """ω_s − 2 ω_1 of the doll."""
    found, *_ = layout(stiffness, DOLL, ARMS).resonances(order=3, within=0.5)
    return -found.detuning


# ----------------------------------------------------------------------------- which there are


def test_combinations_are_all_sums_that_can_vanish() -> None:
    """Against every vector of whole numbers, one by one."""
    odd, order = (True, True, False, False), 5
    found = {c.counts: c.order for c in _resonances.combinations(odd, order)}
    expected = {}
    for counts in product(range(-order, order + 1), repeat=4):
        size = sum(map(abs, counts))
        first = next((n for n in counts if n), 0)
        if not 2 <= size <= order or first < 0 or min(counts) >= 0 or gcd(*counts) > 1:
            continue
        doubled = size == 2 or (counts[0] + counts[1]) % 2
        if size * (1 + doubled) <= order:
            expected[counts] = size * (1 + doubled)
    assert found == expected


def test_three_waves_of_like_energy_only_exchange() -> None:
    like, unlike = np.array([1, 1]), np.array([-1, 1])
    two_to_one = _resonances.Combination((2, -1), 3)
    assert not two_to_one.explosive(like)
    assert two_to_one.explosive(unlike)
    assert two_to_one.explosive(-unlike)
    total = _resonances.Combination((1, 1, -1), 3)
    assert total.explosive(np.array([-1, -1, 1]))
    assert not total.explosive(np.array([-1, 1, 1]))


def test_a_rigid_body_has_one_mode_and_no_resonance() -> None:
    """ν = √(k1 k3) of the minor axis, and a definite energy."""
    book = so.spin("book", "minor").linear()
    ratios = so.spin("book", "minor").inertia_ratios
    (mode,) = (m for m in book.modes if m.energy)
    assert mode.root.imag == pytest.approx(np.sqrt(ratios["k1"] * ratios["k3"]), rel=1e-12)
    assert mode.energy == -1  # a maximum of the energy
    assert book.resonances(order=8, within=10.0) == ()


def test_a_definite_spin_has_no_explosive_resonance() -> None:
    wheel = so.spin("furrer", 1, pose={"shoulder": 1.3}).linear({"shoulder": 1.0})
    assert wheel.energy_signature == "definite"
    found = wheel.resonances(order=6, within=0.5)
    assert found
    assert not any(each.explosive for each in found)


def test_dampers_are_left_aside() -> None:
    spin = so.spin("furrer", pose={"shoulder": 1.3})
    damped = spin.linear({"shoulder": 1.16}, {"shoulder": 0.5}).resonances(order=4)
    assert [r.words for r in damped] == [r.words for r in layout(1.16).resonances(order=4)]


# -------------------------------------------------------------------------------------- mirror


def test_the_mirror_forbids_cubic_terms_of_odd_modes() -> None:
    """ω2 = 2 ω1 of two odd modes: the terms are not there, and come with one arm heavier."""
    for model, there in (("doll", False), (heavier(), True)):
        spin = layout(1.0, model)
        slow, *_, fast = sorted(oscillations(spin), key=lambda m: m.root.imag)
        pair = st.Resonance((slow, fast), (2, -1), 3, 0.0, True)
        found, _ = _burst.two_to_one(_reduced_motion.reduced_motion(spin), pair)
        assert (found.strength > 1e-4) == there
        assert there or found.strength < 1e-9
    orders = [
        [c.order for c in _resonances.combinations(odd, 6) if c.counts == (2, -1)]
        for odd in ((True, True), (False, True), (True, False))
    ]
    assert orders == [[6], [6], [3]]


def heavier() -> Model:
    """A doll with one arm 1 % heavier than the other."""
    doll = so.load("doll")
    trunk, left, right = doll.bodies
    return replace(doll, bodies=(trunk, replace(left, mass=1.01 * left.mass), right))


def test_parities_are_seen() -> None:
    furrer, names = so.load("furrer"), layout(1.0).coordinates
    assert parities(furrer, 2, names, np.array([1.3, -1.3])).tolist() == [-1, -1, -1, 1, 1]
    assert not parities(furrer, 2, names, np.array([1.3, -1.2])).any()
    assert not parities(heavier(), 2, names, np.array([1.3, -1.3])).any()
    # Across axis 1 the mirror leaves the arms, which move in its plane.
    wheel = so.spin("furrer", 1, pose={"shoulder": 1.3}).linear()
    signs = parities(furrer, 1, wheel.coordinates, np.array([1.3, -1.3]))
    assert dict(zip(wheel.coordinates, signs.tolist(), strict=True)) == {
        "somersault": -1, "twist": -1, "tilt": 1, "antisymmetric shoulder": 1,
        "symmetric shoulder": 1,
    }  # fmt: skip


def test_unlike_springs_lift_the_rule() -> None:
    spin = so.spin("furrer", pose={"shoulder": 1.3})
    unlike = spin.linear({"left_shoulder": 1.15, "right_shoulder": 1.17})
    assert len(unlike.resonances(4, 0.5)) > len(layout(1.16).resonances(4, 0.5))


# --------------------------------------------------------------------------------------- chart


def test_a_chart_has_what_its_spins_have() -> None:
    angles, springs = np.linspace(1.1, 1.5, 5), np.linspace(0.9, 1.3, 21)
    chart = st.chart(
        "furrer", ("pose.shoulder", angles), ("stiffness.shoulder", springs), resonances=4
    )
    named = "2 × tilt 1 = somersault 1"
    assert named in chart.resonance.values
    assert int(chart.order.sel(resonance=named)) == 3
    assert not np.isfinite(chart.frequency.values[:, ~chart.stable.values]).any()
    i, j = 13, 2
    assert chart.stable.values[i, j]
    spin = layout(float(springs[i]), angle=float(angles[j]))
    modes = {m.root.imag: m.energy for m in spin.modes if m.energy}
    got = dict(zip(chart.frequency.values[:, i, j], chart.mode_energy.values[:, i, j], strict=True))
    assert sorted(got) == pytest.approx(sorted(modes), abs=1e-9)
    assert [got[k] for k in sorted(got)] == [modes[k] for k in sorted(modes)]
    for found in spin.resonances(order=4, within=0.2):
        sizes = abs(chart.detuning.values[:, i, j])
        at = int(np.argmin(abs(sizes - abs(found.detuning))))
        if sizes[at] == pytest.approx(abs(found.detuning), abs=1e-9):
            assert bool(chart.explosive.values[at, i, j]) == found.explosive


def test_no_chart_of_a_definite_spin_shows_an_explosive_one() -> None:
    chart = st.chart(
        "furrer", ("pose.shoulder", np.linspace(0.5, 2.0, 7)),
        ("stiffness.shoulder", np.linspace(0, 3, 13)), axis=1, energy=True, resonances=5,
    )  # fmt: skip
    assert chart.definite.values[chart.stable.values].all()
    assert chart.sizes["resonance"]
    assert not chart.explosive.any()


# -------------------------------------------------------------------------------------- bursts


def test_the_whole_motion_has_the_modes_frequencies() -> None:
    """Not linearised, and differentiated by differences: other equations, the same roots."""
    spin = layout(1.1)
    motion = _reduced_motion.reduced_motion(spin)
    assert abs(motion.rates(motion.steady[None])).max() < 1e-14
    size, step = len(motion.steady), 1e-5
    moved = step * np.eye(size)
    slopes = (motion.rates(motion.steady + moved) - motion.rates(motion.steady - moved)) / step / 2
    found = np.sort(np.linalg.eigvals(slopes.T).imag)[-3:]
    assert found == pytest.approx(sorted(m.root.imag for m in spin.modes if m.energy), abs=1e-7)


def test_the_whole_motion_is_that_of_flights() -> None:
    """A twentieth of a turn from far away, by a high-order method, at another spin rate."""
    from scipy.integrate import solve_ivp

    spin = layout(1.1)
    motion = _reduced_motion.reduced_motion(spin)
    turned = np.array([0.3, 0.9, 0.2]) / np.linalg.norm([0.3, 0.9, 0.2])
    start = np.concatenate([turned, [0.1, -0.2], [0.3, 0.1]])
    end = solve_ivp(
        lambda _, y: motion.rates(y[None])[0], (0, 2.0), start, rtol=1e-11, atol=1e-12,
        method="DOP853",
    ).y[:, -1]  # fmt: skip
    h = spin.spin.principal_inertias[1] * RATE
    inertia = spin.spin.outboard_inertias["left_shoulder"]
    k = 1.1 * RATE**2 * inertia
    angles = spin.spin.pose + motion.moves @ start[3:5]
    rates = RATE * motion.moves @ start[5:]
    holding = spin.spin.holding_torques
    joints = {
        name: so.JointTakeoff(
            "sprung", angle=float(q), rate=float(v), stiffness=k,
            rest=float(rest + holding[name] * RATE**2 / k),
        )
        for name, q, v, rest in zip(
            spin.spin.model.speeds, angles, rates, spin.spin.pose, strict=True
        )
    }  # fmt: skip
    # h along inertial axis 2 in a body turned so that it has these components in its own axes.
    axis = np.cross(turned, [0, 1, 0])
    half = np.arccos(turned[1]) / 2
    quaternion = np.concatenate([[np.cos(half)], np.sin(half) * axis / np.linalg.norm(axis)])
    takeoff = so.Takeoff(
        quaternion=quaternion.tolist(), angular_momentum=(0.0, h, 0.0), joints=joints
    )
    flight = so.fly("furrer", takeoff, 2.0 / RATE, accuracy=1e-11)
    left, right = flight.dataset["joint_angle"].values[-1]
    assert motion.pose + motion.moves @ end[3:5] == pytest.approx([left, right], abs=1e-8)


@pytest.mark.parametrize("stiffness", [1.1, 1.16, 1.25])
def test_cubic_terms_agree_with_the_signs_of_energy(stiffness: float) -> None:
    """A B is real, and positive where the modes' energies have different signs."""
    spin = layout(stiffness)
    slow, even, _ = sorted(oscillations(spin), key=lambda m: m.root.imag)
    assert (slow.energy, even.energy) == (-1, 1)
    _, together = two_to_one(spin, slow, even)
    assert together > 0
    # With the arms stiff both are oscillations of positive energy about the axis of most inertia.
    wheel = so.spin("furrer", 1, pose={"shoulder": 1.3}).linear({"shoulder": 3.0})
    for fast in sorted(oscillations(wheel), key=lambda m: m.root.imag)[1:]:
        slow = min(oscillations(wheel), key=lambda m: m.root.imag)
        strength, together = two_to_one(wheel, slow, fast)
        assert together < 0 or strength < 1e-9


def two_to_one(spin: LinearSpin, slow: st.Mode, fast: st.Mode) -> tuple[float, float]:
    pair = st.Resonance((slow, fast), (2, -1), 3, 0.0, slow.energy != fast.energy)
    found, together = _burst.two_to_one(_reduced_motion.reduced_motion(spin), pair)
    return found.strength, together


def oscillations(spin: LinearSpin) -> list[st.Mode]:
    return [mode for mode in spin.modes if mode.energy]


@pytest.mark.parametrize("off", [0.0, 0.95, 1.05])
def test_width_and_turns_are_those_of_the_amplitude_equations(off: float) -> None:
    """Integrated, for some A and B with A B > 0, at a detuning of so many widths."""
    from scipy.integrate import solve_ivp

    a, b, size = 0.3j, -0.5j, 0.02
    burst = st.Burst(float(np.sqrt(abs(a * b))), 0.0, np.zeros(2))
    detuning = off * burst.width(size)

    def rates(_: float, y: np.ndarray) -> list[complex]:
        return [b * y[1] * y[0].conjugate(), 1j * detuning * y[1] + a * y[0] ** 2]

    def large(_: float, y: np.ndarray) -> float:
        return abs(y[0]) - 1e3 * size

    large.terminal = True  # type: ignore[attr-defined]
    turn = 2 * np.pi
    end = 20 * burst.turns(size) * turn
    found = solve_ivp(
        rates, (0, end), [size + 0j, 0j], events=large, rtol=1e-10, atol=1e-13, method="DOP853"
    )
    assert (found.status == 1) == (off < 1)
    if not off:
        assert found.t[-1] / turn == pytest.approx(burst.turns(size), rel=2e-3)


@pytest.mark.slow
def test_the_doll_bursts_when_the_cubic_terms_say() -> None:
    """At exact resonance, from four tilts: a quarter twist within a few turns of the prediction,
    and not at all where the detuning is twice the width."""
    exact = brentq(detuned, 0.95, 1.0, xtol=1e-10)
    spin = layout(exact, DOLL, ARMS)
    burst = st.burst(spin, spin.resonances(order=3)[0])
    inertia = spin.spin.outboard_inertias["left_shoulder"]
    for tilt in (0.0003, 0.001, 0.003):
        size = float(burst.amplitude(tilt=tilt))
        expected = burst.turns(size)
        slope = (detuned(exact + 1e-5) - detuned(exact - 1e-5)) / 2e-5
        for off, lasts in ((0.0, False), (2.0, True), (-2.0, True)):
            stiffness = exact + off * burst.width(size) / slope
            arms = so.JointTakeoff(
                "sprung", angle=ARMS, stiffness=stiffness * RATE**2 * inertia, hold=True
            )
            takeoff = so.Takeoff(
                tilt=tilt, joints={"shoulder": arms},
                angular_momentum=(0.0, RATE * float(spin.spin.principal_inertias[1]), 0.0),
            )  # fmt: skip
            flight = so.fly(
                DOLL, takeoff, 3 * expected * 2 * np.pi / RATE, accuracy=1e-11,
                until="quarter twist",
            )  # fmt: skip
            turns = flight.times[-1] * RATE / (2 * np.pi)
            if lasts:
                assert flight.ended == "duration"
            else:
                assert turns == pytest.approx(expected, rel=0.04)


def test_what_does_not_burst_is_refused() -> None:
    spin = layout(0.97)
    three_to_one, *_ = spin.resonances(order=4, within=0.01)
    assert three_to_one.explosive
    with pytest.raises(so.SomersaultError, match="no explosive 2 : 1"):
        st.burst(spin, three_to_one)
    doll = so.spin("doll_weighted", pose={"shoulder": 1.6}).linear({"shoulder": 0.98})
    of_another, *_ = doll.resonances(order=3)
    with pytest.raises(so.SomersaultError, match="of another spin"):
        st.burst(spin, of_another)
    with pytest.raises(so.SomersaultError, match="order"):
        spin.resonances(order=2)
    with pytest.raises(so.SomersaultError, match="not negative"):
        spin.resonances(within=-0.1)


def test_the_threshold_is_where_the_width_is_the_detuning() -> None:
    spin = layout(1.15)
    burst = st.burst(spin, spin.resonances(order=3)[0])
    assert burst.width(burst.threshold) == pytest.approx(abs(burst.detuning))
    assert burst.turns(0.01) == pytest.approx(2 * burst.turns(0.02))


def test_the_command_lists_those_that_are_near(capsys: pytest.CaptureFixture[str]) -> None:
    asked = ["stability", "furrer", "--pose", "shoulder=1.3", "--stiffness", "shoulder=1.16"]
    main(asked)
    assert "2 × 0.2683 ≈ 0.5371 Ω (3)  explosive" in capsys.readouterr().out
    main([*asked, "--json"])
    (first, *_) = json.loads(capsys.readouterr().out)["resonances"]
    assert (first["counts"], first["order"], first["explosive"]) == ([2, -1], 3, True)
    assert 2 * first["frequencies"][0] - first["frequencies"][1] == first["detuning"]
