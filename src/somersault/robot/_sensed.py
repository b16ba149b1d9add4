"""What a controller senses, as expressions of MuJoCo's numbers.

All vectors are in the axes of the course: 1 along the heading that is wanted, 2 to its left, 3 up.
Places are relative to the centre of mass.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import casadi as ca

from somersault.robot._expressions import about, clip, rotation, wrapped
from somersault.robot._robot import Machine, Robot


@dataclass(frozen=True)
class SensedLeg:
    """A leg: which it is, its joints, and where it is.

    Parameters
    ----------
    side : int
        1 for the left leg, −1 for the right.
    angles, rates : vector of 3
        Of the hip, about axes 2, 1 and 3, rad and rad/s.
    length, speed : expression
        From hip to sole, m, and its rate.
    hip, foot : vector of 3
        m; of the foot the middle of its sphere.
    axes : matrix
        Whose columns are the axes of the hip's hinges.
    force : expression
        That the leg's spring pushes with, N.
    load : expression
        On the foot, N.
    ranges : list
        Of the hip's angles, rad.
    limits : list
        Of its torques, N m.
    """

    side: int
    angles: Any
    rates: Any
    length: Any
    speed: Any
    hip: Any
    foot: Any
    axes: Any
    force: Any
    load: Any
    ranges: list[tuple[float, float]]
    limits: list[float]

    @property
    def is_down(self) -> Any:
        """Whether its foot stands on the ground."""
        return self.load > 1.0


@dataclass(frozen=True)
class Sensed:
    """The robot as it is now.

    Parameters
    ----------
    attitude : matrix
        From the torso's axes to those of the course.
    rates : vector of 3
        At which the torso turns, rad/s.
    somersault : expression
        The angle about axis 2, whole turns included, rad.
    velocity : vector of 3
        Of the centre of mass, m/s.
    height, hip_height : expression
        Of the centre of mass and of the middle of the hips, m.
    left, right : SensedLeg
    """

    attitude: Any
    rates: Any
    somersault: Any
    velocity: Any
    height: Any
    hip_height: Any
    left: SensedLeg
    right: SensedLeg

    @property
    def legs(self) -> tuple[SensedLeg, SensedLeg]:
        """Left and right."""
        return self.left, self.right


def sensed(
    robot: Robot, qpos: Any, qvel: Any, sensors: Any, heading: Any, before: Any, pistons: Any
) -> Sensed:
    """What is sensed; `before` is the somersault angle of the period before, and `pistons` the
    lengths at which the legs' springs are at rest."""
    machine = robot.machine
    to_course = about(3, -heading)
    to_world = rotation(qpos[3:7])
    attitude = to_course @ to_world
    turned = ca.atan2(attitude[0, 2], attitude[2, 2])
    somersault = before + wrapped(turned - before)
    com, velocity = sensors[0:3], sensors[3:6]
    legs = [
        _leg(machine, k, attitude, to_course, com, qpos, qvel, sensors, pistons[k])
        for k in range(2)
    ]
    return Sensed(
        attitude, attitude @ qvel[3:6], somersault, to_course @ velocity, com[2], qpos[2], *legs
    )


def _leg(
    machine: Machine, which: int, attitude: Any, to_course: Any, com: Any, qpos: Any, qvel: Any,
    sensors: Any, piston: Any,
) -> SensedLeg:  # fmt: skip
    at = machine.address_of[("left", "right")[which]]
    angles = ca.vertcat(*(qpos[k] for k in at.positions[:3]))
    rates = ca.vertcat(*(qvel[k] for k in at.rates[:3]))
    length = float(machine.resting[which]) + qpos[at.positions[3]]
    hip = to_course @ (qpos[0:3] - com) + attitude @ ca.DM(machine.hips[which])
    first = 6 + 4 * which
    foot = to_course @ (sensors[first : first + 3] - com)
    fore = attitude @ about(2, angles[0])
    side = fore @ about(1, angles[1])
    axes = ca.horzcat(attitude[:, 1], fore[:, 0], side[:, 2])
    force = clip(machine.stiffness * (piston - length), 0, 1e9)
    return SensedLeg(
        (1, -1)[which], angles, rates, length, qvel[at.rates[3]], hip, foot, axes, force,
        sensors[first + 3], at.range, at.limits,
    )  # fmt: skip
