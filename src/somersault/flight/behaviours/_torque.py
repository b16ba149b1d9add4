"""A joint that is driven by a torque against time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import one_of
from somersault._core.errors import SomersaultError
from somersault.flight.behaviours import _declared
from somersault.flight.behaviours._behaviour import JointTakeoff
from somersault.flight.behaviours._here import Here
from somersault.flight.behaviours._moving import Moving
from somersault.flight.behaviours._rows import in_order, sampled
from somersault.model import Joint
from somersault.motion import Path, check_rows, held, read_column, straight
from somersault.simulation import Numbers

_BETWEEN = {"straight": straight, "held": held}


@dataclass(frozen=True)
class Torque(Moving, motion="torque"):
    """A joint that is driven by a torque (N m; a slide by a force, N), with its spring and damper.

    The torque is a constant `torque`, and in addition samples `torques` at `times` (s), `between`
    which it is "straight" or "held"; before the first and after the last it stays what it is there.
    Samples may come from a `file` (.csv, .mot, .sto), of which a `column` is named. Spring and
    damper are the model's unless `stiffness`, `rest` and `damping` are given.
    """

    path_count: ClassVar[int] = 1

    stiffness: float | None = _declared.stiffness()
    rest: float | None = _declared.rest()
    torque: float = _declared.torque()
    times: Sequence[float] = _declared.quantity("s", default=(), row=True)
    torques: Sequence[float] = _declared.quantity("N m", "N", default=(), row=True, image="turned")
    between: str = field(default="straight", kw_only=True)
    file: str | None = field(default=None, kw_only=True, metadata={"file": True})
    column: str | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        if self.file is None:
            return
        if len(self.times) or len(self.torques):
            raise SomersaultError(f"torque has both a file {self.file} and samples; give one")
        times, torques = read_column(self.file, self.column)
        read = {"times": times, "torques": torques, "file": None, "column": None}
        for name, value in read.items():
            object.__setattr__(self, name, value)

    def settled(self, joint: Joint) -> JointTakeoff:
        where = f"joint {joint.name}"
        plan = super().settled(joint)
        assert isinstance(plan, Torque)
        if joint.kind == "ball":
            raise SomersaultError(f"{where} is a ball, which takes no torque; give it hinges")
        one_of(f"{where}: between", plan.between, _BETWEEN)
        if plan.times or plan.torques:
            try:
                check_rows(np.array(plan.times), np.array(plan.torques), "torques")
            except SomersaultError as mistake:
                raise SomersaultError(f"{where}: its torque {mistake}") from None
        stiffness = joint.stiffness if plan.stiffness is None else plan.stiffness
        rest = joint.rest if plan.rest is None else plan.rest
        return replace(plan, stiffness=stiffness, rest=rest)

    def springs(self, joint: Joint) -> tuple[str, ...]:
        return ("stiffness", "rest", "torque")

    def paths(self, joint: Joint, values: Numbers, count: int) -> tuple[Path, ...]:
        if not len(self.times):
            return (held(np.zeros(1), np.zeros(1)),)
        rows = sampled(joint, "torques", len(self.times), values, count)
        return (_BETWEEN[self.between](*rows),)

    def acting(self, here: Here) -> list[Any]:
        (passive,) = super().acting(here)
        return [passive + here.numbers["torque"] + here.paths[0][0]]

    def sound(self, joint: Joint, values: Numbers, count: int) -> Array:
        good = super().sound(joint, values, count)
        return good & in_order(joint, len(self.times), values, count)

    @property
    def conservative(self) -> bool:
        return False
