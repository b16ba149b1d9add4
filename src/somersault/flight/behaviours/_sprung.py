"""A joint with a spring."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.flight.behaviours import _declared
from somersault.flight.behaviours._behaviour import JointTakeoff
from somersault.flight.behaviours._moving import Moving, stretch
from somersault.model import Joint
from somersault.simulation import Name, Numbers

# What is given without dimension: which number it is of Ω to which power times I.
NON_DIMENSIONAL = {"K": ("stiffness", 2), "B": ("damping", 1)}


@dataclass(frozen=True)
class Sprung(Moving, motion="sprung"):
    """A joint with a spring, slack at `rest`, and a damper.

    The spring is the model's unless it is given: by its `stiffness` (N m/rad, N/m), or without
    dimension by `K` = stiffness / (Ω² I), as the damper by `B` = damping / (Ω I), Ω being the rate
    of the flight's nominal spin and I the inertia of all that is outboard, about the joint's axis.
    With `hold` it is pretensioned so that at its takeoff angle it balances the nominal spin.
    """

    stiffness: float | None = _declared.stiffness()
    rest: float | None = _declared.rest()
    hold: bool = False
    K: float | None = _declared.quantity("1", usual=0.0)
    B: float | None = _declared.quantity("1", least=0.0)

    def settled(self, joint: Joint) -> JointTakeoff:
        plan = super().settled(joint)
        assert isinstance(plan, Sprung)
        for name, (other, _) in NON_DIMENSIONAL.items():
            if getattr(self, name) is not None and getattr(self, other) is not None:
                raise SomersaultError(
                    f"joint {joint.name} has both {name} and a {other}, which are one thing with "
                    "and without dimension; give one"
                )
        if plan.hold and plan.rest is not None:
            raise SomersaultError(
                f"joint {joint.name}: hold is for a sprung joint without a rest of its own"
            )
        if joint.kind == "ball" and (plan.rest is not None or plan.hold):
            raise SomersaultError(
                f"joint {joint.name} is a ball: it can be locked, free or sprung about the pose it "
                "is drawn in"
            )
        stiffness = joint.stiffness if plan.stiffness is None else plan.stiffness
        at: Any = plan.angle
        rest = at if plan.hold else joint.rest if plan.rest is None else plan.rest
        return replace(plan, stiffness=stiffness, rest=rest)

    def springs(self, joint: Joint) -> tuple[str, ...]:
        return ("stiffness", "rest")

    def numbers(self, joint: Joint) -> dict[Name, float | Array]:
        every = super().numbers(joint)
        left_out = {"rest"} if self.hold or joint.kind == "ball" else set()
        left_out |= {"stiffness"} if self.K is not None else set()
        left_out |= {"damping"} if self.B is not None else set()
        return {n: x for n, x in every.items() if n[0] not in left_out}

    def lasting(self, joint: Joint, values: Numbers, q: Array) -> Array:
        if self.hold:
            values = {**values, ("rest", joint.name): values["angle", joint.name]}
        return super().lasting(joint, values, q)

    def energy(self, joint: Joint, q: Array) -> Array:
        by = stretch(q, self.rest or 0.0)
        return 0.5 * (self.stiffness or 0.0) * by**2 - self.pretension * by
