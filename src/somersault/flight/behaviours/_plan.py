"""A joint of a model, and what it does."""

from __future__ import annotations

from dataclasses import dataclass

from somersault.flight.behaviours._behaviour import JointTakeoff
from somersault.model import Joint


@dataclass(frozen=True)
class JointPlan:
    """A joint and what it does, everything filled in."""

    joint: Joint
    does: JointTakeoff


def kinds(plans: tuple[JointPlan, ...]) -> tuple[JointTakeoff, ...]:
    """What each joint does, without numbers: flights that do the same share their equations.

    Parameters
    ----------
    plans : tuple of JointPlan

    Returns
    -------
    tuple of JointTakeoff
    """
    return tuple(plan.does.kind() for plan in plans)
