"""Verdicts come from signs that can be known: error bounds, and the energy beneath them.

Reference: eigenvalues in forty digits by mpmath, of the whole second-order system, and the theorem
of Kelvin, Tait and Chetaev.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from test_stability import RANKS, numbers, tree

import somersault as so
from somersault.cli import main
from somersault.engine import use_threads
from somersault.model import Body, Joint, Model
from somersault.stability import LinearSpin, Spin, _growth, growth_rates, spin, stable_ranges

WHIPS = [f"whip{k}" for k in (1, 2, 3, 4)]


# --------------------------------------------------------------------------------- Explorer 1


def explorer() -> str:
    """A slender cylinder with four whip antennas on hinges, straight out from its waist."""
    whips = ""
    for k, name in enumerate(WHIPS):
        c, s = round(np.cos(k * np.pi / 2)), round(np.sin(k * np.pi / 2))
        whips += f"""<body name="{name}" pos="{0.075 * c} {0.075 * s} 0">
          <joint name="{name}" type="hinge" axis="{-s} {c} 0"/>
          <geom type="capsule" fromto="0 0 0 {0.56 * c} {0.56 * s} 0" size="0.003" mass="0.0235"
            contype="0" conaffinity="0"/>
        </body>"""
    return f"""<mujoco model="explorer"><worldbody><body name="body"><freejoint/>
      <geom type="cylinder" size="0.075 0.95" mass="13" contype="0" conaffinity="0"/>{whips}
    </body></worldbody></mujoco>"""


@pytest.fixture(scope="module")
def satellite(tmp_path_factory: pytest.TempPathFactory) -> Spin:
    path = tmp_path_factory.mktemp("explorer") / "explorer.xml"
    path.write_text(explorer())
    return spin(str(path), "minor")


def whips(satellite: Spin, stiffness: float, damping: float) -> LinearSpin:
    return satellite.linear(dict.fromkeys(WHIPS, stiffness), dict.fromkeys(WHIPS, damping))


def exact_roots(system: LinearSpin) -> list[mp.mpc]:
    """The 2n roots of the matrices as they stand, in forty digits."""
    with mp.workdps(40):
        m, c, k = (
            mp.matrix(a.tolist())
            for a in (system.M, system.G + system.D, system.K + system.K_springs)
        )
        n = len(system.M)
        first = mp.zeros(2 * n)
        below_x, below_v = -(m**-1 * k), -(m**-1 * c)
        for i in range(n):
            first[i, n + i] = 1
            for j in range(n):
                first[n + i, j], first[n + i, n + j] = below_x[i, j], below_v[i, j]
        return list(mp.eig(first, left=False, right=False))


def exact_growth(system: LinearSpin) -> float:
    """The largest of their real parts, without the drift's double zero and stroboscopic pair."""
    roots = exact_roots(system)
    for known in (0, 0, 1j, -1j):
        roots.remove(min(roots, key=lambda root, known=known: abs(root - known)))
    return max(float(root.real) for root in roots)


def first_order(undamped: LinearSpin, damping: np.ndarray) -> float:
    """Largest growth to first order in D: δs = −s vᴴDv / vᴴ(2 s M + G)v of each mode."""
    rates = []
    for mode in undamped.modes:
        v, s = mode.shape, mode.root
        if s.imag < 1e-6:
            continue
        change = -s * (v.conj() @ damping @ v) / (v.conj() @ (2 * s * undamped.M + undamped.G) @ v)
        rates.append(change.real)
    return max(rates)


def test_explorer_is_slender_and_stable_only_without_damping(satellite: Spin) -> None:
    inertias = np.sort(satellite.principal_inertias)
    assert inertias[2] / inertias[0] == pytest.approx(80, rel=0.05)
    still = whips(satellite, 2.0, 0.0)
    assert still.stable
    assert still.growth_rate == 0
    assert still.energy_signature == "gyroscopic"


@pytest.mark.parametrize("damping", [1e-20, 1e-14, 1e-9, 1e-6, 1e-4, 1e-2, 1.0, 100.0, 1e6])
def test_damped_whips_destroy_a_minor_axis_spin_however_slowly(
    satellite: Spin, damping: float
) -> None:
    system = whips(satellite, 2.0, damping)
    assert not system.stable
    assert system.growth_rate > 0
    assert "unstable, gyroscopic, grows one e-fold in" in repr(system)
    (growing,) = [mode for mode in system.modes if mode.root.real > 0]
    assert growing.name == "tilt–somersault growing oscillation"
    assert growing.energy == -1
    assert growing.root.real == pytest.approx(system.growth_rate, rel=1e-6)


@pytest.mark.parametrize("stiffness", [0.5, 2.0, 5.0])
def test_small_dampers_make_it_grow_in_proportion(satellite: Spin, stiffness: float) -> None:
    still = whips(satellite, stiffness, 0.0)
    for damping in (1e-16, 1e-10, 1e-7, 1e-5):
        system = whips(satellite, stiffness, damping)
        wanted = first_order(still, system.D)
        assert system.growth_rate == pytest.approx(wanted, rel=1e-6)


@pytest.mark.parametrize("damping", [1e-8, 1e-5, 1e-3, 0.1, 3.0])
def test_the_rate_is_that_of_forty_digits(satellite: Spin, damping: float) -> None:
    system = whips(satellite, 2.0, damping)
    assert system.growth_rate == pytest.approx(exact_growth(system), rel=1e-6)


def test_slow_growth_can_be_read(
    satellite: Spin, tmp_path: Path, capsys: pytest.CaptureFixture
) -> None:
    path = tmp_path / "explorer.xml"
    path.write_text(explorer())
    options = [
        "--stiffness",
        *(f"{w}=2" for w in WHIPS),
        "--damping",
        *(f"{w}=0.02" for w in WHIPS),
    ]
    assert main(["stability", str(path), "--axis", "minor", *options]) == 0
    said = capsys.readouterr().out
    turns = 1 / (2 * np.pi * whips(satellite, 2.0, 0.02).growth_rate)
    assert turns > 10_000
    assert f"unstable\n  grows one e-fold in {float(f'{turns:.3g}'):,.0f} turns\n" in said
    assert "× 1 in" not in said
    assert "would destroy" not in said
    assert "its dampers destroy it" in said


def test_one_damped_whip_is_enough(satellite: Spin) -> None:
    system = satellite.linear(dict.fromkeys(WHIPS, 2.0), {"whip2": 1e-9})
    assert system.growth_rate == pytest.approx(exact_growth(system), rel=1e-6)
    assert not system.stable


def test_dampers_that_the_wobble_does_not_move_do_no_harm(satellite: Spin) -> None:
    """A wheel about the axis of spin: the wobble of the minor axis leaves it alone."""
    wheel = Joint("wheel", "hinge", (0.0, 0.0, 1.0))
    round_ = ((0.01, 0.0, 0.0), (0.0, 0.01, 0.0), (0.0, 0.0, 0.02))
    slender = ((4.0, 0.0, 0.0), (0.0, 4.02, 0.0), (0.0, 0.0, 0.05))
    origin = (0.0, 0.0, 0.0)
    body = Body("body", -1, 13.0, origin, slender)
    model = Model("wheel", True, (body, Body("wheel", 0, 1.0, origin, round_, joints=(wheel,))))
    for stiffness in (0.0, 1.0):
        system = spin(model, "minor").linear({"wheel": stiffness}, {"wheel": 0.1})
        assert system.stable
        assert system.energy_signature == ("definite" if stiffness else "neutral")


# ----------------------------------------------------------------------------- random trees


@cache
def undamped(number: int) -> list[tuple[dict[str, float], LinearSpin]]:
    """Springs for a random tree, and the system that they make."""
    springs = [numbers(tree(number), *r, seed=number) for r in ((0, 2), (1, 4), (3, 30), (20, 90))]
    return [(k, tree(number).linear(k)) for k in springs]


@pytest.mark.parametrize("strength", [1e-15, 1e-12, 1e-9, 1e-6, 1e-3])
def test_kelvin_tait_and_chetaev_at_any_strength(strength: float) -> None:
    """Each negative direction of the energy has one root that grows, once dampers are pervasive:
    where there is one, the spin is unstable, and where there is none, stable."""
    seen = set()
    for number in range(12):
        damping = numbers(tree(number), strength, 2 * strength, number)
        for stiffness, still in undamped(number):
            if still.energy_signature not in ("definite", "gyroscopic"):
                continue
            seen.add(still.energy_signature)
            damped = tree(number).linear(stiffness, damping)
            assert damped.stable == (still.energy_signature == "definite")
            assert damped.energy_signature == still.energy_signature
            growing = sum(1 if m.root.imag == 0 else 2 for m in damped.modes if m.root.real > 0)
            assert growing == int(np.sum(still.potential < 0))
    assert seen == {"definite", "gyroscopic"}


@pytest.mark.parametrize("number", [0, 1, 3, 5])
def test_the_bound_of_each_root_holds(number: int) -> None:
    """Against forty digits, and with room to spare for the rounding of the matrices themselves."""
    for stiffness, still in undamped(number):
        for system in (still, tree(number).linear(stiffness, numbers(tree(number), 0, 0.1))):
            exact = np.array([complex(root) for root in exact_roots(system)])
            for part in system.system.parts():
                whole = _growth.reduced(part.scaled())
                values, vectors = np.linalg.eig(whole.matrix)
                bound = whole.noise * _growth.condition(vectors)
                wrong = np.abs(values[:, None] - exact).min(1)
                assert np.all(wrong < 0.1 * bound)
                assert bound.min() < 1e-10  # or nothing would ever be known


@pytest.mark.parametrize("number", [0, 1, 3, 5])
def test_the_verdict_is_the_exact_sign(number: int) -> None:
    for stiffness in [numbers(tree(number), -1, 1, seed) for seed in range(4)]:
        system = tree(number).linear(stiffness)
        exact = exact_growth(system)
        assert system.stable == (exact < 1e-9)
        assert system.growth_rate == pytest.approx(exact, rel=1e-6, abs=1e-9)


def test_edges_are_where_two_roots_meet() -> None:
    """A hair's breadth outside the growth is √, and known; inside there is none."""
    layout = spin("furrer", 2, {"shoulder": 1.3})
    ((low, high),) = stable_ranges(
        "furrer", ("stiffness.shoulder", -2.0, 4.0), pose={"shoulder": 1.3}
    )
    for edge, outward in ((low, -1e-8), (high, 1e-8)):
        assert layout.linear({"shoulder": edge - outward}).growth_rate == 0
        outside = layout.linear({"shoulder": edge + outward})
        assert 1e-5 < outside.growth_rate < 1e-3
        assert outside.growth_rate == pytest.approx(exact_growth(outside), rel=1e-3)


@pytest.mark.parametrize("rank", RANKS)
def test_a_chart_of_dampers_has_the_signs_of_single_spins(rank: str) -> None:
    """Many at once: the same rates, down to dampers whose growth no eigenvalue shows."""
    damping = np.logspace(-16, 1, 18)
    rates = growth_rates(
        "furrer", pose={"shoulder": 1.3}, stiffness={"shoulder": 1.2},
        damping={"shoulder": damping}, axis=rank,
    )  # fmt: skip
    steady = spin("furrer", rank, {"shoulder": 1.3})
    for b, rate in zip(damping, rates, strict=True):
        one = steady.linear({"shoulder": 1.2}, {"shoulder": b})
        assert rate == pytest.approx(one.growth_rate, rel=1e-6)
        assert np.sign(rate) == np.sign(one.growth_rate)


def test_stiff_springs_do_not_hide_slow_growth() -> None:
    """One spring a billion times as stiff as another leaves the slow roots as they are known."""
    still = spin("furrer", 2, {"shoulder": 1.3})
    free = {"left_shoulder": 1e8, "right_shoulder": 1.2}
    system = still.linear(free)
    assert system.growth_rate == pytest.approx(exact_growth(system), rel=1e-6)


# ------------------------------------------------------------------------------------ threads


def test_one_thread_is_one_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    """What `use_threads` says goes for eigenvalues too, and they do not depend on it."""
    angles = np.linspace(0, 3, 5000)
    many = growth_rates("furrer", pose={"shoulder": angles}, damping={"shoulder": 0.1})

    def none() -> None:
        raise AssertionError("a pool was asked for")

    monkeypatch.setattr(_growth, "pool", none)
    monkeypatch.setattr("somersault.engine._threads.pool", none)
    with use_threads(1):
        one = growth_rates("furrer", pose={"shoulder": angles}, damping={"shoulder": 0.1})
    assert np.array_equal(one, many)


def test_a_ball_joints_torque_has_no_energy_to_argue_with() -> None:
    """Its K is not symmetric, so that only what eigenvalues show counts."""
    box = ((0.2, 0.0, 0.0), (0.0, 0.3, 0.0), (0.0, 0.0, 0.4))
    arm = Body(
        "arm", 0, 1.0, (0.3, 0.1, 0.0), box, (0.1, 0.2, 0.1), joints=(Joint("ball", "ball"),)
    )
    model = Model("ball", True, (Body("body", -1, 5.0, (0.0, 0.0, 0.0), box), arm))
    system = so.spin(model, "major").linear({"ball": 4.0}, {"ball": 0.1})
    assert system.growth_rate == pytest.approx(exact_growth(system), abs=1e-9)
