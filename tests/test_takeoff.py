"""What a takeoff may not be, in one line that names it; and what it leaves to the model."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from somersault import SomersaultError
from somersault.attitude import matrix_from_quaternion
from somersault.flight import Flight, JointTakeoff, Takeoff, fly
from somersault.model import GROUND, Body, Joint, Model, load
from somersault.motion import _path

NAN, INF = float("nan"), float("inf")


def refused(*names: str, **given: Any) -> str:
    """The line in which a flight of furrer so given is refused; it must hold the names."""
    joints = given.pop("joints", None)
    takeoff = {k: given.pop(k) for k in list(given) if k in Takeoff.__dataclass_fields__}
    if joints is not None:
        takeoff["joints"] = joints
    model = given.pop("model", "furrer")
    with pytest.raises(SomersaultError) as caught:
        fly(model, Takeoff(**takeoff), **given)
    line = str(caught.value)
    assert line.strip()
    assert "\n" not in line
    for name in names:
        assert name in line, line
    return line


def arm(**given: Any) -> dict[str, JointTakeoff]:
    return {"left_shoulder": JointTakeoff(**given)}


# ------------------------------------------------------------------------------ mistakes


@pytest.mark.parametrize("name", ["somersault", "tilt", "twist", "spin"])
@pytest.mark.parametrize("value", [NAN, INF, -INF])
def test_numbers_that_are_not_finite(name: str, value: float) -> None:
    refused(name, **{name: value})


@pytest.mark.parametrize(
    ("name", "size"),
    [("quaternion", 4), ("angular_velocity", 3), ("angular_momentum", 3), ("velocity", 3)],
)
def test_vectors(name: str, size: int) -> None:
    good = [0.5] * size
    wrong = [good[1:], [*good, 0.5], [good], 0.5, [], [*good[1:], NAN], [*good[1:], INF], "up"]
    for value in wrong:
        refused(name, **{name: value})


@pytest.mark.parametrize(
    "given",
    [
        {"gravity": "down"},
        {"gravity": [0.0, [1.0], 2.0]},
        {"duration": "long"},
        {"accuracy": "fine"},
        {"samples": "many"},
        {"samples": [0.0, "end"]},
        {"spin": "fast"},
        {"spin": [1.0]},
        {"tilt": "some"},
        {"velocity": ["a", "b", "c"]},
        {"velocity": None},
        {"quaternion": [1.0, [0.0], 0.0, 0.0]},
        {"joints": arm(angle="wide")},
        {"joints": arm(motion="prescribed", times=[0.0, "a"], angles=[0.0, 1.0])},
        {"joints": arm(motion="prescribed", times=[0.0, 1.0], angles=[0.0, [1.0]])},
    ],
    ids=str,
)
def test_what_is_no_number(given: dict) -> None:
    """As a file may hold it: text in a number's place, a row within a row."""
    name = next(iter(given))
    refused("left_shoulder" if name == "joints" else name, **given)


def test_two_of_what_spins_it() -> None:
    given = {"spin": 3.0, "angular_velocity": [0, 3, 0], "angular_momentum": [0, 30, 0]}
    for left_out in given:
        two = {name: value for name, value in given.items() if name != left_out}
        refused(*two, **two)
    refused(*given, **given)


def test_no_spin_and_no_attitude() -> None:
    refused("spin", "zero", spin=0.0)
    refused("quaternion", "zero", quaternion=[0.0, 0.0, 0.0, 0.0])
    refused("quaternion", "angles", quaternion=[1.0, 0.0, 0.0, 0.0], tilt=0.1)


def test_joints_that_there_are_not() -> None:
    line = refused("left_knee", "left_shoulder", joints={"left_knee": JointTakeoff(angle=1.0)})
    assert "furrer" in line


@pytest.mark.parametrize("motion", ["fixed", "", "Locked"])
def test_motions_that_there_are_not(motion: str) -> None:
    with pytest.raises(SomersaultError, match=r"locked, free|free, .*locked") as caught:
        JointTakeoff(motion)
    assert repr(motion) in str(caught.value)


@pytest.mark.parametrize("name", ["angle", "rate", "stiffness", "damping", "rest"])
@pytest.mark.parametrize("value", [NAN, INF])
def test_joint_numbers_that_are_not_finite(name: str, value: float) -> None:
    refused("left_shoulder", joints=arm(motion="sprung", **{name: value}))


@pytest.mark.parametrize(
    ("times", "angles", "says"),
    [
        ([0.0, 1.0, 1.0], [0.0, 1.0, 0.5], "increase"),
        ([1.0, 0.0], [0.0, 1.0], "increase"),
        ([0.0, 1.0], [0.0, 1.0, 2.0], "as many"),
        ([0.0], [], "as many"),
        ([], [], "one"),
        ([[0.0, 1.0]], [[0.0, 1.0]], "times"),
        ([0.0, NAN], [0.0, 1.0], "finite"),
        ([0.0, 1.0], [0.0, INF], "finite"),
        ([0.0, 1.0], [0.0, 3.4], "limits"),
        ([0.0, 1.0], [-0.6, 0.0], "limits"),
    ],
)
def test_paths(times: list, angles: list, says: str) -> None:
    refused(
        "left_shoulder", says, joints=arm(motion="prescribed", times=times, angles=angles), spin=5.0
    )


def test_paths_with_what_is_the_paths_own() -> None:
    moves = {"motion": "prescribed", "times": [0.0, 1.0], "angles": [0.0, 1.0]}
    for given in ({"angle": 0.3}, {"rate": 0.3}):
        with pytest.raises(SomersaultError, match=f"{next(iter(given))} would do nothing"):
            JointTakeoff(**moves, **given)
    for motion in ("locked", "free", "sprung", None):
        with pytest.raises(SomersaultError, match="times would do nothing"):
            JointTakeoff(**(moves | {"motion": motion}))


def test_path_that_has_begun_before_takeoff() -> None:
    """It is refused, or the flight has the momentum it was given: never a third thing."""
    joints = arm(motion="prescribed", times=[-0.2, 0.2], angles=[0.0, 1.0])
    begun = Takeoff(angular_momentum=[1.0, 30.0, 2.0], joints=joints)
    try:
        flight = fly("furrer", begun, 0.5)
    except SomersaultError as mistake:
        assert "left_shoulder" in str(mistake)
        return
    np.testing.assert_allclose(flight.angular_momentum[0], [1.0, 30.0, 2.0], rtol=0, atol=1e-9)


@pytest.mark.parametrize("angle", [-0.6, 3.4])
@pytest.mark.parametrize("motion", ["locked", "free", "sprung"])
def test_limits(motion: str, angle: float) -> None:
    refused("left_shoulder", "limits", "3.3", joints=arm(motion=motion, angle=angle))


def test_hold_without_a_spring_or_a_spin() -> None:
    for motion in ("locked", "free"):
        with pytest.raises(SomersaultError, match="hold would do nothing"):
            JointTakeoff(motion, hold=True)
    for given in ({}, {"motion": "sprung", "stiffness": 10.0, "rest": 0.1}):
        refused("left_shoulder", "hold", joints=arm(hold=True, **given), spin=5.0)
    refused("left_shoulder", "hold", joints=arm(hold=True, motion="sprung", stiffness=9.0))


def test_rate_of_a_locked_joint() -> None:
    with pytest.raises(SomersaultError, match="rate would do nothing for a joint that is locked"):
        JointTakeoff.locked(rate=1.0)
    refused("left_shoulder", "rate", "locked", joints=arm(rate=1.0))


@pytest.mark.parametrize("duration", [0.0, -1.0, NAN, INF])
def test_duration(duration: float) -> None:
    refused("duration", duration=duration)


@pytest.mark.parametrize("accuracy", [0.0, -1e-9, 1e-16, 0.1, NAN, INF])
def test_accuracy(accuracy: float) -> None:
    refused("accuracy", accuracy=accuracy)


@pytest.mark.parametrize(
    "samples",
    [0, 1, -5, 10**9, [], [[0.0, 1.0]], [0.0, 0.5, 0.5], [0.5, 0.2], [-0.1, 0.5], [0.0, 1.1],
     [0.0, NAN]],
    ids=str,
)  # fmt: skip
def test_samples(samples: Any) -> None:
    refused("sample", samples=samples, duration=1.0)


def test_gravity_and_events() -> None:
    for gravity in ([0.0, 0.0], [0.0, 0.0, NAN], 9.81, [[0.0, 0.0, -9.81]]):
        refused("gravity", gravity=gravity)
    refused("half twist", "quarter twist", until="half twist")


def test_bodies_that_cannot_fly() -> None:
    furrer = load("furrer")
    refused("furrer", "fixed base", model=replace(furrer, free=False, bodies=_hinged(furrer)))
    refused("no_such_model", model="no_such_model")


def _hinged(model: Model) -> tuple[Body, ...]:
    base, *others = model.bodies
    return (replace(base, joints=(Joint("post", "hinge"),)), *others)


# ------------------------------------------------------------------------------ balls


def with_ball() -> Model:
    inertia = ((0.4, 0.0, 0.0), (0.0, 0.5, 0.0), (0.0, 0.0, 0.3))
    ball = Joint("neck", "ball", anchor=(0.0, 0.0, -0.1))
    trunk = Body("trunk", GROUND, 10.0, (0.0, 0.0, 0.0), inertia)
    head = Body("head", 0, 3.0, (0.0, 0.0, 0.1), inertia, (0.0, 0.0, 0.5), joints=(ball,))
    return Model("nodder", True, (trunk, head))


@pytest.mark.parametrize(
    "given",
    [
        {"angle": 0.1},
        {"motion": "free", "rate": 1.0},
        {"motion": "sprung", "stiffness": 1.0, "hold": True},
        {"motion": "sprung", "stiffness": 1.0, "rest": 0.3},
        {"motion": "prescribed", "times": [0.0, 1.0], "angles": [0.0, 1.0]},
    ],
    ids=str,
)
def test_what_a_ball_has_not(given: dict) -> None:
    refused("neck", model=with_ball(), joints={"neck": JointTakeoff(**given)}, spin=2.0)


def test_a_ball_takes_off_turned_and_turning() -> None:
    """The head turned about its neck is another trunk attitude with the neck turned back."""
    turn, rate = np.array([0.3, -0.5, 0.2]), np.array([1.0, 0.4, -2.0])
    neck = JointTakeoff("sprung", angle=turn, rate=rate, stiffness=3.0)
    omega = np.array([0.5, 2.0, 0.3])
    begun = Takeoff(angular_velocity=omega, joints={"neck": neck})
    flight = fly(with_ball(), begun, 1.0, accuracy=1e-11)
    first = flight.dataset.isel(time=0)
    half = np.linalg.norm(turn) / 2
    wanted = [np.cos(half), *(np.sin(half) * turn / (2 * half))]
    np.testing.assert_allclose(first["joint_angle"], wanted, atol=1e-12)
    np.testing.assert_allclose(first["joint_rate"], rate, atol=1e-12)
    assert float(first["spring_energy"]) == pytest.approx(0.5 * 3.0 * turn @ turn)
    assert flight.momentum_drift < 1e-11
    assert flight.energy_drift is not None
    assert flight.energy_drift < 1e-10
    # The two bodies' own momenta about the common centre, by hand, are the flight's.
    turned = matrix_from_quaternion(wanted)
    trunk, head = with_ball().bodies
    arm = np.add(head.position, [0, 0, -0.1]) + turned @ [0, 0, 0.2]
    spin_of_head = omega + turned @ rate
    apart = np.cross(omega, np.add(head.position, [0, 0, -0.1])) + np.cross(
        spin_of_head, turned @ [0, 0, 0.2]
    )
    reduced = trunk.mass * head.mass / (trunk.mass + head.mass)
    by_hand = np.array(trunk.inertia) @ omega + reduced * np.cross(arm, apart)
    by_hand += turned @ np.array(head.inertia) @ turned.T @ spin_of_head
    np.testing.assert_allclose(first["angular_momentum"], by_hand, atol=1e-12)


# ------------------------------------------------------------------- left to the model


def flown(model: Model, **joints: JointTakeoff) -> Flight:
    return fly(model, Takeoff(tilt=0.1, spin=3.0, joints=joints), 0.2)


def plan(flight: Flight, name: str) -> Any:
    return next(p.does for p in flight.start.plans if p.joint.name == name)


def test_what_is_not_named_keeps_what_the_model_gives() -> None:
    model = load("furrer")
    left = Joint("left_shoulder", "hinge", stiffness=7.0, rest=0.4, damping=0.3, reference=0.2)
    trunk, own, other = model.bodies
    model = replace(model, bodies=(trunk, replace(own, joints=(left,)), other))
    flight = flown(model)
    spring, held = plan(flight, "left_shoulder"), plan(flight, "right_shoulder")
    assert (spring.motion, spring.angle) == ("sprung", 0.2)
    assert (spring.stiffness, spring.rest, spring.damping) == (7.0, 0.4, 0.3)
    assert (held.motion, held.angle) == ("locked", 0.0)
    angles = flight.dataset["joint_angle"].values
    assert np.ptp(angles[:, 0]) > 1e-3
    assert np.ptp(angles[:, 1]) == 0.0
    # One number said leaves the others with the model.
    stiffer = plan(flown(model, left_shoulder=JointTakeoff(stiffness=9.0)), "left_shoulder")
    assert (stiffer.stiffness, stiffer.rest, stiffer.damping) == (9.0, 0.4, 0.3)
    free = plan(flown(model, left_shoulder=JointTakeoff("free")), "left_shoulder")
    assert (free.motion, free.damping) == ("free", 0.3)
    locked = flown(model, left_shoulder=JointTakeoff("locked"))
    assert np.ptp(locked.dataset["joint_angle"].values[:, 0]) == 0.0


def test_no_takeoff_is_rest() -> None:
    flight = fly("furrer")
    assert flight.landing.time == 1.0
    assert flight.landing.quaternion.tolist() == [1.0, 0.0, 0.0, 0.0]
    assert not np.any(flight.dataset["angular_momentum"])
    assert flight.momentum_drift == 0.0


def test_ways_to_say_the_same() -> None:
    """Angles or a quaternion of any length; spin, its momentum, or its angular velocity."""
    spin = fly("furrer", Takeoff(tilt=0.1, spin=3.0), 0.3)
    h = spin.start.momentum
    turning = matrix_from_quaternion(spin.start.quaternion) @ spin.start.omega
    np.testing.assert_allclose(turning, [0, 3, 0], atol=1e-12)
    others = [
        Takeoff(tilt=0.1, angular_momentum=h),
        Takeoff(quaternion=3.7 * spin.start.quaternion, angular_velocity=spin.start.omega),
    ]
    for other in others:
        same = fly("furrer", other, 0.3)
        np.testing.assert_allclose(same.states, spin.states, rtol=0, atol=1e-12)


@pytest.mark.parametrize("scale", [1e-200, 1e200])
def test_quaternions_of_any_length(scale: float) -> None:
    half = np.array([0.5, 0.5, -0.5, 0.5])
    flight = fly("furrer", Takeoff(quaternion=scale * half), 0.1)
    np.testing.assert_allclose(flight.landing.quaternion, half, rtol=0, atol=1e-15)


# --------------------------------------------------------------------------- the moves


TIMES, ANGLES = np.array([0.2, 0.5, 0.6, 1.5]), np.array([0.3, 1.2, 1.2, -0.4])


def moves(t: np.ndarray) -> np.ndarray:
    """Values, rates and accelerations at times t, (3, time)."""
    since, coefficients = _path.moves(TIMES, ANGLES).at(t[None])
    return np.array(_path.polynomial(t - since[0], list(coefficients[0].T)))


def test_moves_are_what_their_rates_say() -> None:
    t, step = np.linspace(-0.1, 1.8, 500), 1e-5
    t = t[np.abs(t[:, None] - TIMES).min(1) > 2 * step]
    value, rate, acceleration = moves(t)
    before, after = moves(t - step), moves(t + step)
    difference = (after - before) / (2 * step)
    np.testing.assert_allclose(rate, difference[0], rtol=0, atol=1e-6)
    np.testing.assert_allclose(acceleration, difference[1], rtol=0, atol=2e-5)
    assert np.abs(rate).max() > 1
    assert np.all((value >= -0.4 - 1e-15) & (value <= 1.2 + 1e-15))


def test_moves_are_at_rest_at_their_knots() -> None:
    value, rate, acceleration = moves(TIMES)
    np.testing.assert_allclose(value, ANGLES, rtol=0, atol=1e-15)
    np.testing.assert_allclose(rate, 0, atol=1e-13)
    np.testing.assert_allclose(acceleration, 0, atol=1e-11)
    near = moves(np.concatenate([TIMES - 1e-9, TIMES + 1e-9]))
    np.testing.assert_allclose(near[1:], 0, atol=1e-5)


def test_moves_are_held_outside() -> None:
    value, rate, acceleration = moves(np.array([-5.0, 0.0, 0.55, 1.6, 100.0]))
    np.testing.assert_allclose(value, [0.3, 0.3, 1.2, -0.4, -0.4], rtol=0, atol=1e-15)
    assert not np.any(rate)
    assert not np.any(acceleration)


def test_flight_follows_its_path() -> None:
    joints = arm(motion="prescribed", times=TIMES, angles=ANGLES)
    flight = fly("furrer", Takeoff(spin=3.0, joints=joints), 1.8)
    value, rate, _ = moves(flight.times)
    data = flight.dataset
    np.testing.assert_allclose(data["joint_angle"].sel(joint="left_shoulder"), value, atol=1e-15)
    np.testing.assert_allclose(data["joint_rate"][:, 0], rate, rtol=0, atol=1e-14)
