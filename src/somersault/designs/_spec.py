"""Designs described in a TOML file: the SPEC of an ensemble, what is chosen, and to what end."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, get_type_hints

from somersault._core.checks import file_path, one_of
from somersault._core.errors import SomersaultError
from somersault.designs._choose import Choose
from somersault.designs._design import design
from somersault.designs._limit import Limit
from somersault.designs._objective import Objective
from somersault.designs._pareto import TradeOff
from somersault.designs._result import Design
from somersault.designs._study import EVALUATIONS, HELD_OUT
from somersault.designs._trade_off import trade_off
from somersault.ensembles import Plan, parse_ensemble
from somersault.spec import Unfit, read_as, read_toml, require_table, structured

_HINTS = get_type_hints(Choose)


@dataclass(frozen=True)
class Search:
    """[search]: how long is searched, and on how many other starts the best is judged.

    `width` and `polish` are for one objective, `points` for a trade-off.
    """

    evaluations: int = EVALUATIONS
    population: int | None = None
    width: float | None = None
    polish: bool | None = None
    points: int | None = None
    held_out: int = HELD_OUT


@dataclass(frozen=True)
class Tables:
    """The tables that a design's SPEC has besides those of an ensemble."""

    choose: Mapping[str, Choose]
    limits: Mapping[str, Limit] = field(default_factory=dict)
    search: Search = field(default_factory=Search)


_FOR_ONE, _FOR_MANY = ("width", "polish"), ("points",)  # keys of [search]
_ONE, _SEVERAL = "objective", "objectives"
_TABLES = (*Tables.__dataclass_fields__, _ONE, _SEVERAL)


@dataclass(frozen=True)
class DesignSpec:
    """What a SPEC file asks for."""

    plan: Plan
    choose: Mapping[str, Choose]
    objectives: tuple[Objective, ...]
    limits: tuple[Limit, ...]
    search: Search

    def run(self, **where: Any) -> Design | TradeOff:
        """The design; of several objectives their trade-off.

        Parameters
        ----------
        **where
            `out`, `threads`, `workers`, `scheduler`, `security` and `progress` of `design`.

        Returns
        -------
        Design or TradeOff

        Raises
        ------
        SomersaultError
            As `design` and `trade_off`.
        """
        plan, search = self.plan, self.search
        options = {name: getattr(search, name) for name in ("population", *_FOR_ONE, *_FOR_MANY)}
        much: dict[str, Any] = {name: x for name, x in options.items() if x is not None}
        much |= {
            "size": plan.size, "seed": plan.seed, "sequence": plan.sequence,
            "evaluations": search.evaluations, "held_out": search.held_out,
        }  # fmt: skip
        what, choose, vary = plan.simulation, self.choose, plan.vary
        much |= {"limits": self.limits, **where}
        if len(self.objectives) > 1:
            return trade_off(what, choose, vary, self.objectives, **much)
        return design(what, choose, vary, self.objectives[0], **much)


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
    aims = _SEVERAL if _SEVERAL in given else _ONE
    for key in ("choose", aims):
        if not isinstance(given.get(key), Mapping) or not given[key]:
            raise SomersaultError(f"a design's SPEC needs a table [{key}]; see docs/design.md")
    if aims == _SEVERAL and _ONE in given:
        raise SomersaultError("a design has [objective] or [objectives.NAME], and this has both")
    plan = parse_ensemble(given, beside, _TABLES, "a design's SPEC").plan
    keys = structured({k: v for k, v in given.items() if k in Tables.__dataclass_fields__}, Tables)
    objectives: tuple[Objective, ...]
    if aims == _ONE:
        objectives = (_objective(_ONE, given[_ONE]),)
    else:
        objectives = tuple(_objective(f"{_SEVERAL}.{n}", x) for n, x in given[_SEVERAL].items())
        if len(objectives) < 2:
            raise SomersaultError(
                f"a trade-off needs two tables [{_SEVERAL}.NAME] at least; one is [{_ONE}]"
            )
    others, of = (_FOR_MANY, "several") if len(objectives) == 1 else (_FOR_ONE, "one alone")
    for key in others:
        if getattr(keys.search, key) is not None:
            raise SomersaultError(f"search.{key} is for objectives, {of}; leave it out")
    return DesignSpec(plan, keys.choose, objectives, tuple(keys.limits.values()), keys.search)


def _objective(where: str, given: Any) -> Objective:
    if not isinstance(given, Mapping):
        raise SomersaultError(f"{where} must be a table; write [{where}]")
    table = dict(given)
    kind = table.pop("kind", None)
    one_of(f"{where}.kind", kind, Objective.kinds)
    if "quantity" not in table:
        raise SomersaultError(f"{where}.quantity is missing; say what is reported of each run")
    return structured(table, Objective.kinds[kind], where)


def _powers(value: Any, _: Any) -> Any:
    if isinstance(value, str | Mapping):
        return value
    if not isinstance(value, list) or not all(isinstance(t, str) for t in value):
        raise Unfit("a text, a list of texts, or a table of powers", value)
    return value


read_as(_HINTS["multiplies"], _powers)
