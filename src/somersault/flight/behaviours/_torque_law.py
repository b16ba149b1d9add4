"""A joint whose torque follows a law of what is sensed."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, ClassVar

from somersault._core.numbers import MOST
from somersault.flight.behaviours import _declared
from somersault.flight.behaviours._by_law import ByLaw
from somersault.flight.behaviours._here import Here
from somersault.flight.behaviours._law import bounded
from somersault.flight.behaviours._sprung import Sprung
from somersault.model import Joint
from somersault.simulation import Name


@dataclass(frozen=True)
class TorqueLaw(ByLaw, Sprung, motion="torque_law"):
    """A sprung joint whose muscles add the torque (N m; a slide's force, N) that a law commands,
    at most `most_torque`. With a `stiffness` of 0 there is the torque alone."""

    bounds: ClassVar[tuple[str, ...]] = ("most_torque",)

    most_torque: float = _declared.quantity("N m", "N", default=MOST, least=0.0)

    def plainest(self, joint: Joint, sensed: frozenset[str], varied: frozenset[Name]) -> Any:
        plain = Sprung(**{one.name: getattr(self, one.name) for one in fields(Sprung)})
        of_law = self.numbers(joint).keys() - plain.numbers(joint).keys()
        return self if varied & of_law or self._always(sensed, varied) != 0 else plain

    def acted_on(self, here: Here, command: Any) -> Any:
        return bounded(command, here.numbers["most_torque"])

    def acting(self, here: Here) -> list[Any]:
        (passive,) = super().acting(here)
        return [passive + here.carried[0]]
