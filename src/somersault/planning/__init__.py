"""Maneuvers that are found: optimal control of bodies in the air."""

from somersault.planning._plan import Attempt, Plan
from somersault.planning._planned import plan
from somersault.planning._spec import PlanSpec, parse_plan, read_plan

__all__ = ["Attempt", "Plan", "PlanSpec", "parse_plan", "plan", "read_plan"]
