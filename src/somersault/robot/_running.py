"""Running on one leg at a time: Raibert's three parts of control (§3.4).

In stance the hips keep the body upright and the leg's piston adds to the spring what the next
flight needs; in flight the foot goes to where the speed will be right.
"""

from __future__ import annotations

from typing import Any

from somersault.robot import landing_window
from somersault.robot._commands import (
    Command,
    foot_angles,
    held,
    righting,
    stance_torques,
    thrust,
    under,
)
from somersault.robot._control import Running
from somersault.robot._expressions import all_of, choose, clip
from somersault.robot._sensed import SensedLeg
from somersault.robot._states import Exit, Now, State

SHORTEST_STANCE = 0.02  # s, before which no foot lifts off
LONGEST_BOUNCE = 0.06  # s


def upright(now: Now) -> Any:
    """The somersault angle of an upright body, after so many somersaults."""
    return now.kept["turns"] * 6.283185307179586


def stepping(now: Now, leg: SensedLeg, length: Any) -> Any:
    """Torques of a leg in the air that go to where its foot is to land."""
    gains, velocity = now.control.running, now.sensed.velocity
    most = gains.speed_change
    wanted = clip(gains.speed, velocity[0] - most, velocity[0] + most)
    forward = landing_window.displacement(
        velocity[0], wanted, gains.stance_time, gains.speed_gain, 0.0
    )
    leftward = landing_window.displacement(
        velocity[1], 0.0, gains.stance_time, gains.speed_gain, leg.side * gains.foot_offset
    )
    place = under(leg, forward, leftward, length)
    return held(leg, now.control.hips, (*foot_angles(now.sensed, leg, place), 0.0))


def idling(now: Now, leg: SensedLeg) -> Command:
    """The leg whose turn it is not: short, and below its hip."""
    gains = now.control.running
    place = under(leg, leg.hip[0], leg.hip[1], gains.idle_length)
    torques = held(leg, now.control.hips, (*foot_angles(now.sensed, leg, place), 0.0))
    return Command(torques, gains.idle_length, gains.piston_speed)


def _flight(now: Now) -> list[Command]:
    gains = now.control.running
    commands = []
    for leg in now.sensed.legs:
        idle, active = idling(now, leg), now.is_active(leg)
        torques = stepping(now, leg, gains.leg_length)
        length = choose(active, gains.leg_length, idle.length)
        commands.append(Command(choose(active, torques, idle.torques), length, gains.piston_speed))
    return commands


def one_leg_down(now: Now, pitch: Any, length: Any, yaw: Any = 0.0) -> list[Command]:
    """The leg whose turn it is in stance with the body kept at a pitch, the other idle."""
    gains = now.control.running
    moment = righting(now.sensed, gains, pitch, yaw)
    commands = []
    for leg, torques in zip(
        now.sensed.legs, stance_torques(now.sensed, gains, moment), strict=True
    ):
        idle, active = idling(now, leg), now.is_active(leg)
        commands.append(
            Command(
                choose(active, torques, idle.torques), choose(active, length, idle.length),
                gains.piston_speed,
            )
        )  # fmt: skip
    return commands


def of_active(now: Now, quantity: str) -> Any:
    """A quantity of the leg whose turn it is."""
    left, right = (getattr(leg, quantity) for leg in now.sensed.legs)
    return choose(now.kept["side"] > 0, left, right)


def turns_around(now: Now) -> Any:
    """Whether the active leg has been compressed as far as it will be."""
    return all_of(of_active(now, "speed") >= 0, now.since > 0.01)


def thrust_length(now: Now, speed: Any) -> Any:
    """How long the active leg's spring is to be at rest, to lift off with a speed."""
    factor = now.control.running.thrust_factor
    more = thrust(now.machine.mass, now.machine.stiffness, factor * speed, now.sensed.velocity[2])
    return clip(of_active(now, "length") + more, now.shortest, now.longest)


def lifted_off(now: Now) -> Any:
    """Whether the active foot has left the ground."""
    return all_of(of_active(now, "load") <= 1.0, now.since > SHORTEST_STANCE)


def bounced_off(now: Now) -> Any:
    """Whether the foot has left the ground although the leg was never compressed to its end: a foot
    that touches down on the move may lose the ground for a moment."""
    return all_of(of_active(now, "load") <= 1.0, now.since > LONGEST_BOUNCE)


def next_step(now: Now) -> dict[str, Any]:
    """What is remembered when a step is over."""
    landed = now.kept["turns"] > 0
    return {
        "side": -now.kept["side"],
        "steps": now.kept["steps"] + 1,
        "steps_after": now.kept["steps_after"] + choose(landed, 1.0, 0.0),
    }


def running(hurdle_is_due: Any) -> list[State]:
    """The states of running; `hurdle_is_due` says of `Now` whether a step is to be a hurdle."""

    def landings(now: Now) -> list[Exit]:
        down = of_active(now, "load") > 1.0
        return [
            Exit(all_of(down, hurdle_is_due(now)), "hurdle compression"),
            Exit(down, "compression"),
        ]

    def gains(now: Now) -> Running:
        return now.control.running

    return [
        State("flight", "running", _flight, landings),
        State(
            "compression", "running",
            lambda now: one_leg_down(now, upright(now), gains(now).leg_length),
            lambda now: [
                Exit(
                    turns_around(now), "thrust",
                    {"length": thrust_length(now, gains(now).lift_off_speed)},
                ),
                Exit(bounced_off(now), "flight", next_step(now)),
            ],
        ),
        State(
            "thrust", "running",
            lambda now: one_leg_down(now, upright(now), now.kept["length"]),
            lambda now: [Exit(lifted_off(now), "flight", next_step(now))],
        ),
    ]  # fmt: skip
