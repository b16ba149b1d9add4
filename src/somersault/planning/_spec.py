"""Plans described in a TOML file: a model as in a SPEC of a flight, and what is asked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from somersault._core.checks import file_path
from somersault._core.errors import SomersaultError
from somersault.flight import Maneuver
from somersault.model import Model
from somersault.planning._plan import Plan
from somersault.planning._planned import plan
from somersault.spec import plain_fields, read_toml, require_table, structured

_OF_MODEL = ("model", "athlete", "axes", "base")


@dataclass(frozen=True)
class Asked:
    """[plan]: what `plan` takes, by the same names; it is `plan` that checks what they hold."""

    torque: Any
    somersaults: Any = 1
    twists: Any = "most"
    duration: Any = (0.5, 1.5)
    joints: Any = None
    start: Any = None
    end: Any = None
    rest_at_end: Any = False
    takeoff: Any = None
    landing: Any = None
    aloft: Any = None
    fastest: Any = None
    effort: Any = 0.01
    nodes: Any = 50
    starts: Any = 4
    seed: Any = 0


@dataclass(frozen=True)
class PlanSpec:
    """What a SPEC file asks for."""

    model: Model
    asked: Asked

    def run(self, processes: int | None = None) -> Plan:
        """The plan.

        Parameters
        ----------
        processes : int, optional
            As of `plan`.

        Returns
        -------
        Plan

        Raises
        ------
        SomersaultError
            As `plan`.
        """
        return plan(self.model, **plain_fields(self.asked), processes=processes)


def read_plan(path: Path) -> PlanSpec:
    """The plan in a TOML file, a SPEC as `somersault plan` takes it.

    Parameters
    ----------
    path : pathlib.Path
        Its model is looked for in the same folder.

    Returns
    -------
    PlanSpec

    Raises
    ------
    SomersaultError
        Naming the key, for what does not fit.
    """
    file = file_path("a SPEC", path)
    return parse_plan(read_toml(file), file.parent)


def parse_plan(given: Mapping[str, Any], beside: Path) -> PlanSpec:
    """The plan in a SPEC's tables.

    Parameters
    ----------
    given : mapping
        As TOML has it.
    beside : pathlib.Path
        The folder in which its model is looked for.

    Returns
    -------
    PlanSpec

    Raises
    ------
    SomersaultError
        Naming the key, for what does not fit.
    """
    require_table(given)
    if not isinstance(given.get("plan"), Mapping):
        raise SomersaultError("a plan's SPEC needs a table [plan]; see docs/planning.md")
    for key in given:
        if key not in (*_OF_MODEL, "plan"):
            known = ", ".join(_OF_MODEL)
            raise SomersaultError(f"{key} is no key of a plan's SPEC; it takes {known} and [plan]")
    body = Maneuver.parse({k: given[k] for k in _OF_MODEL if k in given}, beside).model
    return PlanSpec(body, structured(given["plan"], Asked, "plan"))
