"""A replay in flight: its numbers, and what it carries from tick to tick."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault.engine import CLOCK, clock_at
from somersault.flight._replay import Replay
from somersault.flight._watch import ANGLES, RATES
from somersault.flight.behaviours import (
    Senses,
    between,
    bounded,
    commanded,
    declared,
    side_by_side,
)
from somersault.laws import Formula
from somersault.simulation import Name, Numbers

ERRORS = {f"{name}_error": name for name in (*ANGLES, *RATES)}
"""What is sensed of the body, less what it was in the nominal flight at the same phase."""
_BOUNDS = ("least", "most", "most_acceleration")


@dataclass(frozen=True)
class Playback:
    """What a replay does in flight. Numbers are those of N flights, by name."""

    replay: Replay

    def kind(self) -> Playback:
        """The same without its numbers: flights of one kind share their equations."""
        one = self.replay
        return Playback(Replay(law=one.law, every=one.every, delay=one.delay, **one.empty_tables))

    @property
    def errors(self) -> tuple[str, ...]:
        """The errors that its law has."""
        return tuple(name for name in ERRORS if name in Formula(self.replay.law).names)

    # --------------------------------------------------------------------------- numbers

    @property
    def numbers(self) -> dict[Name, float | Array]:
        """Those that may differ between flights, by names such as ("replay", "gains", "k")."""
        result: dict[Name, float | Array] = {}
        for name in declared(self.replay):
            value = getattr(self.replay, name)
            if isinstance(value, Mapping):
                result |= {("replay", name, key): x for key, x in value.items()}
            else:
                result["replay", name] = value
        return result

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of its numbers in equations."""
        return (*self.replay.tables, *_BOUNDS)

    def lasting(self, values: Numbers, count: int) -> Array:
        """Numbers of `parameters`."""
        names: list[Name] = [("replay", *name.split(".", 1)) for name in self.parameters]
        return side_by_side(values, names, count)

    def sound(self, values: Numbers, count: int) -> Array:
        """Whether the numbers of each flight are such as could be asked for by themselves."""
        names: list[Name] = [("replay", name) for name in ("rate", *_BOUNDS)]
        rate, least, most, acceleration = side_by_side(values, names, count).T
        return (least > 0) & (least <= rate) & (rate <= most) & (acceleration >= 0)

    # ----------------------------------------------------------------------------- ticks

    @property
    def carried(self) -> int:
        """How many numbers it carries from tick to tick: the phase as a clock, and the commands
        that wait."""
        return CLOCK + self.replay.waits

    def at_takeoff(self, values: Numbers, count: int) -> Array:
        """What it carries before the first tick."""
        first = np.zeros((count, self.carried))
        rate = np.broadcast_to(values["replay", "rate"], count)
        first[:, 2] = rate
        first[:, CLOCK:] = rate[:, None]
        return first

    def tick(
        self, carried: Sequence[Any], time: Any, numbers: Mapping[str, Any], senses: Senses
    ) -> list[Any]:
        """What it carries from a tick on."""
        command = commanded(self.replay, "replay", numbers, senses)
        wanted, *waiting = [*carried[CLOCK:], command]
        phase, rate, _ = clock_at(carried[:CLOCK], time)
        by = (between(wanted, numbers["least"], numbers["most"]) - rate) / self.replay.every
        return [time, phase, rate, bounded(by, numbers["most_acceleration"]), *waiting]
