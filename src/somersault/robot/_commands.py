"""What a state asks of the legs, and the laws by which it does so."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca

from somersault.robot._control import Hips, Running
from somersault.robot._expressions import choose, clip, vector
from somersault.robot._sensed import Sensed, SensedLeg
from somersault.robot.tuck_servo import GRAVITY


@dataclass(frozen=True)
class Command:
    """What is asked of one leg: torques of its hip about axes 2, 1 and 3 (N m), the length at which
    its spring is to be at rest (m), and how fast its piston goes there (m/s)."""

    torques: Any
    length: Any
    piston_speed: Any


# ---------------------------------------------------------------------- hips in the air


def held(
    leg: SensedLeg, hips: Hips, angles: Sequence[Any], rates: Sequence[Any] = (0.0, 0.0, 0.0)
) -> Any:
    """Torques that turn a hip to angles about axes 2, 1 and 3, as far as it can turn."""
    stiffness = (hips.y_stiffness, hips.x_stiffness, hips.z_stiffness)
    damping = (hips.y_damping, hips.x_damping, hips.z_damping)
    return vector([
        stiffness[k] * (clip(angles[k], *leg.ranges[k]) - leg.angles[k])
        + damping[k] * (rates[k] - leg.rates[k])
        for k in range(3)
    ])  # fmt: skip


def foot_angles(now: Sensed, leg: SensedLeg, place: Any) -> tuple[Any, Any]:
    """The hip's angles about axes 2 and 1 with the foot towards a place, seen from the hip."""
    seen = now.attitude.T @ place
    fore = ca.atan2(-seen[0], -seen[2])
    return fore, ca.atan2(seen[1], ca.sqrt(seen[0] ** 2 + seen[2] ** 2))


def under(leg: SensedLeg, forward: Any, leftward: Any, length: Any) -> Any:
    """The place, from the hip, of a foot that is so far from the centre of mass along the ground,
    at the end of a leg of that length."""
    x, y = forward - leg.hip[0], leftward - leg.hip[1]
    reach = ca.sqrt(ca.fmax(length**2 - x**2 - y**2, 0.01))
    return vector([x, y, -reach])


def level(leg: SensedLeg, forward: Any, leftward: Any, drop: Any) -> Any:
    """The place, from the hip, of a foot that is so far from the centre of mass along the ground,
    and so far below it, so that two feet land at once."""
    return vector([forward - leg.hip[0], leftward - leg.hip[1], -drop - leg.hip[2]])


# --------------------------------------------------------------------------- hips in stance


def attitude_error(now: Sensed, pitch: Any, yaw: Any = 0.0) -> Any:
    """By how much the torso is to turn about the axes of the course, rad; `pitch` is the somersault
    angle that is wanted, and `yaw` the angle to the left of the course.

    Roll and yaw are the cross product of its side axis as it is and as it should be: that is
    right at any pitch.
    """
    side = vector([-ca.sin(yaw), ca.cos(yaw), 0.0])
    error = ca.cross(now.attitude[:, 1], side)
    return vector([error[0], pitch - now.somersault, error[2]])


def righting(now: Sensed, gains: Running, pitch: Any, yaw: Any = 0.0) -> Any:
    """The moment that keeps the torso upright in stance, N m."""
    stiffness = vector([gains.roll_stiffness, gains.pitch_stiffness, gains.yaw_stiffness])
    damping = vector([gains.roll_damping, gains.pitch_damping, gains.yaw_damping])
    return stiffness * attitude_error(now, pitch, yaw) - damping * now.rates


def stance_torques(now: Sensed, gains: Running, moment: Any) -> list[Any]:
    """Torques of both hips that turn the robot with a moment about its centre of mass.

    Each leg is taken to be without mass. The ground pushes it along itself with its spring's force;
    what it pushes across the leg, and turns it on the spot with, is what the hip asks for, and is
    bounded by friction. Two legs share the moment as they share the load.
    """
    loads = [choose(leg.is_down, leg.force, 0.0) for leg in now.legs]
    total = ca.fmax(loads[0] + loads[1], 1.0)
    along = [(leg.hip - _sole(leg)) / leg.length for leg in now.legs]
    axial = [load * u for load, u in zip(loads, along, strict=True)]
    given = sum(
        (ca.cross(_sole(leg), f) for leg, f in zip(now.legs, axial, strict=True)), ca.SX.zeros(3)
    )
    return [
        _leg_torques(leg, (moment - given) * (load / total), f, u, load, gains)
        for leg, load, f, u in zip(now.legs, loads, axial, along, strict=True)
    ]


def _leg_torques(
    leg: SensedLeg, moment: Any, axial: Any, along: Any, load: Any, gains: Running
) -> Any:
    """Of the hip of one leg, for what it is to add to the moment of its axial force."""
    arm = _sole(leg)
    upright = ca.DM([0, 0, 1])
    # The moment along the arm can only come from turning on the spot, the rest from forces.
    turning = ca.dot(arm, moment) / ca.fmin(arm[2], -0.1)
    turning = clip(turning, -gains.turning_friction * load, gains.turning_friction * load)
    rest = moment - turning * upright
    across = ca.cross(rest, arm) / ca.dot(arm, arm)
    across = across - arm * (ca.dot(across, along) / ca.fmin(ca.dot(arm, along), -0.1))
    size = ca.sqrt(ca.dot(across, across) + 1e-9)
    across = across * ca.fmin(1.0, gains.friction * load / size)
    on_leg = -(ca.cross(arm - leg.hip, axial + across) + turning * upright)
    return leg.axes.T @ on_leg


def _sole(leg: SensedLeg) -> Any:
    """Where the leg stands: as far from the hip as it is long."""
    way = leg.foot - leg.hip
    return leg.hip + way * (leg.length / ca.sqrt(ca.dot(way, way)))


# ---------------------------------------------------------------------------------- thrust


def thrust(mass: Any, stiffness: Any, speed: Any, speed_now: Any) -> Any:
    """By how much a spring must be compressed to lift the robot off with a speed, m.

    From ½ k d² = ½ m (v² − v_now²) + m g d: what the spring holds goes into speed and height.
    """
    weight = mass * GRAVITY
    energy = ca.fmax(0.5 * mass * (speed**2 - speed_now**2), 0)
    return (weight + ca.sqrt(weight**2 + 2 * stiffness * energy)) / stiffness
