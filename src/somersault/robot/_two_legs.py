"""What both legs do together, in a somersault."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import casadi as ca

from somersault.robot._commands import Command, foot_angles, held, stance_torques, thrust
from somersault.robot._expressions import all_of, any_of, choose, clip, vector
from somersault.robot._running import SHORTEST_STANCE
from somersault.robot._sensed import SensedLeg
from somersault.robot._states import Now


def mean(now: Now, quantity: Callable[[SensedLeg], Any]) -> Any:
    """A quantity of both legs, in the mean."""
    left, right = (quantity(leg) for leg in now.sensed.legs)
    return (left + right) / 2


def both_up(now: Now) -> Any:
    """Whether both feet have left the ground."""
    left, right = (leg.load <= 1.0 for leg in now.sensed.legs)
    return all_of(left, right, now.since > SHORTEST_STANCE)


def one_down(now: Now) -> Any:
    """Whether a foot is on the ground."""
    return any_of(*(leg.is_down for leg in now.sensed.legs))


def closing(now: Now) -> Any:
    """The mean rate at which the legs that are down get longer."""
    rates = [choose(leg.is_down, leg.speed, 0.0) for leg in now.sensed.legs]
    return rates[0] + rates[1]


def reached(now: Now, leg: SensedLeg, place: Any, piston_speed: Any, rate: Any = 0.0) -> Command:
    """A foot that goes to a place from its hip; `rate` is that of the hip about axis 2."""
    angles = (*foot_angles(now.sensed, leg, place), 0.0)
    length = clip(ca.sqrt(ca.dot(place, place)), now.shortest, now.longest)
    torques = held(leg, now.control.hips, angles, (rate, 0.0, 0.0))
    return Command(torques, length, piston_speed)


def drop(length: Any, forward: Any) -> Any:
    """How far under the centre of mass feet at the end of such legs are."""
    return ca.sqrt(ca.fmax(length**2 - forward**2, 0.01))


def two_legs_down(now: Now, moment: Any, length: Any) -> list[Command]:
    """Both legs in stance; one that is not down yet keeps where it is."""
    torques = stance_torques(now.sensed, now.control.running, moment)
    speed = now.control.flip.piston_speed
    return [Command(t, x, speed) for t, x in zip(torques, length, strict=True)]


def two_legs_turning(now: Now, moment: Any, length: Any) -> list[Command]:
    """Both legs in stance, and a moment about the vertical: one foot pushes forwards, the other
    back, as far as friction lets them."""
    left, right = now.sensed.legs
    apart = ca.fmax(left.foot[1] - right.foot[1], 0.1)
    both = choose(all_of(left.is_down, right.is_down), 1.0, 0.0)
    most = both * now.control.running.friction * ca.fmin(left.force, right.force)
    push = clip(moment[2] / apart, -most, most)
    rest = vector([moment[0], moment[1], moment[2] * (1 - both)])
    commands = []
    for leg, command in zip(now.sensed.legs, two_legs_down(now, rest, length), strict=True):
        force = vector([-leg.side * push, 0.0, 0.0])
        torques = command.torques - leg.axes.T @ ca.cross(leg.foot - leg.hip, force)
        commands.append(replace(command, torques=torques))
    return commands


def two_leg_thrust(now: Now, speed: Any) -> dict[str, Any]:
    """The length at which both springs are to be at rest, to lift off with a speed."""
    more = thrust(now.machine.mass, 2 * now.machine.stiffness, speed, now.sensed.velocity[2])
    lengths = [clip(leg.length + more, now.shortest, now.longest) for leg in now.sensed.legs]
    return {"length": lengths[0], "right_length": lengths[1]}


def kept_lengths(now: Now) -> list[Any]:
    """The lengths at which both springs are to be at rest, as remembered."""
    return [now.kept["length"], now.kept["right_length"]]
