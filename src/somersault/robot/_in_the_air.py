"""The somersault from lift-off to touchdown: tuck, tuck servo and landing window."""

from __future__ import annotations

from typing import Any

import casadi as ca

from somersault.robot import landing_window, leg_spring, tuck_servo
from somersault.robot._commands import Command, held, level
from somersault.robot._expressions import all_of, any_of, choose, clip
from somersault.robot._running import upright
from somersault.robot._sensed import SensedLeg
from somersault.robot._states import Now
from somersault.robot._two_legs import drop, mean, reached

_AT_REST = 0.08, 2.0  # rad and rad/s within which the hips have reached their place
_LONGEST_SWING = 0.25  # s after which the servo begins all the same
_QUICK = 10.0  # m/s of a piston that only holds a force


def lifted(now: Now) -> dict[str, Any]:
    """What is remembered of the flip's lift-off; the robot's estimate of its speed errs."""
    speed = now.sensed.velocity[2]
    return {
        "lift_off_time": now.clock,
        "lift_off_speed": speed,
        "lift_off_estimate": speed * (1 + now.control.errors.lift_off_speed),
        "lift_off_height": now.sensed.height,
        "lift_off_forward": now.sensed.velocity[0],
        "lift_off_rate": now.sensed.rates[1],
        "lift_off_somersault": now.sensed.somersault - upright(now),
        "servo_length": now.shortest,
    }


def tucked(now: Now, length: Any) -> list[Command]:
    """Feet back and apart, and legs of a length."""
    flip = now.control.flip
    commands = []
    for k, leg in enumerate(now.sensed.legs):
        torques = held(leg, now.control.hips, (flip.feet_back, abduction(now, k), 0.0))
        commands.append(Command(torques, length, flip.piston_speed))
    return commands


def abduction(now: Now, which: int) -> Any:
    """The angle of a hip about axis 1 with which the feet are as far apart as at the landing."""
    out = now.control.flip.width / 2 - abs(float(now.machine.hips[which][1]))
    return now.sensed.legs[which].side * ca.atan2(out, 0.75)


def governed(now: Now) -> list[Command]:
    """Feet back and apart, and the legs as the tuck servo has them; or, where they hang on soft
    springs, drawn by the piston's stop as those would draw them."""
    flip = now.control.flip
    commands = []
    for leg, command in zip(now.sensed.legs, tucked(now, now.kept["servo_length"]), strict=True):
        force = leg_spring.pull(
            flip.leg_spring, flip.leg_rest, flip.leg_damping, leg.length, leg.speed
        )
        hangs = flip.leg_spring > 0
        against = now.machine.stop_damping * leg.speed - force
        drawn = clip(leg.length + against / now.machine.stop, now.shortest, now.longest)
        speed = choose(hangs, _QUICK, command.piston_speed)
        commands.append(Command(command.torques, choose(hangs, drawn, command.length), speed))
    return commands


def hips_reached(now: Now) -> Any:
    """Whether the hips have reached their place."""
    angle, rate = _AT_REST
    wrong = [ca.fabs(leg.angles[0] - now.control.flip.feet_back) for leg in now.sensed.legs]
    fast = [ca.fabs(leg.rates[0]) for leg in now.sensed.legs]
    there = all_of(*(w < angle for w in wrong), *(f < rate for f in fast))
    return any_of(there, now.since > _LONGEST_SWING)


def tuck(now: Now) -> tuck_servo.Tuck:
    """What the servo knows of the robot."""
    m = now.machine
    return tuck_servo.Tuck(
        m.inertia, m.leg_inertia, m.lower_leg, m.offset, now.shortest, now.longest
    )


def lift_off(now: Now) -> tuck_servo.LiftOff:
    """What the robot takes its lift-off to have been."""
    kept = now.kept
    ago = now.clock - kept["lift_off_time"]
    return tuck_servo.LiftOff(kept["lift_off_estimate"], kept["lift_off_height"], ago)


def landing_place(now: Now) -> Any:
    """How far in front of the centre of mass the feet are to land, m."""
    flip = now.control.flip
    return landing_window.displacement(
        now.sensed.velocity[0], flip.landing_speed, now.control.running.stance_time,
        flip.landing_gain, flip.landing_foot,
    )  # fmt: skip


def remaining(now: Now, length: Any) -> tuck_servo.Somersault:
    """What is left of the somersault, for legs that land with a length."""
    known, flip = tuck(now), now.control.flip
    angle, rate = mean(now, lambda leg: leg.angles[0]), mean(now, lambda leg: leg.rates[0])
    momentum = known.whole(length) * now.sensed.rates[1] + known.legs(length) * rate
    lean = landing_window.inclination(landing_place(now), length)
    wanted = upright(now) + flip.attitude
    lands = landing_window.hip_angle(lean, wanted)
    tracks = flip.window > 0
    sweep = choose(tracks, angle - lands, angle - flip.feet_back)
    return tuck_servo.Somersault(
        ca.fmax(momentum, 1.0), wanted - now.sensed.somersault, sweep, lean
    )


def _present_length(now: Now) -> Any:
    """Mean length of the legs, m."""
    return mean(now, lambda leg: leg.length)


def tuck_servoed(now: Now) -> dict[str, Any]:
    """The length that the tuck servo wants, and the times that it compares."""
    length = _present_length(now)
    known, up = tuck(now), lift_off(now)
    left = remaining(now, length)
    wanted = tuck_servo.leg_length(known, up, left, now.kept["servo_length"])
    flip = now.control.flip
    wanted = choose(flip.servo > 0, wanted, flip.held_length)
    wanted = choose(flip.leg_spring > 0, length, wanted)
    return {
        "servo_length": wanted,
        "time_left": tuck_servo.flight_time(up, ca.cos(left.lean) * wanted) - up.ago,
        "turning_left": tuck_servo.time_to_turn(known, left, length),
    }


def in_window(now: Now) -> list[Command]:
    """Feet kept where they are to land, level, as the body turns."""
    velocity, flip = now.sensed.velocity, now.control.flip
    forward = landing_place(now)
    leftward = velocity[1] * now.control.running.stance_time / 2
    down = drop(now.kept["servo_length"], forward)
    return [
        reached(
            now, leg, level(leg, forward, leftward + leg.side * flip.width / 2, down),
            flip.piston_speed, -now.sensed.rates[1],
        )
        for leg in now.sensed.legs
    ]  # fmt: skip


def inclination(now: Now) -> Any:
    """The legs' inclination, positive with the feet back, rad."""

    def of(leg: SensedLeg) -> Any:
        way = leg.foot - leg.hip
        return ca.atan2(-way[0], -way[2])

    return mean(now, of)


def touched_down(now: Now) -> dict[str, Any]:
    """What is remembered of the landing."""
    attitude = now.sensed.attitude
    return {
        "landing_time": now.clock,
        "landing_somersault": now.sensed.somersault - upright(now),
        "landing_rate": now.sensed.rates[1],
        "landing_tilt": ca.atan2(
            -attitude[1, 2], ca.sqrt(attitude[1, 0] ** 2 + attitude[1, 1] ** 2)
        ),
        "landing_twist": ca.atan2(attitude[1, 0], attitude[1, 1]),
        "landing_inclination": inclination(now),
        "landing_wanted": landing_window.inclination(
            landing_place(now), _present_length(now)
        ),
        "landing_forward": now.sensed.velocity[0],
        "turns": now.kept["turns"] + 1,
        "length": now.kept["left_piston"],
        "right_length": now.kept["right_piston"],
    }  # fmt: skip
