"""A joint that gives way about a path."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

from somersault._core.errors import SomersaultError
from somersault.flight.behaviours import _declared
from somersault.flight.behaviours._behaviour import JointTakeoff
from somersault.flight.behaviours._here import Here
from somersault.flight.behaviours._moving import Stopped
from somersault.flight.behaviours._prescribed import OnPath, along
from somersault.model import Joint


@dataclass(frozen=True)
class Compliant(OnPath, Stopped, motion="compliant"):
    """A joint with a spring and a damper about its path, and the torque of the motor tape.

    With `following`, `stiffness` and `damping` are those of an inertia of 1 kg m², and are
    multiplied by what is outboard of the joint in the paths' own pose, as it changes.
    """

    stiffness: float | None = _declared.stiffness(least=0.0)
    damping: float | None = _declared.damping()
    following: bool = field(default=False, kw_only=True, metadata={"structure": True})

    def settled(self, joint: Joint) -> JointTakeoff:
        if self.stiffness is None or self.damping is None:
            raise SomersaultError(
                f"joint {joint.name} is compliant; give its stiffness and damping"
            )
        return super().settled(joint)

    def parameters(self, joint: Joint) -> tuple[str, ...]:
        return ("stiffness", "damping", *super().parameters(joint))

    def acting(self, here: Here) -> list[Any]:
        value, rate, _ = here.paths[0]
        by = here.outboard()[0] if self.following else 1.0
        k, c = here.numbers["stiffness"], here.numbers["damping"]
        return [by * (k * (value - here.q[0]) + c * (rate - here.u[0])) + here.tape]

    def nominal(self) -> JointTakeoff:
        return along(self)


def softened(one: OnPath, **numbers: Any) -> Compliant:
    """A joint that is compliant about the path that another follows exactly.

    Parameters
    ----------
    one : OnPath
        The other.
    **numbers
        Fields of `Compliant`: stiffness, damping …

    Returns
    -------
    Compliant
    """
    return replace(Compliant(), times=one.times, angles=one.angles, path=one.path, **numbers)
