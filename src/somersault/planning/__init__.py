"""Maneuvers that are found: optimal control of bodies in the air."""

from somersault.planning._plan import Attempt, Plan
from somersault.planning._planned import plan

__all__ = ["Attempt", "Plan", "plan"]
