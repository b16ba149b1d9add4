"""A joint that moves to an angle by a law of what is sensed."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from somersault._core.array import Array
from somersault.flight.behaviours._driven import Driven
from somersault.flight.behaviours._here import Here
from somersault.model import Model


@dataclass(frozen=True)
class AngleLaw(Driven, motion="angle_law"):
    """A joint that moves to the angle (rad, m) that its law commands, whatever torque it takes:
    that of its takeoff until the first command."""

    def before(self, q: Array, u: Array) -> Array:
        return q[:, 0]

    def rate_for(self, here: Here, command: Any) -> Any:
        return self.rate_towards(here, command)

    def mirrored(self, model: Model, name: str, factor: float, offset: float) -> Any:
        plan = super().mirrored(model, name, factor, offset)
        return replace(plan, law=f"{offset!r} + ({plan.law})") if offset else plan
