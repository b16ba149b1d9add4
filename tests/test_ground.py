"""Landings on the feet: what a body at rest, one that jumps down and one that falls must do."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import somersault as so
from somersault.ground import TICK, Feet, Floor, Gymnast, LandingLaw, Strength, land
from somersault.ground._balance import balanced

G = 9.81
JOINTS = ("shoulder_flexion", "hip_flexion", "knee", "ankle")
POSES = ((0.9, 0.5, 0.6), (1.4, 0.9, 0.9), (0.9, 1.2, 1.3))  # shoulder, hip, knee
STILL = 0.005  # m above the floor: a fall of no account


@cache
def model() -> so.Model:
    return so.sagittal(so.athlete(1.67, 64, knees=True, ankles=True))


@cache
def standing(pose: tuple[float, float, float], ahead: float) -> tuple[float, float, float]:
    """Trunk's lean and ankle with flat feet, the middle of the soles `ahead` of the centre of mass,
    and the height of the centre of mass above the soles; by the model's own kinematics."""
    feet = Feet()
    middle = (feet.toes - feet.heel) / 2

    def at(lean: float) -> tuple[float, float, float]:
        shoulder, hip, knee = pose
        ankle = np.pi / 2 + lean - hip + knee
        q = np.array([shoulder, hip, knee, ankle])
        turn = np.array([[np.cos(lean), np.sin(lean)], [-np.sin(lean), np.cos(lean)]])
        centre = turn @ so.model.centre_of_mass(model(), q)[[0, 2]]
        foot = turn @ so.model.body_frames(model(), q)[1][-1][[0, 2]]
        return float(foot[0] + middle - centre[0]), ankle, float(centre[1] - foot[1] + feet.ankle)

    low, high = -1.0, 1.3  # leaning forwards the feet go back
    for _ in range(60):
        lean = (low + high) / 2
        low, high = (lean, high) if at(lean)[0] > ahead else (low, lean)
    return lean, *at(lean)[1:]


def falling(
    pose: tuple[float, float, float] = POSES[1], ahead: float = 0.0, fallen: float = STILL,
    along: float = 0.0, momentum: float = 0.0,
) -> so.Flight:  # fmt: skip
    """A flight that reaches the floor after a fall from a height (m)."""
    lean, ankle, height = standing(pose, ahead)
    joints = {
        name: so.JointTakeoff.locked(angle=float(angle))
        for name, angle in zip(JOINTS, (*pose, ankle), strict=True)
    }
    down = float(np.sqrt(2 * G * (fallen - STILL)))
    takeoff = so.Takeoff(
        somersault=lean, angular_momentum=[0.0, momentum, 0.0], velocity=(along, 0.0, -down),
        position=(0.0, 0.0, height + STILL), joints=joints,
    )  # fmt: skip
    return so.fly(model(), takeoff, 0.1, gravity=(0.0, 0.0, -G), samples=101)


@pytest.mark.parametrize("ahead", [-0.08, 0.0, 0.08])
@pytest.mark.parametrize("pose", POSES)
def test_a_body_at_rest_stands(pose: tuple[float, float, float], ahead: float) -> None:
    stood = land(falling(pose, ahead))
    assert stood.stood
    assert stood.fell_on is None
    assert abs(stood.ground_force[-1, 1] / (model().mass * G) - 1) < 1e-3
    assert abs(stood.ground_force[-1, 0]) < 1.0
    height = stood.centre_of_mass[-1, 2]
    assert abs(height - LandingLaw().height) < 0.01


# From the toes' end the centre of mass is only 0.11 m away from the middle of the feet.
@pytest.mark.slow
@pytest.mark.parametrize(
    ("fallen", "ahead"),
    [
        *((0.2, x) for x in (-0.06, -0.03, 0.0, 0.04, 0.08)),
        *((0.5, x) for x in (-0.06, -0.03, 0.0, 0.04, 0.08)),
        *((1.0, x) for x in (-0.04, 0.0, 0.04, 0.08)),
    ],
)
@pytest.mark.parametrize("pose", POSES)
def test_a_body_jumps_down(pose: tuple[float, float, float], fallen: float, ahead: float) -> None:
    assert land(falling(pose, ahead, fallen)).stood


def test_momentum_and_energy_are_what_the_floor_gives_and_takes() -> None:
    one = land(falling(fallen=0.5))
    equations = so.Equations(model())
    mass, time = model().mass, np.arange(len(one.times)) * TICK
    centre = one.centre_of_mass
    speed = np.gradient(centre[:, 2], time)
    impulse = np.concatenate([[0.0], np.cumsum(one.ground_force[:-1, 1] - mass * G) * TICK])
    begun = -np.sqrt(2 * G * 0.5)
    assert np.abs(mass * (speed - begun) - impulse)[5:].max() < 0.02 * mass * -begun
    turn = so.attitude.matrix_from_quaternion(one.base_quaternion)
    base = np.stack([one.base_velocity[:, 0], 0 * time, one.base_velocity[:, 1]], -1)
    local = np.einsum("tji,tj->ti", turn, base)
    zero = 0 * time
    spin = np.stack([zero, one.angular_velocity, zero], -1)
    # Kinetic energy by König: that of the centre of mass, and of the motion about it.
    u = np.concatenate([spin, local, one.joint_rates], 1)
    kinetic = equations.kinetic_energy(one.joint_coordinates, u)
    energy = kinetic + mass * G * centre[:, 2]
    moved = np.diff(one.joint_coordinates, axis=0)
    work = np.cumsum((one.joint_torques[:-1] * moved).sum(1))
    taken = energy[1:] - energy[0] - work
    assert taken[-1] < -0.05 * energy[0]  # the floor is soft and damped, and stops the feet
    assert np.diff(taken)[200:].max() < 1.0  # and gives nothing to one who stands


def test_a_fall_is_a_fall() -> None:
    back = land(falling(ahead=0.35))
    assert back.ended == "fell"
    assert not back.stood
    assert back.fell_on in ("pelvis", "thigh", "upper_arm")
    assert back.times[-1] - back.times[0] < 1.5
    weak = Gymnast(model(), strength=Strength(knee=60.0, hip=60.0))
    assert land(falling(fallen=0.5), gymnast=weak).ended == "fell"
    assert land(falling(), duration=0.5).ended == "duration"


def test_one_who_comes_down_on_the_head_has_fallen() -> None:
    takeoff = so.Takeoff(
        somersault=np.pi, position=(0.0, 0.0, 1.5),
        joints={name: so.JointTakeoff.locked(angle=0.0) for name in JOINTS},
    )  # fmt: skip
    down = land(so.fly(model(), takeoff, 0.6, gravity=(0.0, 0.0, -G)))
    assert down.ended == "fell"
    assert down.times[-1] - down.times[0] < 0.01


def test_a_slippery_floor_makes_one_fall_who_moves() -> None:
    moving = falling(ahead=0.2, fallen=0.5, along=1.2)
    assert land(moving).stood
    assert not land(moving, floor=Floor(friction=0.05)).stood


def test_torques_stay_within_the_strength() -> None:
    one = land(falling(fallen=1.0))
    s = Strength()
    assert np.all(np.abs(one.joint_torques) <= (s.shoulder, s.hip, s.knee, s.ankle))


def test_the_same_flight_lands_the_same_bit_for_bit() -> None:
    flight = falling(fallen=0.5, along=0.3)
    first, again = land(flight), land(flight)
    assert np.array_equal(first.base_position, again.base_position)
    assert np.array_equal(first.joint_torques, again.joint_torques)


def test_a_landing_goes_on_where_the_flight_came_down() -> None:
    flight = falling(fallen=0.5, along=0.3, momentum=-5.0)
    stance = land(flight)
    k = int(np.searchsorted(flight.times, stance.times[0])) - 1
    assert flight.times[k] <= stance.times[0] <= flight.times[k + 1]
    assert np.abs(stance.base_position[0] - flight.base_position[k]).max() < 0.05
    whole = so.history.joined([flight, stance], [0.0, 0.0])
    assert np.all(np.diff(whole.times) > 0)
    assert np.abs(np.diff(whole.base_position, axis=0)).max() < 0.05


def test_the_force_turns_and_moves_the_body_as_wanted() -> None:
    mass, inertia, up = 64.0, 9.0, 900.0
    offset, height, wanted = 0.02, 0.8, (0.4, -1.0)
    push = balanced(offset, height, up, wanted, (-0.1, 0.1), mass, inertia, 0.1, 0.8)
    moment = (offset - push.place) * up - height * push.along
    assert np.allclose((push.along / mass, moment / inertia), wanted)
    beyond = balanced(0.15, height, up, (0.0, 0.0), (-0.1, 0.1), mass, inertia, 0.1, 0.8)
    assert beyond.place == 0.1
    assert beyond.along > 0
    free = balanced(0.15, height, up, (0.0, 0.0), (-0.1, 0.1), mass, inertia, 1e-6, 0.8)
    assert abs(free.along) < 1e-3  # balance first


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: Feet(ankle=0.0), "ankle of feet must be above zero, and is 0"),
        (lambda: Feet(heel=0.01, toes=0.01), "feet 0.02 m long cannot be rounded"),
        (lambda: Floor(friction=-1.0), "friction of a floor must be above zero, and is -1"),
        (lambda: LandingLaw(lean=-0.1), "lean of a landing law must not be negative, and is -0.1"),
        (lambda: Gymnast(so.load("furrer")), "furrer does not land by itself"),
        (lambda: Gymnast(so.sagittal(so.athlete(1.67, 64, knees=True))), "takes the joints"),
        (lambda: land(falling(), duration=0.0), "needs a duration above 0 s"),
        (lambda: land(so.fly("furrer", so.Takeoff(), 0.1)), "furrer does not land by itself"),
        (lambda: land(so.fly(model(), so.Takeoff(), 0.1)), "it begins in the floor; start higher"),
        (lambda: land(so.fly(model(), so.Takeoff(position=(0, 0, 3)), 0.1)), "stays above it"),
    ],
)  # fmt: skip
def test_what_cannot_land_is_refused_in_a_sentence(call, words: str) -> None:
    with pytest.raises(so.SomersaultError, match=words):
        call()
