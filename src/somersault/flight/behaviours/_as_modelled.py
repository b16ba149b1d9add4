"""A joint that does what its model says."""

from __future__ import annotations

from dataclasses import dataclass, fields

from somersault.flight.behaviours._behaviour import JointTakeoff
from somersault.flight.behaviours._coupled import Coupled
from somersault.flight.behaviours._sprung import Sprung
from somersault.model import Joint


@dataclass(frozen=True)
class AsModelled(Sprung, motion="as modelled"):
    """A joint for which no behaviour is named.

    It follows where the model gears it to another joint, is sprung where it has stiffness or is
    given some, and is locked otherwise.
    """

    def settled(self, joint: Joint) -> JointTakeoff:
        springy = joint.stiffness != 0 or self.stiffness is not None or self.K is not None
        given = {f.name: getattr(self, f.name) for f in fields(self)}
        if springy:
            return JointTakeoff("sprung", **given).settled(joint)
        if joint.follows is not None and self.angle is None:
            return Coupled().settled(joint)
        return JointTakeoff("locked", **given).settled(joint)
