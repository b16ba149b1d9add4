"""A replay rate by a law: paths and tape at another phase than the time."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import somersault as so
from somersault.attitude import angle_rates, unwrapped_angles
from somersault.flight import Flight, joint_power
from somersault.motion import moves
from somersault.motion import value as on_path

AXES = (2, 1, 3)
ARMS = {
    "left_shoulder": [(0.1, 1.4), (0.35, 0.3), (0.6, 0.9)],
    "right_shoulder": [(0.0, -1.4), (0.25, -1.0), (0.5, -0.2)],
}
TAKEOFF = so.Takeoff(spin=8.0, tilt=0.02)
LAW = "1 + k * somersault_error - 0.3 * tilt_error + c * twist_rate_error + 0.2 * sin(9 * phase)"
GAINS = {"k": 0.8, "c": 0.05}


def arms(replay: so.Replay | None = None, duration: float = 0.8, **more) -> so.Maneuver:
    takeoff = replace(TAKEOFF, replay=replay)
    return so.Maneuver.moves("furrer", ARMS, takeoff, duration, accuracy=1e-11, **more)


def soft(replay: so.Replay | None = None, **more) -> so.Maneuver:
    return arms(replay, **more).compliant(25.0, pose={"shoulder": 1.0})


def apart(one: Flight, two: Flight) -> float:
    """The angle between two attitudes at the end, rad."""
    dot = abs(float(one.landing.quaternion @ two.landing.quaternion))
    return 2 * float(np.arccos(min(dot, 1.0))) if dot < 1 - 1e-14 else 0.0


def landed(flight: Flight) -> np.ndarray:
    end = flight.landing
    return np.array([end.somersault, end.tilt, end.twist, *end.joints.values()])


# ------------------------------------------------------------------------------- identities


@pytest.mark.parametrize("maneuver", [arms, soft], ids=["prescribed", "compliant"])
def test_zero_gains_are_no_replay(maneuver) -> None:
    off = {"tilt": 0.05, "twist": -0.04}
    without = maneuver().off_nominal(**off).fly()
    law = so.Replay(law="1 + k * somersault_error + c * twist_rate_error", gains={"k": 0, "c": 0})
    with_law = maneuver(law).off_nominal(**off).fly()
    np.testing.assert_allclose(landed(with_law), landed(without), rtol=0, atol=1e-9)
    np.testing.assert_allclose(with_law.phase, with_law.times, rtol=0, atol=1e-14)
    assert np.all(with_law.phase_rate == 1)


@pytest.mark.parametrize("rate", [0.7, 1.25, 2.0])
def test_a_constant_rate_is_the_motion_in_another_time(rate: float) -> None:
    constant = arms(so.Replay(law=str(rate), rate=rate)).fly()
    scaled = arms().scaled(1 / rate).changed(duration=0.8).fly()
    np.testing.assert_allclose(landed(constant), landed(scaled), rtol=0, atol=1e-10)
    np.testing.assert_allclose(constant.phase, rate * constant.times, rtol=0, atol=1e-14)
    assert constant.momentum_drift < 1e-12


def test_a_rate_and_a_momentum_that_are_scaled_scale_all() -> None:
    """With 1.25 times the momentum, a motion 1.25 times as fast goes through the same attitudes."""
    rate, times = 1.25, np.linspace(0.0, 0.6, 25)
    slow = so.with_momentum("furrer", arms().takeoff)
    fast = replace(
        slow, angular_momentum=tuple(rate * h for h in slow.angular_momentum),
        replay=so.Replay(law="1.25", rate=rate),
    )  # fmt: skip
    one = so.Maneuver("furrer", slow, 0.6, accuracy=1e-11, samples=times).fly()
    two = so.Maneuver("furrer", fast, 0.6 / rate, accuracy=1e-11, samples=times / rate).fly()
    np.testing.assert_allclose(two.angles, one.angles, rtol=0, atol=1e-10)
    np.testing.assert_allclose(two.angular_velocity, rate * one.angular_velocity, atol=1e-8)


def test_the_nominal_flight_has_no_errors() -> None:
    """A law of errors alone changes nothing where there are none, prescribed and compliant."""
    law = "1 + k * (somersault_error + twist_error) + tilt_rate_error"
    law = so.Replay(law=law, gains={"k": 2.0})
    for maneuver in (arms, soft):
        np.testing.assert_allclose(
            landed(maneuver(law).fly()), landed(maneuver().fly()), rtol=0, atol=1e-9
        )


def test_errors_are_against_the_nominal_flight_wherever_it_takes_off() -> None:
    """Of a start that is off, and in an ensemble of starts, they are those of the base takeoff."""
    replay = so.Replay(law=LAW, gains=GAINS)
    one = arms(replay).off_nominal(tilt=0.05)
    assert one.takeoff.replay.nominal_angles == (0.0, 0.02, 0.0)
    again = one.off_nominal(twist=0.1)  # is off by both now
    assert again.takeoff.replay.nominal_angles == (0.0, 0.02, 0.0)
    assert apart(one.fly(), arms(replay).fly()) > 1e-3


# --------------------------------------------------------------- against another integration


def by_scipy(flight: Flight, nominal: Flight, replay: so.Replay) -> tuple[np.ndarray, float]:
    """Attitude and phase at the end: the same joints moved by the same law, tick by tick, by
    SciPy; the body turns as its momentum bids."""
    equations = flight.system.equations
    paths = [
        moves(np.array([t for t, _ in ARMS[n]]), np.array([a for _, a in ARMS[n]])) for n in ARMS
    ]
    start, h = flight.start, flight.start.momentum

    def joints(phase: float, rate: float):
        both = np.array([on_path(path, phase) for path in paths])
        return both[:, 0], rate * both[:, 1]

    def omega(quaternion, q, u):
        w, x, y, z = quaternion / np.linalg.norm(quaternion)
        turn = np.array([
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ])  # fmt: skip
        speeds = np.concatenate([np.zeros(6), u])[None]
        of_joints = equations.momentum(q[None], speeds)[0, :3]
        return np.linalg.solve(equations.inertia(q[None])[0], turn.T @ h - of_joints)

    def slope(t, quaternion, clock):
        since, shown, rate, bend = clock
        by = t - since
        q, u = joints(shown + rate * by + bend * by**2 / 2, rate + bend * by)
        a, b, c = omega(quaternion, q, u)
        w, x, y, z = quaternion
        return 0.5 * np.array([
            -x * a - y * b - z * c, w * a + y * c - z * b,
            w * b + z * a - x * c, w * c + x * b - y * a,
        ])  # fmt: skip

    knots = np.unique([t for path in ARMS.values() for t, _ in path])
    quaternion, angles = start.quaternion, start.angles
    waiting = [replay.rate] * replay.waits
    shown, rate = 0.0, replay.rate
    of_nominal = np.concatenate(
        [nominal.angles, angle_rates(nominal.angles, nominal.angular_velocity, AXES)], 1
    )
    for tick in range(round(flight.times[-1] / replay.every)):
        t = tick * replay.every
        path = unwrapped_angles(quaternion[None] / np.linalg.norm(quaternion), AXES, angles)
        angles = path[0] + 2 * np.pi * np.round((angles - path[0]) / (2 * np.pi))
        q, u = joints(shown, rate)
        rates = angle_rates(angles[None], omega(quaternion, q, u)[None], AXES)[0]
        there = np.array([interpolated(nominal.times, x, shown) for x in of_nominal.T])
        error = np.concatenate([angles, rates]) - there
        waiting.append(
            1 + GAINS["k"] * error[0] - 0.3 * error[1] + GAINS["c"] * error[5]
            + 0.2 * np.sin(9 * shown)
        )  # fmt: skip
        bend = (np.clip(waiting.pop(0), replay.least, replay.most) - rate) / replay.every
        clock = (t, shown, rate, bend)
        roots = [x for k in knots for x in np.roots([bend / 2, rate, shown - k]).real]
        within = sorted({0.0, replay.every, *[x for x in roots if 0 < x < replay.every]})
        for a, b in pairwise(within):
            done = solve_ivp(
                slope, (t + a, t + b), quaternion, "DOP853", rtol=1e-12, atol=1e-13, args=(clock,)
            )
            quaternion = done.y[:, -1]
        shown, rate = (
            shown + rate * replay.every + bend * replay.every**2 / 2, rate + bend * replay.every,
        )  # fmt: skip
    return quaternion / np.linalg.norm(quaternion), shown


def interpolated(times: np.ndarray, values: np.ndarray, at: float) -> float:
    """By the polynomial of degree eleven through the twelve nearest points."""
    first = int(np.clip(np.searchsorted(times, at) - 6, 0, len(times) - 12))
    near = slice(first, first + 12)
    scaled = (times[near] - times[first]) / (times[first + 11] - times[first])
    x = (at - times[first]) / (times[first + 11] - times[first])
    return float(np.polynomial.Polynomial.fit(scaled, values[near], 11)(x))


def test_a_varying_rate_is_what_scipy_integrates() -> None:
    replay = so.Replay(law=LAW, gains=GAINS, every=0.04, delay=0.08)
    flight = arms(replay, duration=0.8).off_nominal(tilt=0.05, twist=0.1).fly()
    nominal = arms(duration=0.8, samples=np.linspace(0.0, 0.8, 1601)).fly()
    quaternion, phase = by_scipy(flight, nominal, replay)
    apart = min(
        np.linalg.norm(flight.landing.quaternion - sign * quaternion) for sign in (1.0, -1.0)
    )
    assert apart < 1e-7
    assert flight.phase[-1] == pytest.approx(phase, abs=1e-8)
    assert np.ptp(flight.phase_rate) > 0.2
    assert flight.momentum_drift < 1e-12


@pytest.mark.parametrize("maneuver", [arms, soft], ids=["prescribed", "compliant"])
def test_momentum_is_kept_and_work_is_energy(maneuver) -> None:
    """Between ticks and knots power is smooth: Gauss's rule there sums it up."""
    replay = so.Replay(law=LAW, gains=GAINS, every=0.05)
    times = np.arange(0.0, 0.8, 0.01)
    nodes, weights = np.polynomial.legendre.leggauss(6)
    at = (times[:, None] + 0.005 * (nodes + 1)).ravel()
    samples = np.concatenate([[0.0], at, [0.8]])
    flight = maneuver(replay, samples=samples).off_nominal(tilt=0.1, twist=0.1).fly()
    assert flight.momentum_drift < 1e-12
    power = joint_power(flight).sum("joint_speed").values[1:-1]
    work = float((power.reshape(-1, 6) * weights * 0.005).sum())
    gain = flight.kinetic_energy[-1] - flight.kinetic_energy[0]
    assert np.ptp(flight.phase_rate) > 0.2
    assert abs(gain) > 1.0
    assert work == pytest.approx(gain, abs=1e-4 * flight.kinetic_energy[0])


def test_joints_that_are_prescribed_have_no_jumps() -> None:
    samples = np.sort(np.concatenate([0.05 * np.arange(1, 16) + x for x in (-1e-9, 1e-9)]))
    replay = so.Replay(law=LAW, gains=GAINS, every=0.05)
    flight = arms(replay, samples=samples).off_nominal(tilt=0.1).fly()
    rates = flight.dataset["joint_rate"].values
    assert np.abs(rates[1::2] - rates[::2]).max() < 1e-6
    assert np.abs(np.diff(flight.phase_rate[::2])).max() > 1e-3


def test_bounds_are_kept() -> None:
    wild = so.Replay(law="1 + 50 * sin(30 * time)", least=0.8, most=1.3, most_acceleration=10.0)
    flight = arms(wild).fly(samples=801)
    rate = flight.phase_rate
    assert rate.min() == pytest.approx(0.8, abs=1e-12)
    assert rate.max() == pytest.approx(1.3, abs=1e-12)
    assert np.abs(np.diff(rate)).max() <= 10.0 * 0.001 + 1e-12


def test_until_its_delay_is_over_the_rate_stays() -> None:
    late = so.Replay(law="2", delay=0.4, rate=1.1)
    flight = arms(late).fly(samples=81)
    assert np.all(flight.phase_rate[flight.times <= 0.4] == 1.1)
    assert flight.phase_rate[-1] == 2.0


def test_what_is_over_is_held() -> None:
    """The tape and the paths end before the flight does, and nothing moves then."""
    flight = soft(so.Replay(law="2", rate=2.0), duration=1.5).fly()
    assert flight.phase[-1] == pytest.approx(3.0)
    assert flight.momentum_drift < 1e-11


# ------------------------------------------------------------------------------- many flights


def test_an_ensemble_flies_what_one_flight_does() -> None:
    replay = so.Replay(law=LAW, gains=GAINS, delay=0.04, noise={"somersault_error": 0.02})
    takeoff = so.with_momentum("furrer", soft(replay).takeoff)
    vary = {
        "off": so.Vary(adds_to="takeoff.tilt", uniform=[-0.1, 0.1]),
        "gain": so.Vary(sets="replay.gains.k", uniform=[-1.0, 1.0]),
        "senses": so.Vary(sets="replay.noise.somersault_error", uniform=[0.0, 0.05]),
        "which": so.Vary(sets="takeoff.noise", uniform=[0.0, 1.0]),
        "most": so.Vary(sets="replay.most", uniform=[1.1, 1.6]),
        "first": so.Vary(sets="replay.rate", uniform=[0.8, 1.1]),
    }
    runs = so.flight.flights("furrer", takeoff, 0.8, report=["twist", "tilt"], accuracy=1e-9)
    many = so.ensemble(runs, vary=vary, size=30, seed=3)
    again = so.ensemble(runs, vary=vary, size=30, seed=3, threads=1, chunk=7)
    np.testing.assert_array_equal(many.dataset["twist"], again.dataset["twist"])
    assert many.dataset["gain"].attrs["units"] == "1"
    for k in (0, 17, 29):
        row = {name: float(x) for name, x in many.dataset.isel(sample=k).items()}
        row |= {n: float(many.dataset[n][k]) for n in vary}
        its = replace(
            replay, gains={**GAINS, "k": row["gain"]}, most=row["most"], rate=row["first"],
            noise={"somersault_error": row["senses"]}, nominal_angles=(0.0, takeoff.tilt, 0.0),
            nominal_momentum=takeoff.angular_momentum,
        )  # fmt: skip
        one = replace(takeoff, tilt=takeoff.tilt + row["off"], replay=its, noise=row["which"])
        alone = so.ensemble(
            so.flight.flights("furrer", one, 0.8, report=["twist", "tilt"], accuracy=1e-9),
            vary={"nothing": so.Vary(adds_to="takeoff.tilt", values=[0.0])},
        ).dataset
        assert float(alone["twist"][0]) == row["twist"]
        flown = so.fly("furrer", one, 0.8, accuracy=1e-10)
        assert flown.landing.twist == pytest.approx(row["twist"], abs=1e-6)


def test_paths_that_are_varied_have_nominal_flights_of_their_own() -> None:
    """Each flight's errors are against its own motion: without another start there are none."""
    takeoff = so.with_momentum("furrer", soft().takeoff)
    law = so.Replay(law="1 + k * somersault_error + twist_error", gains={"k": 3.0})
    vary = {"later": so.Vary(adds_to="joints.left_shoulder.times", uniform=[0.0, 0.1])}
    one, two = (
        so.ensemble(
            so.flight.flights("furrer", t, 0.8, report=["twist"], accuracy=1e-10),
            vary=vary, size=12, seed=1,
        ).dataset["twist"].values
        for t in (takeoff, replace(takeoff, replay=law))
    )  # fmt: skip
    np.testing.assert_allclose(one, two, rtol=0, atol=1e-8)
    assert np.ptp(one) > 1e-2


def test_a_bound_without_a_rate_between_does_not_take_off() -> None:
    runs = so.flight.flights("furrer", arms(so.Replay(law="1")).takeoff, 0.3)
    vary = {"x": so.Vary(sets="replay.least", samples=[0.5, 1.2, 0.0])}
    with pytest.warns(so.SomersaultWarning):
        many = so.ensemble(runs, vary=vary)
    words = [runs.endings.words[int(code)] for code in many.dataset["ended"]]
    assert words == ["duration", "no takeoff", "no takeoff"]


# -------------------------------------------------------------------------------------- files


SPEC = """
model = "furrer"
duration = 0.8
[takeoff]
spin = 8.0
[joints.shoulder]
motion = "prescribed"
times = [0.1, 0.4]
angles = [1.4, 0.3]
[compliance]
natural_frequency = 25.0
pose = 0.1
[replay]
law = "1 + k * twist_error"
delay = 0.04
most = 1.5
[replay.gains]
k = 2.0
[off_nominal]
tilt = 0.05
"""


def test_a_spec_has_a_replay(tmp_path: Path) -> None:
    file = tmp_path / "replay.toml"
    file.write_text(SPEC)
    maneuver = so.Maneuver.read(file)
    assert maneuver.takeoff.replay.gains == {"k": 2.0}
    assert maneuver.takeoff.replay.nominal_angles == (0.0, 0.0, 0.0)
    maneuver.save(tmp_path / "again.toml")
    again = so.Maneuver.read(tmp_path / "again.toml")
    assert again.fly().landing.twist == maneuver.fly().landing.twist
    assert "phase" in maneuver.fly().dataset


MISTAKES = {
    "no law": ({}, "no formula"),
    "no number": ({"law": "1", "rate": "fast"}, "replay: rate"),
    "no rate above 0": ({"law": "1", "least": 0.0}, "least = 0"),
    "a rate beyond its bounds": ({"law": "1", "rate": 3.0}, "most = 2"),
    "an unknown quantity": ({"law": "1 + twirl"}, "neither a gain nor sensed"),
    "an idle gain": ({"law": "1", "gains": {"k": 1.0}}, "has the gain k"),
    "a gain that is sensed": ({"law": "phase", "gains": {"phase": 1.0}}, "also something"),
    "noise of what is not sensed": ({"law": "1", "noise": {"tilt": 1.0}}, "noise"),
    "half a tick": ({"law": "1", "every": 0.02, "delay": 0.03}, "no whole number"),
    "a negative bound": ({"law": "1", "most_acceleration": -1.0}, "negative most_acceleration"),
    "half a nominal flight": ({"law": "1", "nominal_angles": (0, 0, 0)}, "give both"),
}


@pytest.mark.parametrize("what", MISTAKES)
def test_bad_replays_are_refused_in_a_sentence(what: str) -> None:
    numbers, words = MISTAKES[what]
    with pytest.raises(so.SomersaultError, match=words):
        arms(so.Replay(**numbers)).fly()


def test_what_cannot_be_replayed_is_refused_in_a_sentence() -> None:
    with pytest.raises(so.SomersaultError, match="nothing to replay"):
        so.fly("furrer", so.Takeoff(spin=8.0, replay=so.Replay(law="1")))
    with pytest.raises(so.SomersaultError, match=r"somersault\.Replay"):
        so.Takeoff(replay="1")
    of_arm = so.JointTakeoff.torque_law(law="twist", stiffness=1.0)
    left = so.JointTakeoff.prescribed(times=[0.1, 0.3], angles=[1.0, 0.2])
    joints = {"left_shoulder": left, "right_shoulder": of_arm}
    with pytest.raises(so.SomersaultError, match="has a law too"):
        so.fly("furrer", replace(TAKEOFF, joints=joints, replay=so.Replay(law="1 + twist_error")))
    seldom = so.Replay(law="1 + twist", every=0.05)
    with pytest.raises(so.SomersaultError, match="same ticks"):
        so.fly("furrer", replace(TAKEOFF, joints=joints, replay=seldom))
    fine = replace(TAKEOFF, joints=joints, replay=so.Replay(law="1 + 0.1 * twist"))
    assert so.fly("furrer", fine).momentum_drift < 1e-10
    times = np.linspace(0.0, 1.0, 101)
    recorded = so.sampled_motion("furrer", times, {"left_shoulder": np.sin(times)})
    joints = so.prescribed("furrer", recorded)
    fast = replace(TAKEOFF, joints=joints, replay=so.Replay(law="1", most=2.0))
    with pytest.raises(so.SomersaultError, match="recorded from"):
        so.fly("furrer", fast, 0.6)
    assert so.fly("furrer", fast, 0.5).ended == "duration"


def test_errors_stay_those_against_the_maneuver_that_was_replayed() -> None:
    """Whatever becomes of its takeoff; a takeoff that has the replay itself is its own nominal."""
    law = so.Replay(law="1 + k * somersault_error", gains={"k": 1.0})
    pinned = arms().replayed(law).takeoff
    assert pinned.replay.nominal_angles == (0.0, 0.02, 0.0)
    for spin, bends in ((8.0, False), (9.0, True)):
        faster = so.fly("furrer", replace(pinned, spin=spin), 0.5)
        assert (np.ptp(faster.phase_rate) > 0.01) == bends
    alone = so.fly("furrer", replace(pinned, spin=9.0, replay=law), 0.5)
    assert np.ptp(alone.phase_rate) < 1e-9
