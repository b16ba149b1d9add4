"""Derivatives of landings, against differences of flights, closed forms and linear spins."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from shares import every
from trees import random_tree

import somersault as so
from somersault.attitude import matrix_from_quaternion
from somersault.ensembles import landing_derivatives
from somersault.flight import sensitivity, transition

SIZES = 0.3 ** np.arange(7)  # of steps
EIGHTH = np.array([4 / 5, -1 / 5, 4 / 105, -1 / 280])
ATTITUDE = ("takeoff.somersault", "takeoff.tilt", "takeoff.twist")
MOVES = so.JointTakeoff.prescribed(times=[0.1, 0.4, 0.6], angles=[1.4, 0.3, 0.9])


def differences(maneuver: so.Maneuver, of: Any, to: dict[str, float]) -> np.ndarray:
    """∂ of / ∂ to by differences of order eight of flights: of steps of their own and of ever
    smaller ones those that agree best with the next."""
    by = np.outer(SIZES, np.concatenate([np.arange(1, 5), -np.arange(1, 5)])).ravel()
    steps = np.array(list(to.values()))
    changes = np.kron(np.diag(steps), by)
    vary = {f"change_{k}": so.Vary(adds_to=n, samples=changes[k]) for k, n in enumerate(to)}
    flown = so.ensemble(maneuver, vary=vary, report=[n for n in of if n != "time"]).dataset
    ends = np.array([flown[name].values for name in of]).reshape(len(of), len(to), len(SIZES), 2, 4)
    slopes = (ends[..., 0, :] - ends[..., 1, :]) @ EIGHTH / (steps[:, None] * SIZES)
    apart = np.abs(np.diff(slopes)).max(0)  # (to, sizes − 1)
    return np.stack([slopes[:, k, best] for k, best in enumerate(apart.argmin(1))], 1)


def check(maneuver: so.Maneuver, to: dict[str, float], within: float = 1e-6) -> None:
    """Derivatives are those of differences: to some of the greatest of the same number."""
    exact = replace(maneuver, accuracy=1e-12)
    slopes = sensitivity(exact, list(to))
    wanted = differences(exact, slopes.landing.values.tolist(), to)
    size = np.abs(wanted).max(0)
    assert np.all(size > 0)
    np.testing.assert_allclose(slopes.values / size, wanted / size, rtol=0, atol=within)


def layout(duration: float = 1.5, until: Any = None, **takeoff: Any) -> so.Maneuver:
    arm = so.JointTakeoff.sprung(angle=1.4, K=1.2, B=0.1, hold=True)
    given = {"tilt": 0.05, "twist": 0.02, "spin": 8.64, "joints": {"shoulder": arm}, **takeoff}
    return so.Maneuver("furrer", so.Takeoff(**given), duration, until=until)


STEPS = {
    "takeoff.tilt": 0.01, "takeoff.twist": 0.01, "takeoff.spin": 0.05, "takeoff.tilt_rate": 0.02,
    "joints.shoulder.K": 0.02, "joints.shoulder.B": 0.02, "joints.shoulder.angle": 0.01,
    "joints.left_shoulder.rate": 0.02, "joints.right_shoulder.pretension": 0.2,
    "bodies.left_arm.mass": 0.02, "bodies.body.com.3": 0.004, "bodies.left_arm.position.2": 0.004,
}  # fmt: skip


def test_of_a_sprung_layout():
    check(layout(), STEPS)


def test_of_momentum_and_angular_velocity():
    h = {f"takeoff.angular_momentum.{k}": 0.5 for k in (1, 2, 3)}
    check(layout(spin=None, angular_momentum=(1.0, 110.0, -2.0)), {**h, "takeoff.tilt": 0.01})
    omega = {f"takeoff.angular_velocity.{k}": 0.02 for k in (1, 2, 3)}
    check(layout(spin=None, angular_velocity=(0.1, 8.0, -0.2)), omega)


def test_where_an_event_ends_the_flight_its_time_changes_too():
    maneuver = layout(8.0, "quarter twist", joints={"shoulder": so.JointTakeoff.locked(angle=1.4)})
    assert maneuver.fly().ended == "event"
    slopes = sensitivity(maneuver, ["takeoff.tilt"])
    assert (slopes.landing[0], slopes.landing_unit[0]) == ("time", "s")
    check(maneuver, {"takeoff.tilt": 4e-4, "takeoff.spin": 0.05})


def test_of_a_bound_flight():
    right = so.JointTakeoff.prescribed(times=[0.2, 0.5], angles=[-1.4, -0.2])
    joints = {"left_shoulder": MOVES, "right_shoulder": right}
    to = {"joints.left_shoulder.times.2": 0.004, "joints.right_shoulder.angles.2": 0.02}
    check(layout(0.8, joints=joints), {"takeoff.tilt": 0.01, "takeoff.spin": 0.05, **to})


TAPED = {
    "joints.shoulder.times.2": 0.003, "joints.shoulder.angles.2": 0.01,
    "joints.shoulder.stiffness": 0.5, "joints.shoulder.damping": 0.2, "takeoff.tilt": 0.01,
}  # fmt: skip


def test_of_a_compliant_body_with_a_motor_tape_that_follows_its_path():
    soft = layout(0.9, joints={"shoulder": MOVES}).compliant(20.0, pose={"shoulder": 0.3})
    assert soft.takeoff.tape is not None
    check(soft.off_nominal(tilt=0.03), TAPED)


LAW = {"law": "-k * twist - c * twist_rate", "gains": {"k": 3.0, "c": 1.0}, "every": 0.02}
ACTIVE = {"takeoff.tilt": 0.005, "joints.shoulder.gains.k": 0.05, "joints.shoulder.gains.c": 0.05}


@pytest.mark.parametrize("kind", ["rate_law", "angle_law", "torque_law"])
def test_of_laws(kind):
    bounds = {} if kind == "torque_law" else {"most_acceleration": 60.0}
    arm = getattr(so.JointTakeoff, kind)(angle=1.3, delay=0.04, **LAW, **bounds)
    start = {"tilt": 0.03, "twist": 0.01, "joints": {"shoulder": arm}}
    check(layout(0.7, **start), {**ACTIVE, "joints.shoulder.angle": 0.004})


def test_of_a_replay_by_errors():
    law = so.Replay(law="1 + k * twist_error", gains={"k": -0.5}, delay=0.04)
    soft = layout(0.9, joints={"shoulder": MOVES}).compliant(20.0, pose={"shoulder": 0.3})
    to = {"takeoff.tilt": 0.004, "replay.gains.k": 0.02, "joints.shoulder.stiffness": 0.5}
    off = soft.replayed(law).off_nominal(tilt=0.02)
    check(off, {**to, "joints.shoulder.angles.3": 0.004})


@pytest.mark.parametrize("number", every(range(8), 3))
def test_of_random_trees(number):
    """Joints are sprung, prescribed and compliant in turn; every other tree has a law."""
    rng = np.random.default_rng([55, number])
    model = random_tree(rng, bodies=3 + number % 3, free=True)
    to = dict.fromkeys(ATTITUDE, 0.01) | {"takeoff.angular_velocity.1": 0.02}
    body = model.bodies[-1].name
    to |= {f"bodies.{body}.mass": 0.01, f"bodies.{body}.position.2": 0.002}
    joints: dict[str, so.JointTakeoff] = {}
    for k, joint in enumerate(model.joints):
        name, path = f"joints.{joint.name}", {"times": [0.11, 0.33], "angles": [0.2, -0.3]}
        springs = {"stiffness": 12.0, "damping": 0.3}
        if joint.kind == "ball":
            joints[joint.name] = so.JointTakeoff.sprung(
                (0.2, 0.1, -0.3), (1.0, 0.5, -1.0), **springs
            )
            to |= {f"{name}.angle.2": 0.01, f"{name}.rate.2": 0.02, f"{name}.stiffness": 0.1}
        elif number % 2 and not k:
            law = {"law": "-k * tilt_rate", "gains": {"k": 0.5}, "every": 0.05, "delay": 0.05}
            joints[joint.name] = so.JointTakeoff.torque_law(joint.home[0], 0.7, **law, **springs)
            to |= {f"{name}.gains.k": 0.01, f"{name}.damping": 0.01}
        elif k % 3 == 1:
            joints[joint.name] = so.JointTakeoff.prescribed(**path)
            to |= {f"{name}.times.2": 0.005, f"{name}.angles.1": 0.01}
        elif k % 3 == 2:
            joints[joint.name] = so.JointTakeoff.compliant(**path, **springs)
            to |= {f"{name}.times.2": 0.005, f"{name}.angles.1": 0.01, f"{name}.damping": 0.01}
        else:
            joints[joint.name] = so.JointTakeoff.sprung(joint.home[0] + 0.1, 0.7, **springs)
            to |= {f"{name}.angle": 0.01, f"{name}.rate": 0.02, f"{name}.stiffness": 0.1}
    omega = tuple(rng.normal(size=3) * 3)
    takeoff = so.Takeoff(tilt=0.3, twist=-0.2, angular_velocity=omega, joints=joints)
    check(so.Maneuver(model, takeoff, 0.5), to)


def test_of_joints_that_follow_others():
    follower = so.JointTakeoff.coupled(leader="left_shoulder", factor=-0.8, offset=0.1)
    led = {"left_shoulder": so.JointTakeoff.free(angle=1.2, rate=0.5), "right_shoulder": follower}
    to = {f"joints.right_shoulder.{name}": 0.01 for name in ("factor", "offset")}
    check(layout(0.8, joints=led), {**to, "joints.left_shoulder.angle": 0.01})


def test_of_a_planar_body():
    planar = so.load("gymnast", base="planar")
    hips = so.JointTakeoff.prescribed(times=[0.1, 0.4], angles=[0.0, 1.2])
    elbows = so.JointTakeoff.sprung(angle=0.3, stiffness=20.0, damping=0.5)
    joints = {"hip_flexion": hips, "elbow": elbows}
    takeoff = so.Takeoff(spin=6.0, joints=joints)
    to = {"takeoff.spin": 0.02, "joints.hip_flexion.angles.2": 0.01, "joints.elbow.stiffness": 0.2}
    check(so.Maneuver(planar, takeoff, 0.7), to)


def test_of_torques_that_are_straight_between_samples():
    push = so.JointTakeoff.torque(times=[0.1, 0.3, 0.5], torques=[0.0, 8.0, -4.0], damping=1.0)
    to = {"joints.shoulder.times.2": 0.004, "joints.shoulder.torques.3": 0.2}
    check(layout(0.8, joints={"shoulder": push}), to)


# ------------------------------------------------------------------------------- transitions


@pytest.mark.parametrize(("stiffness", "damping"), [(1.2, 0.0), (0.9, 0.1), (0.0, 0.0)])
def test_the_transition_over_a_somersault_is_the_exponential_of_the_linear_spin(stiffness, damping):
    arm = so.JointTakeoff.sprung(angle=1.4, K=stiffness, B=damping, hold=True)
    turn = layout(2 * np.pi / 8.64, tilt=0.0, twist=0.0, joints={"shoulder": arm})
    spin = so.spin("furrer", pose={"shoulder": 1.4})
    linear = spin.linear(stiffness={"shoulder": stiffness}, damping={"shoulder": damping})
    found = np.linalg.eigvals(transition(replace(turn, accuracy=1e-12)).values)
    for factor in np.exp(2 * np.pi * np.asarray(linear.roots)):
        # Roots at 0 are double, so that their factors are known to the square root of rounding.
        nearest = found[np.abs(found - factor).argmin()]
        assert nearest == pytest.approx(factor, abs=2e-6 if abs(factor - 1) < 1e-6 else 1e-9)


def test_energy_and_momentum_change_along_the_flight_as_at_takeoff():
    """What is kept in every flight near by has the same derivative at the end as at takeoff."""
    model = random_tree(np.random.default_rng(8), bodies=5, free=True, armature=False)
    joints = {j.name: so.JointTakeoff.free(rate=(1.0, 2.0, 0.5) if j.kind == "ball" else 1.0,
                                           damping=0.0) for j in model.joints}  # fmt: skip
    takeoff = so.Takeoff(tilt=0.3, angular_velocity=(1.0, 4.0, -2.0), joints=joints)
    free = so.Maneuver(model, takeoff, 0.7, accuracy=1e-13)
    flight, matrix = free.fly(samples=2), transition(free)
    start, end = (_kept_along(flight, k) for k in (0, -1))
    np.testing.assert_allclose(end @ matrix.values, start, rtol=0, atol=1e-9 * np.abs(start).max())


def _kept_along(flight: so.Flight, k: int) -> np.ndarray:
    """Derivatives of energy and of angular momentum (inertial axes) along what `transition` has, at
    a sample: by differences of order eight of closed forms, (4, n)."""
    model, equations = flight.model, so.Equations(flight.model)
    q, u = flight.joint_coordinates[k], flight.dataset.joint_rate.values[k]
    omega, attitude = flight.angular_velocity[k], flight.base_quaternion[k]

    def turned(quaternion: np.ndarray, turn: np.ndarray) -> np.ndarray:
        half = np.linalg.norm(turn) / 2
        vector = turn / 2 * np.sinc(half / np.pi)
        return so.attitude.quaternion_product(quaternion, [np.cos(half), *vector])

    def kept(change: np.ndarray) -> np.ndarray:
        turn, spin, swing, rates = np.split(change, [3, 6, 6 + len(u)])
        at = q.copy()
        for joint in model.joints:
            where, by = model.coordinate_slice(joint.name), model.speed_slice(joint.name)
            moved = turned(q[where], swing[by]) if joint.kind == "ball" else q[where] + swing[by]
            at[where] = moved
        v = np.concatenate([omega + spin, np.zeros(3), u + rates])
        v[3:6] = -equations.momentum(at, v)[3:] / model.mass
        h = matrix_from_quaternion(turned(attitude, turn)) @ equations.momentum(at, v)[:3]
        return np.append(equations.kinetic_energy(at, v), h)

    steps = 0.01 * np.outer(np.arange(1, 5), np.ones(1))
    columns = []
    for one in np.eye(6 + 2 * len(u)):
        across = [kept(step * one) - kept(-step * one) for step in steps[:, 0]]
        columns.append(EIGHTH @ np.array(across) / 0.01)
    return np.array(columns).T


def test_differences_of_an_ensemble_agree():
    maneuver = layout(1.0)
    slopes = sensitivity(
        maneuver, ["takeoff.tilt", "takeoff.twist"], ["somersault", "tilt", "twist"]
    )
    rough = landing_derivatives(maneuver)
    np.testing.assert_allclose(slopes.values, rough.values, rtol=1e-4, atol=1e-5)
    assert slopes.dims == rough.dims


@pytest.mark.parametrize("kind", ["sprung", "rate_law", "angle_law"])
def test_a_sensitivity_is_the_transition_of_what_it_does_to_the_start(kind):
    """Rates and angles at takeoff change nothing but the start, with what is carried there."""
    numbers = {"stiffness": 40.0} if kind == "sprung" else {"delay": 0.1, **LAW}
    arm = getattr(so.JointTakeoff, kind)(angle=1.4, **numbers)
    maneuver = layout(1.0, spin=None, angular_velocity=(0.1, 8.0, -0.2), joints={"shoulder": arm})
    names = [f"takeoff.angular_velocity.{k}" for k in (1, 2, 3)]
    names += ["joints.left_shoulder.rate", "joints.left_shoulder.angle"]
    matrix = transition(maneuver)
    columns = [*(f"angular_velocity_{k}" for k in (1, 2, 3)), "left_shoulder_rate", "left_shoulder"]
    rows = [*columns, "right_shoulder", "right_shoulder_rate"]
    slopes = sensitivity(maneuver, names, rows)
    np.testing.assert_allclose(slopes.values, matrix.loc[rows, columns].values, atol=1e-7)


# ------------------------------------------------------------------------------ what is refused


def _noisy() -> so.Maneuver:
    arm = so.JointTakeoff.rate_law(angle=1.3, noise={"twist": 0.01}, **LAW)
    return layout(0.2, joints={"shoulder": arm})


def _jumping(replay: so.Replay | None = None) -> so.Maneuver:
    push = so.JointTakeoff.torque(times=[0.1, 0.2], torques=[1.0, 4.0], between="held")
    return layout(0.3, joints={"shoulder": push}, replay=replay)


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: sensitivity("furrer", ["takeoff.tilt"]), "somersault.Maneuver"),
        (lambda: sensitivity(layout(), ["takeoff.lean"]), "takeoff.lean is no number"),
        (lambda: sensitivity(layout(), []), "name nothing"),
        (lambda: sensitivity(layout(), ["takeoff.tilt"] * 2), "names takeoff.tilt twice"),
        (lambda: sensitivity(layout(), ["takeoff.tilt"], ["tilt", "tilt"]), "of names tilt twice"),
        (lambda: sensitivity(layout(), ["takeoff.tilt"], ["lean"]), "'lean' is nothing"),
        (lambda: sensitivity(_noisy(), ["takeoff.noise"]), "which noise is sensed"),
        (lambda: sensitivity(_jumping(), ["joints.shoulder.times.2"]), "jumps at 0.2 s"),
        (lambda: transition(_jumping(so.Replay(law="1 + 0.1 * twist"))), "0.2 s, which moves with"),
        (lambda: transition(replace(layout(), steps=3)), "breaks off at"),
    ],
)  # fmt: skip
def test_what_is_refused(call, said):
    with pytest.raises(so.SomersaultError, match=said):
        call()


def test_a_knot_at_takeoff_is_refused():
    arm = so.JointTakeoff.prescribed(times=[0.0, 0.2], angles=[1.4, 0.3])
    with pytest.raises(so.SomersaultError, match="no derivative with respect to joints"):
        sensitivity(layout(0.3, joints={"left_shoulder": arm}), ["joints.left_shoulder.times.1"])


def test_a_held_torque_has_derivatives_by_all_but_its_times():
    check(_jumping(), {"joints.shoulder.torques.2": 0.2, "takeoff.tilt": 0.01})
