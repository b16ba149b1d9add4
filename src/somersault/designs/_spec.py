"""Designs described in a TOML file: the SPEC of an ensemble, what is chosen, and to what end."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, get_type_hints

from somersault._core.checks import file_path, one_of
from somersault._core.errors import SomersaultError
from somersault.designs._choose import Choose
from somersault.designs._design import EVALUATIONS, HELD_OUT, WIDTH, design
from somersault.designs._limit import Limit
from somersault.designs._objective import Objective
from somersault.designs._result import Design
from somersault.ensembles import Plan, parse_ensemble
from somersault.spec import Unfit, read_as, read_toml, require_table, structured

_HINTS = get_type_hints(Choose)


@dataclass(frozen=True)
class Search:
    """[search]: how long is searched, and on how many other starts the best is judged."""

    evaluations: int = EVALUATIONS
    population: int | None = None
    width: float = WIDTH
    held_out: int = HELD_OUT


@dataclass(frozen=True)
class Tables:
    """The tables that a design's SPEC has besides those of an ensemble."""

    choose: Mapping[str, Choose]
    limits: Mapping[str, Limit] = field(default_factory=dict)
    search: Search = field(default_factory=Search)


_OBJECTIVE = "objective"
_TABLES = (*Tables.__dataclass_fields__, _OBJECTIVE)


@dataclass(frozen=True)
class DesignSpec:
    """What a SPEC file asks for."""

    plan: Plan
    choose: Mapping[str, Choose]
    objective: Objective
    limits: tuple[Limit, ...]
    search: Search

    def run(self, **where: Any) -> Design:
        """The design.

        Parameters
        ----------
        **where
            `out`, `threads`, `workers`, `scheduler`, `security` and `progress` of `design`.

        Returns
        -------
        Design

        Raises
        ------
        SomersaultError
            As `design`.
        """
        plan, search = self.plan, self.search
        return design(
            plan.simulation, self.choose, plan.vary, self.objective, limits=self.limits,
            size=plan.size, seed=plan.seed, sequence=plan.sequence,
            evaluations=search.evaluations, population=search.population,
            width=search.width, held_out=search.held_out, **where,
        )  # fmt: skip


def read_design(path: Path) -> DesignSpec:
    """The design in a TOML file, a SPEC as `somersault design` takes it.

    Parameters
    ----------
    path : pathlib.Path
        Files that it names are looked for in the same folder.

    Returns
    -------
    DesignSpec

    Raises
    ------
    SomersaultError
        Naming the key, for what does not fit.
    """
    file = file_path("a SPEC", path)
    return parse_design(read_toml(file), file.parent)


def parse_design(given: Mapping[str, Any], beside: Path) -> DesignSpec:
    """The design in a SPEC's tables.

    Parameters
    ----------
    given : mapping
        As TOML has it.
    beside : pathlib.Path
        The folder in which files that it names are looked for.

    Returns
    -------
    DesignSpec

    Raises
    ------
    SomersaultError
        Naming the key, for what does not fit.
    """
    require_table(given)
    for key in ("choose", _OBJECTIVE):
        if not isinstance(given.get(key), Mapping) or not given[key]:
            raise SomersaultError(f"a design's SPEC needs a table [{key}]; see docs/design.md")
    plan = parse_ensemble({k: v for k, v in given.items() if k not in _TABLES}, beside).plan
    keys = structured({k: v for k, v in given.items() if k in _TABLES[:-1]}, Tables)
    return DesignSpec(
        plan, keys.choose, _objective(given[_OBJECTIVE]), tuple(keys.limits.values()), keys.search
    )


def _objective(given: Mapping[str, Any]) -> Objective:
    table = dict(given)
    kind = table.pop("kind", None)
    one_of("objective.kind", kind, Objective.kinds)
    if "quantity" not in table:
        raise SomersaultError("objective.quantity is missing; say what is reported of each run")
    return structured(table, Objective.kinds[kind])


def _powers(value: Any, _: Any) -> Any:
    if isinstance(value, str | Mapping):
        return value
    if not isinstance(value, list) or not all(isinstance(t, str) for t in value):
        raise Unfit("a text, a list of texts, or a table of powers", value)
    return value


read_as(_HINTS["multiplies"], _powers)
