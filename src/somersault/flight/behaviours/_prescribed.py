"""A joint that is moved along a path, whatever it takes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.flight.behaviours import _declared
from somersault.flight.behaviours._behaviour import JointTakeoff
from somersault.flight.behaviours._here import Here, Known
from somersault.flight.behaviours._limits import check_limits
from somersault.flight.behaviours._rows import in_order, sampled
from somersault.model import Joint
from somersault.motion import Path, check_rows, moves, polynomial
from somersault.simulation import Name, Numbers

REPLAY_RATE: Name = ("replay", "rate")
"""The rate at which paths are played at takeoff, 1 where they have none."""


@dataclass(frozen=True)
class OnPath(JointTakeoff):
    """A joint that has a path: smooth moves through `angles` (rad, m) at `times` (s), at rest at
    each, or a `path` as a `Motion` has it."""

    path_count: ClassVar[int] = 1

    times: Sequence[float] = _declared.quantity("s", default=(), row=True)
    angles: Sequence[float] = _declared.quantity(
        "rad", "m", default=(), row=True, image="angle", limited=True
    )
    path: Path | None = field(default=None, kw_only=True)

    def settled(self, joint: Joint) -> JointTakeoff:
        where = f"joint {joint.name}"
        plan = super().settled(joint)
        assert isinstance(plan, OnPath)
        if joint.kind == "ball":
            raise SomersaultError(
                f"{where} is a ball: it can be locked, free or sprung about the pose it is drawn in"
            )
        if plan.path is not None:
            if not isinstance(plan.path, Path):
                raise SomersaultError(
                    f"{where}: path is {type(plan.path).__name__}, not one joint's path; of a "
                    "Motion take the joints that prescribed gives"
                )
            if plan.times or plan.angles:
                raise SomersaultError(f"{where} has both a path and times with angles; give one")
            return plan  # of a `Motion`, which has seen to limits with a slack of its own
        try:
            check_rows(np.array(plan.times), np.array(plan.angles), "angles")
        except SomersaultError as mistake:
            raise SomersaultError(f"{where}: its path {mistake}") from None
        check_limits(joint, tuple(plan.angles))  # a smooth move does not overshoot its ends
        return plan

    def paths(self, joint: Joint, values: Numbers, count: int) -> tuple[Path, ...]:
        if self.path is not None:
            return (self.path,)
        return (moves(*sampled(joint, "angles", len(self.times), values, count)),)

    def whole(self) -> Path:
        """Its path, of one flight.

        Returns
        -------
        Path
        """
        return self.path or moves(np.array(self.times), np.array(self.angles))

    def begin(self, joint: Joint, values: Numbers, count: int) -> tuple[Array, Array]:
        (path,) = self.paths(joint, values, count)
        since, coefficients = path.at(np.zeros((count, 1)))
        angle, rate, _ = polynomial(-since, list(np.moveaxis(coefficients, -1, 0)))
        rate = rate * np.reshape(values.get(REPLAY_RATE, 1.0), (-1, 1))
        return np.broadcast_to(angle, (count, 1)), np.broadcast_to(rate, (count, 1))

    def wanted(self, here: Here) -> list[Any]:
        return [here.paths[0][0]]

    def sound(self, joint: Joint, values: Numbers, count: int) -> Array:
        good = super().sound(joint, values, count)
        return good & in_order(joint, len(self.times), values, count)

    @property
    def conservative(self) -> bool:
        return False


@dataclass(frozen=True)
class Prescribed(OnPath, motion="prescribed"):
    """A joint that moves along its path, whatever torque that takes."""

    def place(self, here: Here) -> Known:
        value, rate, acceleration = here.paths[0]
        return Known([value], [rate], [acceleration])


def along(one: OnPath) -> Prescribed:
    """The same path, followed exactly."""
    return replace(Prescribed(), times=one.times, angles=one.angles, path=one.path)
