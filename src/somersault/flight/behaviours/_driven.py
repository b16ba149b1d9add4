"""A joint that is driven at the acceleration a law calls for, whatever that takes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from somersault._core.array import Array
from somersault._core.numbers import MOST
from somersault.flight.behaviours import _declared
from somersault.flight.behaviours._behaviour import Angle, JointTakeoff
from somersault.flight.behaviours._by_law import ByLaw
from somersault.flight.behaviours._here import Here
from somersault.flight.behaviours._law import between, bounded
from somersault.flight.behaviours._locked import Locked
from somersault.flight.behaviours._moving import standing, takeoff_angle
from somersault.model import Joint
from somersault.simulation import Name, Numbers


@dataclass(frozen=True)
class Driven(ByLaw):
    """A joint that starts from an `angle` (rad, m) at a `rate` and moves as its law commands.

    Between two ticks its acceleration is constant: the one that brings it to the commanded rate by
    the next tick, as far as `most_rate`, the joint's limits and `most_acceleration` allow.
    """

    in_state: ClassVar[bool] = True
    bounds: ClassVar[tuple[str, ...]] = ("most_rate", "most_acceleration")

    angle: Angle = _declared.angle()
    rate: Angle = _declared.rate()
    most_rate: float = _declared.quantity("rad/s", "m/s", default=MOST, least=0.0)
    most_acceleration: float = _declared.quantity("rad/s2", "m/s2", default=MOST, least=0.0)

    def settled(self, joint: Joint) -> JointTakeoff:
        plan = super().settled(joint)
        assert isinstance(plan, Driven)
        return replace(plan, angle=takeoff_angle(joint, plan.angle))

    def plainest(self, joint: Joint, sensed: frozenset[str], varied: frozenset[Name]) -> Any:
        if self.rate or varied & self.numbers(joint).keys():
            return self
        (stays,) = self.before(np.array([[self.angle]]), np.zeros((1, 1)))
        return Locked(angle=self.angle) if self._always(sensed, varied) == stays else self

    def begin(self, joint: Joint, values: Numbers, count: int) -> tuple[Array, Array]:
        q, _ = standing(joint, values, count)
        return q, _declared.side_by_side(values, [("rate", joint.name)], count)

    def accelerations(self, here: Here) -> list[Any]:
        return [here.carried[0]]

    def acted_on(self, here: Here, command: Any) -> Any:
        wanted = bounded(self.rate_for(here, command), here.numbers["most_rate"])
        if here.joint.limits is not None:
            low, high = (self.rate_towards(here, limit) for limit in here.joint.limits)
            wanted = between(wanted, low, high)
        return bounded((wanted - here.u[0]) / self.every, here.numbers["most_acceleration"])

    def rate_for(self, here: Here, command: Any) -> Any:
        """The rate at which it is to move until the next tick.

        Parameters
        ----------
        here : Here
        command : casadi.SX
            What the law commands.

        Returns
        -------
        casadi.SX
        """
        raise NotImplementedError

    def rate_towards(self, here: Here, angle: Any) -> Any:
        """The rate with which it stands at an angle after two ticks, where nothing bounds it.

        Parameters
        ----------
        here : Here
        angle : casadi.SX or float

        Returns
        -------
        casadi.SX
        """
        return (angle - here.q[0]) / self.every - here.u[0] / 2
