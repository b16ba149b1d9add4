"""A joint that moves at a rate by a law of what is sensed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from somersault._core.array import Array
from somersault.flight.behaviours._driven import Driven
from somersault.flight.behaviours._here import Here


@dataclass(frozen=True)
class RateLaw(Driven, motion="rate_law"):
    """A joint that moves at the rate (rad/s, m/s) that its law commands, whatever torque it takes:
    that of its takeoff until the first command."""

    def before(self, q: Array, u: Array) -> Array:
        return u[:, 0]

    def rate_for(self, here: Here, command: Any) -> Any:
        return command
