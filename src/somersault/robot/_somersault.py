"""The forward somersault: three steps of running done otherwise (Table 3.2)."""

from __future__ import annotations

from collections.abc import Sequence
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


class Somersault:
    """A forward somersault: its states, and what it does in them. Another maneuver of the kind does
    some of it otherwise."""

    def rise(self, now: Now) -> Any:
        """Of the centre of mass above the hips, m; here it is at the hips (§3.3.1)."""
        return 0.0

    def yaw(self, now: Now) -> Any:
        """Of the body in the hurdle's stance, to the left, rad."""
        return 0.0

    def hurdled(self, now: Now) -> list[Command]:
        """In the air before the flip: both feet forward, apart, and level."""
        gains, flip = now.control.running, now.control.flip
        velocity = now.sensed.velocity
        foot = flip.foot + now.control.errors.foot
        forward = velocity[0] * gains.stance_time / 2 + foot
        leftward = velocity[1] * gains.stance_time / 2
        down = drop(flip.leg_length, forward) + self.rise(now)
        return [
            reached(
                now, leg, level(leg, forward, leftward + leg.side * flip.width / 2, down),
                flip.piston_speed,
            )
            for leg in now.sensed.legs
        ]  # fmt: skip

    def flip_stance(self, now: Now, lengths: Sequence[Any]) -> list[Command]:
        """Forward pitch, and the body kept from tilting and twisting."""
        right = righting(now.sensed, now.control.running, 0.0)
        forward = now.control.flip.torque * (1 + now.control.errors.torque)
        return two_legs_down(now, vector([right[0], forward, right[2]]), lengths)

    def lifted(self, now: Now) -> dict[str, Any]:
        """What is remembered of the flip's lift-off."""
        return lifted(now)

    def tucked(self, now: Now) -> list[Command]:
        """In the air, until the hips have reached their place."""
        return tucked(now, now.shortest)

    def governed(self, now: Now) -> list[Command]:
        """In the air after that."""
        return governed(now)

    def foreseen(self, now: Now) -> dict[str, Any]:
        """What is remembered of a look ahead to the landing, in each period in the air."""
        return tuck_servoed(now)

    def in_window(self, now: Now) -> list[Command]:
        """Shortly before the landing."""
        return in_window(now)

    def seen_in_window(self, now: Now) -> dict[str, Any]:
        """What is remembered in each period then."""
        return self.foreseen(now)

    def touched_down(self, now: Now) -> dict[str, Any]:
        """What is remembered of the landing."""
        return touched_down(now)

    def landing_stance(self, now: Now, lengths: Sequence[Any]) -> list[Command]:
        """Somersault rate back to zero, and the body upright."""
        right = righting(now.sensed, now.control.running, upright(now))
        moment = vector([right[0], landing_pitch(now), right[2]])
        return two_legs_down(now, moment, lengths)

    def states(self) -> list[State]:
        """One after another."""
        return [*self._before(), *self._flip(), *self._air(), *self._landing()]

    def _before(self) -> list[State]:
        def stance(now: Now, length: Any) -> list[Command]:
            pitch = upright(now) + now.control.flip.hurdle_pitch
            return one_leg_down(now, pitch, length, self.yaw(now))

        return [
            State(
                "hurdle compression", "hurdle",
                lambda now: stance(now, now.control.running.leg_length),
                lambda now: [
                    Exit(
                        turns_around(now), "hurdle thrust",
                        {"length": thrust_length(now, now.control.flip.hurdle_speed)},
                    ),
                    Exit(bounced_off(now), "hurdle", next_step(now)),
                ],
            ),
            State(
                "hurdle thrust", "hurdle", lambda now: stance(now, now.kept["length"]),
                lambda now: [Exit(lifted_off(now), "hurdle", next_step(now))],
            ),
            State("hurdle", "hurdle", self.hurdled, lambda now: [
                Exit(all_of(one_down(now), now.since > KICK), "flip compression",
                     {"flip_time": now.clock}),
            ]),
        ]  # fmt: skip

    def _flip(self) -> list[State]:
        return [
            State(
                "flip compression", "flip",
                lambda now: self.flip_stance(now, [now.control.flip.leg_length] * 2),
                lambda now: [
                    Exit(
                        all_of(closing(now) >= 0, now.since > SHORTEST_STANCE), "flip thrust",
                        two_leg_thrust(
                            now, now.control.flip.lift_off_speed * (1 + now.control.errors.thrust)
                        ),
                    ),
                    Exit(both_up(now), "tuck", self.lifted(now)),
                ],
            ),
            State(
                "flip thrust", "flip", lambda now: self.flip_stance(now, kept_lengths(now)),
                lambda now: [Exit(both_up(now), "tuck", self.lifted(now))],
            ),
        ]  # fmt: skip

    def _air(self) -> list[State]:
        return [
            State(
                "tuck", "flip", self.tucked,
                lambda now: [
                    Exit(
                        hips_reached(now), "servo",
                        {"servo_time": now.clock, "servo_rate": now.sensed.rates[1]},
                    ),
                    Exit(all_of(one_down(now), now.since > 0.05), "landing compression",
                         self.touched_down(now)),
                ], self.foreseen,
            ),
            State(
                "servo", "flip", self.governed,
                lambda now: [
                    Exit(one_down(now), "landing compression", self.touched_down(now)),
                    Exit(
                        landing_window.is_open(now.kept["time_left"], now.control.flip.window),
                        "window", {"window_time": now.clock},
                    ),
                ], self.foreseen,
            ),
            State(
                "window", "flip", self.in_window,
                lambda now: [
                    Exit(one_down(now), "landing compression", self.touched_down(now))
                ], self.seen_in_window,
            ),
        ]  # fmt: skip

    def _landing(self) -> list[State]:
        return [
            State(
                "landing compression", "landing",
                lambda now: self.landing_stance(now, kept_lengths(now)),
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
                lambda now: self.landing_stance(now, kept_lengths(now)),
                lambda now: [Exit(both_up(now), "landing hop", next_step(now))],
            ),
            State(
                "landing hop", "landing", _landing_hop,
                lambda now: [Exit(now.since >= now.control.flip.hold, "flight")],
            ),
        ]  # fmt: skip


def landing_pitch(now: Now) -> Any:
    """The moment about axis 2 while landing, N m."""
    flip = now.control.flip
    error = upright(now) - now.sensed.somersault
    return flip.landing_stiffness * error - flip.landing_damping * now.sensed.rates[1]


def _landing_hop(now: Now) -> list[Command]:
    """In the air after landing: both legs keep their length for a moment."""
    gains = now.control.running
    commands = []
    for leg, kept in zip(now.sensed.legs, kept_lengths(now), strict=True):
        idle, active = idling(now, leg), now.is_active(leg)
        torques = choose(active, stepping(now, leg, gains.leg_length), idle.torques)
        commands.append(Command(torques, kept, gains.piston_speed))
    return commands
