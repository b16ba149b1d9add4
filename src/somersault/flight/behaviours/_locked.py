"""A joint that holds its angle."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from somersault._core.array import Array
from somersault.flight.behaviours import _declared
from somersault.flight.behaviours._behaviour import Angle, JointTakeoff
from somersault.flight.behaviours._here import Here, Known
from somersault.flight.behaviours._moving import standing, takeoff_angle
from somersault.model import Joint
from somersault.simulation import Numbers


@dataclass(frozen=True)
class Locked(JointTakeoff, motion="locked"):
    """A joint that holds its `angle` (rad, m; a rotation vector for a ball)."""

    angle: Angle = _declared.angle()

    def settled(self, joint: Joint) -> JointTakeoff:
        plan = self._checked(joint)
        return replace(plan, angle=takeoff_angle(joint, plan.angle))

    def parameters(self, joint: Joint) -> tuple[str, ...]:
        return ("angle",) if joint.kind != "ball" else ("w", "x", "y", "z")

    def place(self, here: Here) -> Known:
        still: list[Any] = [0.0] * here.joint.speeds
        return Known(list(here.numbers.values()), still, still)

    def begin(self, joint: Joint, values: Numbers, count: int) -> tuple[Array, Array]:
        return standing(joint, values, count)

    def lasting(self, joint: Joint, values: Numbers, q: Array) -> Array:
        return q
