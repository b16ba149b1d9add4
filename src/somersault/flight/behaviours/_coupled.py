"""A joint that follows another, as gears make it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.dynamics import spring_torques
from somersault.flight.behaviours import _declared
from somersault.flight.behaviours._behaviour import JointTakeoff
from somersault.flight.behaviours._here import Here, Known
from somersault.flight.behaviours._plan import JointPlan
from somersault.model import Joint, Model, mirror_images


@dataclass(frozen=True)
class Coupled(JointTakeoff, motion="coupled"):
    """A joint whose coordinate is `factor` times that of the joint `leader`, plus `offset`.

    URDF calls it mimic. Where nothing is given it is as the model gears it. Where the leader moves
    freely, the joint's own spring and damper act on it through the gears; they are the model's
    unless `stiffness`, `rest` and `damping` are given.
    """

    leader: str = field(default="", kw_only=True, metadata={"structure": True})
    factor: float = _declared.quantity("1", default=1.0)
    offset: float = _declared.quantity("rad", "m", default=0.0)
    stiffness: float | None = _declared.stiffness()
    rest: float | None = _declared.rest()
    damping: float | None = _declared.damping()

    def settled(self, joint: Joint) -> JointTakeoff:
        plan = self._checked(joint)
        if not isinstance(plan.leader, str):
            raise SomersaultError(f"joint {joint.name}: leader must be a joint's name")
        if not plan.leader:
            if joint.follows is None:
                raise SomersaultError(
                    f"joint {joint.name} is coupled to no joint; name its leader, as the model has "
                    "none"
                )
            geared = joint.follows
            plan = replace(plan, leader=geared.leader, factor=geared.factor, offset=geared.offset)
        passive = {
            name: getattr(joint if getattr(plan, name) is None else plan, name)
            for name in ("stiffness", "rest", "damping")
        }
        return replace(plan, **passive)

    def mirrored(self, model: Model, name: str, factor: float, offset: float) -> Coupled:
        plan = self.settled(model.joint(name))
        assert isinstance(plan, Coupled)
        images = mirror_images(model)
        if plan.leader not in images:
            raise SomersaultError(
                f"joint {name} follows {plan.leader}, which has no mirror image, so the pair has "
                "no common leader; give either side its own"
            )
        leader, by, about = images[plan.leader]  # leader's image = about + by · leader
        turned = factor * plan.factor / by
        shift = offset + factor * plan.offset - turned * about
        rest = offset + factor * (plan.rest or 0.0)
        return replace(plan, leader=leader, factor=turned, offset=shift, rest=rest)

    def parameters(self, joint: Joint) -> tuple[str, ...]:
        return ("factor", "offset", "stiffness", "rest", "damping")

    def place(self, here: Here) -> Known:
        by, about = here.numbers["factor"], here.numbers["offset"]
        assert here.leader is not None
        leader = here.leader
        return Known([by * leader.q[0] + about], [by * leader.u[0]], [by * a for a in leader.a])

    def loads(self, here: Here) -> list[Any]:
        n = here.numbers
        passive = (n["stiffness"], n["rest"], n["damping"])
        return spring_torques(here.joint, here.q, here.u, *passive)

    @property
    def conservative(self) -> bool:
        return not self.damping

    def energy(self, joint: Joint, q: Array) -> Array:
        return 0.5 * (self.stiffness or 0.0) * (q[..., 0] - (self.rest or 0.0)) ** 2


def check_coupled(model: Model, plans: tuple[JointPlan, ...]) -> None:
    """Check that joints which follow others can do so.

    Parameters
    ----------
    model : Model
    plans : tuple of JointPlan

    Raises
    ------
    SomersaultError
        Naming both joints, where they cannot be coupled.
    """
    does: Mapping[str, JointPlan] = {plan.joint.name: plan for plan in plans}
    for plan in plans:
        if not isinstance(plan.does, Coupled):
            continue
        where = f"joint {plan.joint.name} cannot follow {plan.does.leader}"
        if plan.does.leader not in does:
            raise SomersaultError(f"{where}: {model.name} has no joint of that name")
        if plan.does.leader == plan.joint.name:
            raise SomersaultError(f"joint {plan.joint.name} cannot follow itself; name its leader")
        leader = does[plan.does.leader]
        if "ball" in (plan.joint.kind, leader.joint.kind):
            raise SomersaultError(f"{where}: one of them is a ball, and only hinges and slides can")
        if isinstance(leader.does, Coupled):
            raise SomersaultError(
                f"{where}, which follows {leader.does.leader} itself; name the joint that leads "
                "them all"
            )


def leaders(plans: tuple[JointPlan, ...]) -> dict[str, str]:
    """The leader of each joint that follows one.

    Parameters
    ----------
    plans : tuple of JointPlan

    Returns
    -------
    dict of str to str
    """
    return {p.joint.name: p.does.leader for p in plans if isinstance(p.does, Coupled)}
