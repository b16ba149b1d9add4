"""Joints that follow laws, against MuJoCo and against the same motion along a path."""

from __future__ import annotations

import pickle
from collections import deque
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import mujoco
import numpy as np
import pytest
from test_flight_mujoco import Tree, apart, with_springs
from trees import to_mujoco

import somersault as so
from somersault.attitude import angle_rates, unwrapped_angles
from somersault.flight import Flight
from somersault.motion import Path as Polynomials

AXES = (2, 1, 3)
LAW = (
    "k * twist - 0.4 * twist_rate + 2 * sin(somersault) + 0.3 * tilt_rate"
    " - 1.5 * 'left_shoulder' + 0.1 * right_shoulder_rate + 0.2 * angular_velocity_3 + time"
)
TAKEOFF = {"tilt": 0.1, "twist": 0.05, "spin": 8.0}


def command(angles, rates, omega, q, u, time: float, k: float) -> float:
    """`LAW`, in numbers."""
    return float(
        k * angles[2] - 0.4 * rates[2] + 2 * np.sin(angles[0]) + 0.3 * rates[1]
        - 1.5 * q[0] + 0.1 * u[1] + 0.2 * omega[2] + time
    )  # fmt: skip


def in_mujoco(
    tree: Tree, flight: Flight, every: float, waits: int, k: float, most: float, step: float
):
    """The end of MuJoCo's flight by fourth-order steps, sampled at the same ticks."""
    m = to_mujoco(tree, step)
    m.opt.enableflags = 0
    d, start = mujoco.MjData(m), flight.start
    d.qpos[3:7], d.qvel[3:6] = start.quaternion, start.omega
    d.qpos[7:], d.qvel[6:] = start.q, start.u
    angles, waiting = start.angles, deque([0.0] * waits)
    for tick in range(round(flight.times[-1] / every)):
        path = unwrapped_angles(np.stack([d.qpos[3:7]]), AXES, angles)
        angles = path[0] + 2 * np.pi * np.round((angles - path[0]) / (2 * np.pi))
        rates = angle_rates(angles, d.qvel[3:6], AXES)
        waiting.append(command(angles, rates, d.qvel[3:6], d.qpos[7:], d.qvel[6:], tick * every, k))
        d.qfrc_applied[6] = np.clip(waiting.popleft(), -most, most)
        for _ in range(round(every / step)):
            mujoco.mj_step(m, d)
    return d.qpos[3:7].copy(), d.qpos[7:].copy()


@pytest.mark.parametrize("waits", [0, 3])
def test_torques_by_a_law_are_those_of_mujoco(waits: int) -> None:
    every, most = 0.02, 1.2
    joints = {
        "left_shoulder": so.JointTakeoff.torque_law(
            angle=1.2, stiffness=2.0, rest=1.0, damping=0.05, law=LAW, gains={"k": -3.0},
            every=every, delay=waits * every, most_torque=most,
        ),
        "right_shoulder": so.JointTakeoff.sprung(angle=-1.1, stiffness=1.0, rest=-1.2),
    }  # fmt: skip
    flight = so.fly("furrer", so.Takeoff(joints=joints, **TAKEOFF), 1.0, accuracy=1e-11)
    assert flight.momentum_drift < 1e-10
    tree = with_springs(flight.model, joints)
    attitude, q = in_mujoco(tree, flight, every, waits, -3.0, most, 1e-3 / 2)
    assert apart(flight.landing.quaternion, attitude) < 1e-7
    np.testing.assert_allclose(list(flight.landing.joints.values()), q, atol=1e-7)
    torques = flight.joint_torques.sel(joint_speed="left_shoulder").values
    assert np.ptp(torques) > most  # it did something


def driven(law: str, motion: str = "rate_law", **more) -> dict[str, so.JointTakeoff]:
    numbers = {"angle": 1.2, "every": 0.05, "delay": 0.1, "law": law, **more}
    return {"shoulder": so.JointTakeoff(motion, **numbers)}


def test_a_rate_law_is_a_path_of_constant_accelerations() -> None:
    """Its commands, worked out from what was seen, make a path; flown as prescribed it is the
    same flight, by equations in which the joint is no part of the state."""
    every, waits = 0.05, 2
    takeoff = so.Takeoff(
        joints=driven("1.5 * twist - 0.2 * twist_rate", most_rate=2.0, most_acceleration=30.0),
        **TAKEOFF,
    )
    flight = so.fly("furrer", takeoff, 1.0, accuracy=1e-11, samples=21)
    rates = angle_rates(flight.angles, flight.angular_velocity, AXES)
    commands = 1.5 * flight.angles[:, 2] - 0.2 * rates[:, 2]
    paths = {}
    for name, angle in (("left_shoulder", 1.2), ("right_shoulder", -1.2)):
        rate, pieces = 0.0, []
        for tick in range(20):
            wanted = np.clip(commands[tick - waits] if tick >= waits else 0.0, -2.0, 2.0)
            bend = np.clip((wanted - rate) / every, -30.0, 30.0)
            pieces.append([angle, rate, bend / 2, 0, 0, 0])
            angle, rate = angle + rate * every + bend * every**2 / 2, rate + bend * every
        rows = np.array([[pieces[0][0], 0, 0, 0, 0, 0], *pieces])
        paths[name] = so.JointTakeoff.prescribed(path=Polynomials(every * np.arange(20), rows))
    moved = so.fly("furrer", replace(takeoff, joints=paths), 1.0, accuracy=1e-11)
    assert apart(flight.landing.quaternion, moved.landing.quaternion) < 1e-8
    assert np.ptp(flight.joint_coordinates[:, 0]) > 0.3
    assert flight.momentum_drift < 1e-10


def test_an_angle_law_arrives_in_two_ticks_and_stays() -> None:
    joints = driven("where(time > 0.19, 0.7, 1.2)", "angle_law", delay=0.0)
    flight = so.fly("furrer", so.Takeoff(joints=joints, **TAKEOFF), 1.0, samples=21)
    left, right = flight.joint_coordinates.T
    np.testing.assert_allclose(left, [1.2] * 5 + [left[5]] + [0.7] * 15, atol=1e-12)
    np.testing.assert_allclose(right, -left, atol=1e-12)
    assert 0.7 < left[5] < 1.2


def test_a_pair_is_driven_as_in_a_mirror() -> None:
    """Tilted and turned to the other side, everything else happens on the other side."""
    joints = driven("2 * twist - 0.5 * tilt_rate + 0.3 * 'left_shoulder'")
    one = so.fly("furrer", so.Takeoff(spin=8.0, tilt=0.1, twist=0.2, joints=joints), 0.8)
    two = so.fly("furrer", so.Takeoff(spin=8.0, tilt=-0.1, twist=-0.2, joints=joints), 0.8)
    np.testing.assert_allclose(one.angles * [1, -1, -1], two.angles, atol=1e-9)
    np.testing.assert_allclose(
        one.joint_coordinates, -two.joint_coordinates[:, ::-1], atol=1e-9
    )  # the right arm's angle is the left one's, negative


SPRINGS = {"angle": 1.2, "K": 1.1, "hold": True}
NOTHING = {
    "gains of 0": ({"law": "k * twist + c * twist_rate", "gains": {"k": 0.0, "c": 0.0}}, SPRINGS),
    "noise": ({"law": "k * twist", "gains": {"k": 0.0}, "noise": {"twist": 0.1}}, SPRINGS),
    "a clipped 0": ({"law": "clip(k * wrap(twist), -1, 2)", "gains": {"k": 0.0}}, SPRINGS),
    "a rate of 0": ({"motion": "rate_law", "law": "0 * 'left_shoulder'"}, {"angle": 1.2}),
    "its angle": ({"motion": "angle_law", "law": "a", "gains": {"a": 1.2}}, {"angle": 1.2}),
}


@pytest.mark.parametrize("what", NOTHING)
def test_a_law_of_nothing_is_no_law_bit_for_bit(what: str) -> None:
    law, numbers = NOTHING[what]
    joints = (
        so.JointTakeoff(**{"motion": "torque_law", **law, **numbers}),
        so.JointTakeoff.sprung(**numbers) if "K" in numbers else so.JointTakeoff.locked(**numbers),
    )
    one, two = (
        so.fly("furrer", so.Takeoff(joints={"shoulder": joint}, **TAKEOFF), 1.0, samples=21)
        for joint in joints
    )
    assert one.dataset.identical(two.dataset)


@pytest.mark.parametrize(
    "law", [{"law": "1e-9 * twist"}, {"law": "0", "rate": 0.1}, {"law": "time - time"}]
)
def test_a_law_that_could_do_something_has_its_ticks(law: dict) -> None:
    """The last is 0 by arithmetic, and counts as nothing."""
    motion = "rate_law" if "rate" in law else "torque_law"
    joints = {"shoulder": so.JointTakeoff(motion, angle=1.2, **law)}
    flight = so.fly("furrer", so.Takeoff(joints=joints, **TAKEOFF), 0.1)
    nothing = law["law"] == "time - time"
    assert all((plan.does.sensing is None) == nothing for plan in flight.start.plans)


def test_gains_of_0_that_vary_have_their_ticks() -> None:
    """Among gains the 0 agrees with the joint without a law to the accuracy; where only other
    numbers vary, bit for bit, also on other workers."""
    law = so.JointTakeoff.torque_law(law="k * twist", gains={"k": 0.0}, **SPRINGS)
    with_law, without = (
        so.flight.flights("furrer", so.Takeoff(joints={"shoulder": arms}, **TAKEOFF), 1.0)
        for arms in (law, so.JointTakeoff.sprung(**SPRINGS))
    )
    gains = so.ensemble(
        with_law, vary={"k": so.Vary(sets="joints.shoulder.gains.k", values=[0.0, -5.0])}
    ).dataset
    springs = {"K": so.Vary(sets="joints.shoulder.K", values=[1.1, 1.2])}
    one, two = (so.ensemble(runs, vary=springs).dataset for runs in (with_law, without))
    np.testing.assert_array_equal(one["twist"], two["twist"])
    np.testing.assert_array_equal(one["steps"], two["steps"])
    assert gains["twist"][0] == pytest.approx(float(two["twist"][0]), abs=1e-7)
    assert gains["steps"][0] >= 50 > two["steps"][0]
    varied = with_law.with_varied((("K", "left_shoulder"),))
    sent = pickle.loads(pickle.dumps(varied))
    assert sent.batch.joints == varied.batch.joints
    assert all(plan.does.sensing is None for plan in sent.batch.joints)


def test_arms_by_the_somersault_change_its_rate_by_their_inertia() -> None:
    """Without tilt or twist the spin is the momentum over the inertia of the moment, whatever the
    law does, and the somersault comes back to what was meant."""
    law = "k * (somersault - 8 * time)"
    joints = driven(law, gains={"k": 3.0}, most_rate=3.0, delay=0.04, every=0.02)
    takeoff = so.Takeoff(spin=8.2, joints=joints)
    flight = so.fly("furrer", takeoff, 2.0, samples=41)
    angle = flight.joint_coordinates[:, 0]
    inertia = [so.spin("furrer", 2, {"shoulder": a}).principal_inertias[1] for a in angle]
    np.testing.assert_allclose(
        np.array(inertia) * flight.angular_velocity[:, 1], inertia[0] * 8.2, rtol=1e-9
    )
    assert np.ptp(angle) > 0.1
    np.testing.assert_allclose(flight.angles[:, 1:], 0.0, atol=1e-9)


def test_what_waits_does_nothing_yet() -> None:
    """Until its reaction time is over the flight is that without the law."""
    late = driven("50 * sin(30 * time)", delay=0.5)
    locked = {"shoulder": so.JointTakeoff.locked(angle=1.2)}
    times = [0.0, 0.25, 0.5, 0.75]
    one, two = (
        so.fly("furrer", so.Takeoff(joints=joints, **TAKEOFF), 0.75, samples=times)
        for joints in (late, locked)
    )
    np.testing.assert_allclose(one.angles[:3], two.angles[:3], atol=1e-7)
    assert np.abs(one.angles[3] - two.angles[3]).max() > 1e-3


# ------------------------------------------------------------------------------- many flights


def noisy(**more) -> so.Takeoff:
    law = {"law": "k * twist", "noise": {"twist": 0.05}, "gains": {"k": 2.0}, "every": 0.05}
    return so.Takeoff(
        joints={"shoulder": so.JointTakeoff.torque_law(angle=1.2, stiffness=5.0, **law)},
        **{**TAKEOFF, **more},
    )


def test_an_ensemble_varies_gains_and_noise() -> None:
    """Each flight is the one that is flown alone with its numbers."""
    vary = {
        "gain": so.Vary(sets="joints.shoulder.gains.k", uniform=[-4.0, 4.0]),
        "noise": so.Vary(sets="takeoff.noise", uniform=[0.0, 1.0]),
    }
    runs = so.flight.flights("furrer", noisy(), 0.6, report=["twist", "tilt"])
    found = so.ensemble(runs, vary=vary, size=40, seed=3)
    again = so.ensemble(runs, vary=vary, size=40, seed=3, threads=1, chunk=7)
    np.testing.assert_array_equal(found.dataset["twist"], again.dataset["twist"])
    for k in (0, 17, 39):
        row = found.dataset.isel(sample=k)
        takeoff = noisy(noise=float(row["noise"]))
        joint = replace(takeoff.joints["shoulder"], gains={"k": float(row["gain"])})
        alone = so.fly("furrer", replace(takeoff, joints={"shoulder": joint}), 0.6)
        assert alone.landing.twist == pytest.approx(float(row["twist"]), abs=1e-6)


def test_noise_is_as_great_as_it_is_said_to_be() -> None:
    """An arm told to stand at what is sensed of a number that does not change shows the noise."""
    joints = {
        "left_shoulder": so.JointTakeoff.torque_law(
            law="right_shoulder", noise={"right_shoulder": 0.3}, stiffness=0.0, every=0.002
        ),
        "right_shoulder": so.JointTakeoff.locked(angle=-1.0),
    }
    flights = [
        so.fly("furrer", so.Takeoff(joints=joints, noise=n, **TAKEOFF), 1.0, samples=501)
        for n in (0.0, 1.0)
    ]
    rows = [f.joint_torques.sel(joint_speed="left_shoulder").values[1:] for f in flights]
    for torques in rows:
        assert np.mean(torques) == pytest.approx(-1.0, abs=4 * 0.3 / np.sqrt(500))
        assert np.std(torques) == pytest.approx(0.3, rel=4 / np.sqrt(1000))
    assert abs(np.corrcoef(rows)[0, 1]) < 4 / np.sqrt(500)


SPEC = """
model = "furrer"
duration = 0.6
[takeoff]
tilt = 0.1
spin = 8.0
[joints.shoulder]
motion = "rate_law"
angle = 1.2
law = "k * twist + c * twist_rate"
every = 0.05
delay = 0.1
most_rate = 3.0
[joints.shoulder.gains]
k = -0.5
c = -0.1
"""


def test_a_spec_has_laws(tmp_path: Path) -> None:
    file = tmp_path / "law.toml"
    file.write_text(SPEC)
    maneuver = so.Maneuver.read(file)
    assert maneuver.takeoff.joints["shoulder"].gains == {"k": -0.5, "c": -0.1}
    maneuver.save(tmp_path / "again.toml")
    again = so.Maneuver.read(tmp_path / "again.toml")
    assert again.fly().landing.twist == maneuver.fly().landing.twist


MISTAKES = {
    "no law": ({}, "no formula"),
    "no formula": ({"law": "k twist"}, "no formula"),
    "more than arithmetic": ({"law": "open('x')"}, "function open"),
    "an unknown quantity": ({"law": "twirl"}, "neither a gain nor sensed"),
    "an idle gain": ({"law": "twist", "gains": {"k": 1.0}}, "has the gain k"),
    "a gain that is sensed": ({"law": "tilt * twist", "gains": {"tilt": 1.0}}, "also something"),
    "noise of what is not sensed": ({"law": "twist", "noise": {"tilt": 1.0}}, "noise"),
    "no time": ({"law": "twist", "every": 0.0}, "every 0 s"),
    "a negative delay": ({"law": "twist", "delay": -0.1}, "delay of -0.1 s"),
    "half a tick": ({"law": "twist", "every": 0.02, "delay": 0.03}, "no whole number"),
    "a very long delay": ({"law": "twist", "every": 1e-5, "delay": 1.0}, "ticks"),
    "a negative bound": ({"law": "twist", "most_torque": -1.0}, "negative most_torque"),
    "a gain that is none": ({"law": "k", "gains": {"k": "much"}}, "gains.k"),
}


@pytest.mark.parametrize("what", MISTAKES)
def test_bad_laws_are_refused_in_a_sentence(what: str) -> None:
    numbers, words = MISTAKES[what]
    joint = {"motion": "torque_law", "stiffness": 1.0, **numbers}
    with pytest.raises(so.SomersaultError, match=words):
        so.fly("furrer", so.Takeoff(spin=8.0, joints={"shoulder": so.JointTakeoff(**joint)}), 0.1)


def test_laws_with_other_ticks_are_refused() -> None:
    joints = {
        f"{side}_shoulder": so.JointTakeoff.torque_law(law="twist", every=every, stiffness=1.0)
        for side, every in (("left", 0.01), ("right", 0.02))
    }
    with pytest.raises(so.SomersaultError, match="same ticks"):
        so.fly("furrer", so.Takeoff(spin=8.0, joints=joints), 0.1)


def test_a_law_that_is_no_number_ends_the_flight() -> None:
    joints = driven("sqrt(0.5 - time)")
    with pytest.warns(so.SomersaultWarning, match="finite"):
        flight = so.fly("furrer", so.Takeoff(joints=joints, **TAKEOFF), 1.0)
    assert flight.ended == "not finite"
    assert 0.5 <= flight.landing.time <= 0.7


def test_ticks_are_not_missed() -> None:
    """A count of ticks, by a law that adds one to where the joint is going."""
    for every, later in pairwise((0.1, 0.05, 0.01)):
        a, b = (
            so.fly(
                "furrer",
                so.Takeoff(joints=driven("5 * cos(40 * time)", every=e, delay=0.0), **TAKEOFF), 1.0,
            )
            for e in (every, later)
        )  # fmt: skip
        assert a.ended == b.ended == "duration"
        t = every * np.arange(round(1 / every))
        rates = 5 * np.cos(40 * t)
        expected = 1.2 + every * (rates.sum() - rates[-1] / 2)
        assert a.joint_coordinates[-1, 0] == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize(
    "law",
    ["0/0", "twist / 0", "(twist - twist) / twist_rate / (time - time)", "where(time > 1, 1/0, 0)"],
)
def test_a_law_that_divides_by_nothing_is_refused(law: str) -> None:
    arms = so.JointTakeoff.rate_law(angle=1.3, law=law, most_rate=5.0)
    with pytest.raises(so.SomersaultError, match="divides by"):
        so.fly("furrer", so.Takeoff(spin=8.64, joints={"shoulder": arms}), 0.1)


@pytest.mark.parametrize(
    "law",
    [
        "min(sqrt(twist - 9), 1)", "max(1, sqrt(twist - 9))", "clip(sqrt(twist - 9), -1, 1)",
        "sign(sqrt(twist - 9))", "sqrt(twist - 9) > 0", "1 - (sqrt(twist - 9) <= 2)",
    ],
)  # fmt: skip
def test_what_is_no_number_stays_none_and_ends_the_flight(law: str) -> None:
    arms = so.JointTakeoff.rate_law(angle=1.3, law=law, most_rate=5.0)
    with pytest.warns(so.SomersaultWarning, match="law .left_shoulder.* has given no number"):
        flight = so.fly("furrer", so.Takeoff(spin=8.64, joints={"shoulder": arms}), 0.1)
    assert flight.ended == "not finite"


def test_numbers_are_chosen_as_ever() -> None:
    for text, at in (
        ("min(x, 2)", np.minimum), ("max(x, 2)", np.maximum), ("x < 2", np.less),
        ("x >= 2", np.greater_equal), ("sign(x)", lambda x, _: np.sign(x)),
        ("clip(x, -1, 2)", lambda x, _: np.clip(x, -1, 2)),
        ("where(x, 1, 2)", lambda x, _: np.where(x, 1, 2)),
    ):  # fmt: skip
        for x in (-3.0, -0.0, 0.0, 1.0, 2.0, 5.0):
            assert float(so.laws.Formula(text).value({"x": x})) == float(at(x, 2.0))


def test_noise_is_of_what_is_sensed_and_not_negative() -> None:
    for noise, gains, said in (
        ({"twist": -1.0}, {"k": 1.0}, "give 0 or more"),
        ({"k": 1.0}, {"k": 1.0}, "a gain and not sensed"),
    ):
        arms = so.JointTakeoff.rate_law(angle=1.3, law="k * twist", gains=gains, noise=noise)
        with pytest.raises(so.SomersaultError, match=said):
            so.fly("furrer", so.Takeoff(spin=8.64, joints={"shoulder": arms}), 0.1)


def test_a_star_stands_for_gains_of_joints_alike() -> None:
    arms = so.JointTakeoff.rate_law(angle=1.3, law="k * twist", gains={"k": 1.0})
    runs = so.flight.flights("furrer", so.Takeoff(spin=8.64, joints={"shoulder": arms}), 0.1)
    both = [target.name for target in runs.targets("joints.*.gains.k")]
    assert both == [target.name for target in runs.targets("joints.shoulder.gains.k")]
