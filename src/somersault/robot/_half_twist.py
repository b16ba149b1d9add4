"""The somersault with half a twist (§6.4): what it does otherwise than a plain one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import casadi as ca

from somersault.robot import landing_window, tuck_servo
from somersault.robot._commands import Command, held, level
from somersault.robot._expressions import choose, clip, vector, wrapped
from somersault.robot._in_the_air import abduction, landing_place, lift_off, lifted, touched_down
from somersault.robot._running import upright
from somersault.robot._somersault import Somersault, landing_pitch
from somersault.robot._states import Now
from somersault.robot._two_legs import drop, mean, reached, two_legs_turning
from somersault.robot.rigid_turn import facing, turned

_WIDEST = 0.9  # rad of a straddle
_NEWTON = 0.2  # of a step of Newton's, each period: what it steps on is foreseen anew in the next


class HalfTwist(Somersault):
    """A somersault in which the body also turns about its long axis.

    Its flip step aims at rates of somersault and twist; both are then what the momentum makes them.
    In the air the legs' length is governed by the attitude that is foreseen at the landing, and how
    far they straddle by the twist. It lands on the heading that it has, and turns to the one that
    is wanted as it runs on.
    """

    def rise(self, now: Now) -> Any:
        """Of the centre of mass above the hips, m."""
        return now.machine.short.rise

    def yaw(self, now: Now) -> Any:
        """Against the twist."""
        return -now.control.twist.wind_up

    def flip_stance(self, now: Now, lengths: Sequence[Any]) -> list[Command]:
        """Towards rates about the body's own axes, which are what decides how it will twist, and a
        lean."""
        twist, most = now.control.twist, now.control.flip.torque
        attitude = now.sensed.attitude
        rates = attitude.T @ now.sensed.rates
        lean = attitude[2, 1]
        roll = twist.roll_stiffness * (twist.lean - lean) - twist.roll_damping * rates[0]
        wanted = twist.pitch_rate * (1 + twist.pace * (twist.lift_off_speed / _lift_off(now) - 1))
        pitch = clip(twist.pitch_damping * (wanted - rates[1]), -most, most)
        yaw = clip(twist.yaw_damping * (twist.yaw_rate - rates[2]), -twist.torque, twist.torque)
        much = 1 + now.control.errors.torque
        moment = attitude @ vector([roll, much * pitch, much * yaw])
        return two_legs_turning(now, moment, lengths)

    def lifted(self, now: Now) -> dict[str, Any]:
        """The heading, too."""
        return lifted(now) | {"course": now.kept["heading"]}

    def tucked(self, now: Now) -> list[Command]:
        """Legs short, one in front of the other."""
        return _straddled(now, now.shortest)

    def governed(self, now: Now) -> list[Command]:
        """Legs of the length and as far apart as is wanted."""
        return _straddled(now, now.kept["servo_length"])

    def foreseen(self, now: Now) -> dict[str, Any]:
        """Attitude at the landing, and by it the legs' length and straddle."""
        here, flip, twist = now.sensed, now.control.flip, now.control.twist
        up, guess = lift_off(now), now.kept["servo_length"]
        length = mean(now, lambda leg: leg.length)
        left = ca.fmax(tuck_servo.flight_time(up, guess + now.machine.short.rise) - up.ago, 0)
        rates = here.attitude.T @ here.rates
        swing = _legs(now, length) * mean(now, lambda leg: leg.rates[0])
        momentum = here.attitude @ (_inertias(now, length) * rates + vector([0, swing, 0]))
        then = turned(here.attitude, momentum, _inertias(now, guess), left)
        lands = ca.atan2(then[0, 2], then[2, 2])
        wrong = wrapped(flip.attitude - lands)
        wanted = clip(guess + _NEWTON * wrong / _slope(now, left), now.shortest, now.longest)
        twisted = wrapped(now.kept["heading"] + facing(then) - now.kept["course"] - twist.angle)
        straddle = clip(twist.straddle + twist.straddle_gain * twisted, 0.0, _WIDEST)
        return {
            "servo_length": choose(flip.servo > 0, wanted, flip.held_length),
            "straddle": straddle,
            "time_left": left,
            "turning_left": left + wrong / ca.fmax(here.rates[1], 1.0),
        }

    def in_window(self, now: Now) -> list[Command]:
        """Feet where they are to land, as seen from the way that the robot faces."""
        flip, running, velocity = now.control.flip, now.control.running, now.sensed.velocity
        forward = landing_place(now)
        leftward = landing_window.displacement(
            velocity[1], 0.0, running.stance_time, now.control.twist.sideways_gain, 0.0
        )
        down = drop(now.kept["servo_length"], forward) + self.rise(now)
        return [
            reached(
                now, leg, level(leg, forward, leftward + leg.side * flip.width / 2, down),
                flip.piston_speed, -now.sensed.rates[1],
            )
            for leg in now.sensed.legs
        ]  # fmt: skip

    def seen_in_window(self, now: Now) -> dict[str, Any]:
        """The course is the way that the robot faces, from then on."""
        return self.foreseen(now) | {"heading": _heading(now)}

    def touched_down(self, now: Now) -> dict[str, Any]:
        """How far the heading has to turn after it, too."""
        heading = _heading(now)
        short = wrapped(now.kept["course"] + now.control.twist.angle - heading)
        return touched_down(now) | {
            "heading": heading,
            "to_turn": short,
            "landing_twist": now.control.twist.angle - short,
        }

    def landing_stance(self, now: Now, lengths: Sequence[Any]) -> list[Command]:
        """All rates back to zero, and the body upright, whichever way it faces."""
        twist, rates = now.control.twist, now.sensed.rates
        lean = now.sensed.attitude[2, 1]
        roll = -twist.landing_roll_stiffness * lean - twist.landing_roll_damping * rates[0]
        yaw = -twist.landing_yaw_damping * rates[2]
        return two_legs_turning(now, vector([roll, landing_pitch(now), yaw]), lengths)


def _lift_off(now: Now) -> Any:
    """The speed at which it is to lift off, by what the springs hold, m/s; that which is expected
    as long as it still comes down."""
    up, machine = now.sensed.velocity[2], now.machine
    bent = [leg.force / machine.stiffness for leg in now.sensed.legs]
    stored = machine.stiffness * (bent[0] ** 2 + bent[1] ** 2) / machine.mass
    square = up**2 + stored - tuck_servo.GRAVITY * (bent[0] + bent[1])
    speed = ca.sqrt(ca.fmax(square, 1.0)) * (1 + now.control.errors.lift_off_speed)
    return choose(up > 0, speed, now.control.twist.lift_off_speed)


def _straddled(now: Now, length: Any) -> list[Command]:
    """Legs of a length, apart, and one in front of the other."""
    flip, commands = now.control.flip, []
    for k, leg in enumerate(now.sensed.legs):
        fore = flip.feet_back - leg.side * now.kept["straddle"]
        torques = held(leg, now.control.hips, (fore, abduction(now, k), 0.0))
        commands.append(Command(torques, length, flip.piston_speed))
    return commands


def _heading(now: Now) -> Any:
    """The way that the robot faces, rad."""
    return now.kept["heading"] + facing(now.sensed.attitude)


def _inertias(now: Now, length: Any) -> Any:
    """About the torso's axes with straight legs of a length, kg m²."""
    short, long = now.machine.short.inertias, now.machine.long.inertias
    return ca.DM(short) + _share(now, length) * ca.DM(long - short)


def _share(now: Now, length: Any) -> Any:
    return (length - now.shortest) / (now.longest - now.shortest)


def _legs(now: Now, length: Any) -> Any:
    """Inertia of both legs about the hips, kg m²."""
    machine = now.machine
    return machine.leg_inertia + machine.lower_leg * (length - machine.offset) ** 2


def _slope(now: Now, left: Any) -> Any:
    """How much less the body will have turned with longer legs, rad/m: it turns more slowly, and
    lands sooner."""
    short, long = now.machine.short.inertias[1], now.machine.long.inertias[1]
    slower = float((long - short) / (now.longest - now.shortest) / long)
    turn = ca.fmax(upright(now) + now.control.flip.attitude - now.sensed.somersault, 0.5)
    up = lift_off(now)
    fall = ca.fmax(tuck_servo.GRAVITY * (up.ago + left) - up.speed, 1.0)
    return -turn * (slower + 1 / (ca.fmax(left, 0.1) * fall))
