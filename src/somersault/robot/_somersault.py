"""The forward somersault: three steps of running done otherwise (Table 3.2)."""

from __future__ import annotations

from typing import Any

from somersault.robot import landing_window
from somersault.robot._commands import Command, level, righting
from somersault.robot._expressions import all_of, choose, vector
from somersault.robot._in_the_air import (
    governed,
    hips_reached,
    in_window,
    lifted,
    touched_down,
    tuck_servoed,
    tucked,
)
from somersault.robot._running import (
    SHORTEST_STANCE,
    bounced_off,
    idling,
    lifted_off,
    next_step,
    one_leg_down,
    stepping,
    thrust_length,
    turns_around,
    upright,
)
from somersault.robot._states import Exit, Now, State
from somersault.robot._two_legs import (
    both_up,
    closing,
    drop,
    kept_lengths,
    one_down,
    reached,
    two_leg_thrust,
    two_legs_down,
)

KICK = 0.02  # s that an unasked push in the hurdle takes


def hurdle_is_due(now: Now) -> Any:
    """Whether the step that begins is to be the hurdle."""
    return all_of(now.clock >= now.control.flip.at, now.kept["turns"] < 0.5)


# ---------------------------------------------------------------------------------- hurdle


def _hurdle_pitch(now: Now) -> Any:
    return upright(now) + now.control.flip.hurdle_pitch


def _hurdle(now: Now) -> list[Command]:
    """In the air before the flip: both feet forward, apart, and level."""
    gains, flip = now.control.running, now.control.flip
    velocity = now.sensed.velocity
    foot = flip.foot + now.control.errors.foot
    forward = velocity[0] * gains.stance_time / 2 + foot
    leftward = velocity[1] * gains.stance_time / 2
    down = drop(flip.leg_length, forward)
    return [
        reached(
            now, leg, level(leg, forward, leftward + leg.side * flip.width / 2, down),
            flip.piston_speed,
        )
        for leg in now.sensed.legs
    ]  # fmt: skip


# ------------------------------------------------------------------------------------ flip


def _flip_moment(now: Now) -> Any:
    """Forward pitch, and the body kept from tilting and twisting."""
    right = righting(now.sensed, now.control.running, 0.0)
    forward = now.control.flip.torque * (1 + now.control.errors.torque)
    return vector([right[0], forward, right[2]])


# --------------------------------------------------------------------------------- landing


def _landing_moment(now: Now) -> Any:
    """Somersault rate back to zero, and the body upright."""
    right = righting(now.sensed, now.control.running, upright(now))
    flip = now.control.flip
    pitch = (
        flip.landing_stiffness * (upright(now) - now.sensed.somersault)
        - flip.landing_damping * now.sensed.rates[1]
    )
    return vector([right[0], pitch, right[2]])


def _landing_hop(now: Now) -> list[Command]:
    """In the air after landing: both legs keep their length for a moment."""
    gains = now.control.running
    commands = []
    for leg, kept in zip(now.sensed.legs, kept_lengths(now), strict=True):
        idle, active = idling(now, leg), now.is_active(leg)
        torques = choose(active, stepping(now, leg, gains.leg_length), idle.torques)
        commands.append(Command(torques, kept, gains.piston_speed))
    return commands


def somersault() -> list[State]:
    """The states of a somersault."""
    return [
        State(
            "hurdle compression", "hurdle",
            lambda now: one_leg_down(now, _hurdle_pitch(now), now.control.running.leg_length),
            lambda now: [
                Exit(
                    turns_around(now), "hurdle thrust",
                    {"length": thrust_length(now, now.control.flip.hurdle_speed)},
                ),
                Exit(bounced_off(now), "hurdle", next_step(now)),
            ],
        ),
        State(
            "hurdle thrust", "hurdle",
            lambda now: one_leg_down(now, _hurdle_pitch(now), now.kept["length"]),
            lambda now: [Exit(lifted_off(now), "hurdle", next_step(now))],
        ),
        State("hurdle", "hurdle", _hurdle, lambda now: [
            Exit(all_of(one_down(now), now.since > KICK), "flip compression",
                 {"flip_time": now.clock}),
        ]),
        State(
            "flip compression", "flip",
            lambda now: two_legs_down(
                now, _flip_moment(now), [now.control.flip.leg_length] * 2
            ),
            lambda now: [
                Exit(
                    all_of(closing(now) >= 0, now.since > SHORTEST_STANCE), "flip thrust",
                    two_leg_thrust(
                        now, now.control.flip.lift_off_speed * (1 + now.control.errors.thrust)
                    ),
                ),
                Exit(both_up(now), "tuck", lifted(now)),
            ],
        ),
        State(
            "flip thrust", "flip",
            lambda now: two_legs_down(now, _flip_moment(now), kept_lengths(now)),
            lambda now: [Exit(both_up(now), "tuck", lifted(now))],
        ),
        State(
            "tuck", "flip", lambda now: tucked(now, now.shortest),
            lambda now: [
                Exit(
                    hips_reached(now), "servo",
                    {"servo_time": now.clock, "servo_rate": now.sensed.rates[1]},
                ),
                Exit(all_of(one_down(now), now.since > 0.05), "landing compression",
                     touched_down(now)),
            ], tuck_servoed,
        ),
        State(
            "servo", "flip", governed,
            lambda now: [
                Exit(one_down(now), "landing compression", touched_down(now)),
                Exit(
                    landing_window.is_open(now.kept["time_left"], now.control.flip.window),
                    "window", {"window_time": now.clock},
                ),
            ], tuck_servoed,
        ),
        State(
            "window", "flip", in_window,
            lambda now: [Exit(one_down(now), "landing compression", touched_down(now))],
            tuck_servoed,
        ),
        State(
            "landing compression", "landing",
            lambda now: two_legs_down(now, _landing_moment(now), kept_lengths(now)),
            lambda now: [
                Exit(
                    all_of(closing(now) >= 0, now.since > SHORTEST_STANCE), "landing thrust",
                    two_leg_thrust(now, now.control.flip.landing_lift_off),
                ),
                Exit(both_up(now), "landing hop", next_step(now)),
            ],
        ),
        State(
            "landing thrust", "landing",
            lambda now: two_legs_down(now, _landing_moment(now), kept_lengths(now)),
            lambda now: [Exit(both_up(now), "landing hop", next_step(now))],
        ),
        State(
            "landing hop", "landing", _landing_hop,
            lambda now: [Exit(now.since >= now.control.flip.hold, "flight")],
        ),
    ]  # fmt: skip
