"""A search before it begins: what is asked for, checked and put together."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.canonical import canonical
from somersault._core.checks import by_name, file_path, instance, list_of, shown, whole_number
from somersault._core.errors import SomersaultError
from somersault._core.notes import note
from somersault._core.stages import stage
from somersault.designs._candidates import check_apart
from somersault.designs._choose import Choose, moves_of, table_of
from somersault.designs._given import Given
from somersault.designs._journal import Journal
from somersault.designs._limit import Limit
from somersault.designs._made import Made, arguments, check_arguments
from somersault.designs._objective import Objective
from somersault.designs._source import Misfit, Source
from somersault.designs._trial import MOST_SEED, MOST_SIZE, Trial
from somersault.ensembles import Vary
from somersault.flight import Maneuver, Report, flights
from somersault.simulation import ENDED, Simulation

EVALUATIONS, SIZE, HELD_OUT = 400, 64, 1_024
WIDTH = 0.25
_MOST_EVALUATIONS = 1_000_000
_EXTREMES = ("least_", "greatest_")


@dataclass(frozen=True)
class Size:
    """How much is run: starts of each candidate, candidates, and starts of the best."""

    size: int
    seed: int
    sequence: str
    evaluations: int
    population: int | None
    held_out: int


@dataclass(frozen=True, eq=False)
class Study:
    """A search that can begin at `begins` (chosen,), parts of the ways between the bounds."""

    trial: Trial
    begins: Array
    journal: Journal
    much: Size
    where: Mapping[str, Any]

    def judged(self, table: Array) -> tuple[Trial, dict[str, Array]]:
        """Candidates of a table on starts of their own, with a note of the last one's failures."""
        fresh = replace(self.trial, size=self.much.held_out, seed=self.much.seed + 1)
        rows = fresh.run(table, **self.where)
        failed, called = fresh.failed(rows[ENDED]), fresh.simulation.endings.called
        if failed[1:].all():
            raise SomersaultError(
                f"all {failed[-1].size:,} held-out {called} of the best failed, so nothing is "
                "known to be good; choose between other bounds, or start elsewhere"
            )
        lost = int(failed[-1].sum())
        if lost:
            note(
                f"{lost:,} of {failed[-1].size:,} held-out {called} of the best failed, and count "
                "as such"
            )
        return fresh, rows

    def found(self) -> tuple[Array, Array]:
        """All candidates (N, chosen) of the search that keep to the limits, and their costs."""
        outcomes = [outcome for _, outcome in self.journal.generations]
        candidates = np.concatenate([parts for parts, _ in self.journal.generations])
        beyond = np.concatenate([outcome.beyond for outcome in outcomes])
        within = beyond <= 0
        if not within.any():
            raise SomersaultError(
                f"none of {len(candidates)} candidates keeps to the limits; the nearest is beyond "
                f"them by {100 * float(beyond.min()):.3g} %; widen the bounds, or the limits"
            )
        return candidates[within], np.concatenate([outcome.costs for outcome in outcomes])[within]

    @contextmanager
    def bar(self, shown: bool) -> Iterator[Callable[[int, str], None]]:
        """A bar on standard error: how many are judged, and what is said of them."""
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

        most = self.much.evaluations

        def told(judged: int, said: str) -> None:
            bar.update(task, completed=min(judged, most), said=said)

        columns = (
            TextColumn("{task.completed:,.0f} of {task.total:,.0f} candidates"),
            BarColumn(bar_width=10), TextColumn("{task.fields[said]}"), TimeElapsedColumn(),
        )  # fmt: skip
        screen = Console(stderr=True)
        with (
            stage(""),
            Progress(*columns, console=screen, transient=True, disable=not shown) as bar,
        ):
            task = bar.add_task("", total=most, said="")
            yield told


def study(
    what: Any, choose: Mapping[str, Choose], vary: Mapping[str, Vary],
    objectives: Sequence[Objective], limits: Sequence[Limit], much: Size, out: str | Path | None,
    search: Mapping[str, Any], **where: Any,
) -> Study:  # fmt: skip
    """What `design` and `trade_off` are asked for, put together; SomersaultError for mistakes.

    `search` are further options of the search, and `where` those of `carried_out`.
    """
    aims = tuple(_objective(one) for one in objectives)
    made = callable(what) and not isinstance(what, Simulation)
    chosen = {
        name: instance(f"choose.{name}", one, Choose).checked(name, given=made)
        for name, one in by_name("choose", choose).items()
    }
    if not chosen:
        raise SomersaultError("nothing is chosen; say what the design may change")
    begins = np.array([one.begins for one in chosen.values()])
    trial = Trial(
        _source(what, chosen, table_of(chosen, begins[None])[0], aims, made),
        dict(by_name("vary", vary)), aims,
        tuple(limit.checked() for limit in list_of("limits", limits, Limit)),
        whole_number("size", much.size, 1, MOST_SIZE),
        whole_number("seed", much.seed, 0, MOST_SEED),
        much.sequence,
    )  # fmt: skip
    trial.check()
    whole_number("evaluations", much.evaluations, 2, _MOST_EVALUATIONS)
    whole_number("held_out", much.held_out, 2, MOST_SIZE)
    if much.population is not None:
        whole_number("population", much.population, 2, much.evaluations)
    folder = None if out is None else file_path("out", out)
    first = trial.planned(trial.table(begins[None]))  # refuses what cannot be run
    journal = Journal(folder, {
        **trial.source.specification, "cases": [one.specification for one in first],
        "versions": first[0].versions,
        "objectives": [{"kind": one.kind, **canonical(one)} for one in aims],
        "limits": [canonical(limit) for limit in trial.limits],
        "search": {"evaluations": much.evaluations, "population": much.population, **search},
    })  # fmt: skip
    return Study(trial, begins, journal, much, where)


def _objective(given: Any) -> Objective:
    if not isinstance(given, Objective):
        raise SomersaultError(
            f"objective is {shown(given)}; give designs.Share, designs.Mean or designs.Quantile"
        )
    return given.checked()


def _source(
    what: Any, chosen: Mapping[str, Choose], begins: Array, aims: Sequence[Objective], made: bool
) -> Source:
    """Where candidates come from, of what is run and where the search begins (chosen,)."""
    if made:
        check_arguments(what, chosen)
    wanted = [one.quantity for one in aims if one.quantity not in chosen]
    read = partial(_simulations, wanted=wanted)
    cases = read(what(**arguments(chosen, begins)) if made else what)
    if len({tuple(case.variables) for case in cases}) > 1:
        raise SomersaultError("cases report different things; let all of them report the same")
    moves = {name: moves_of(cases[0], name, one) for name, one in chosen.items()}
    check_apart(moves)
    if made:
        return Made(cases, chosen, moves, read, what)
    return Given(cases, chosen, moves, read)


def _simulations(given: Any, wanted: Sequence[str]) -> tuple[Simulation, ...]:
    """One or several that are run."""
    several = isinstance(given, Sequence) and not isinstance(given, str)
    if several and not given:
        raise Misfit("nothing is run; give a Maneuver, or flight.flights(…)")
    return tuple(_simulation(one, wanted) for one in (given if several else (given,)))


def _simulation(what: Any, wanted: Sequence[str]) -> Simulation:
    """What is run, reporting what is wanted."""
    if isinstance(what, Maneuver):
        plain = flights(what)
        missing = [name for name in wanted if name not in plain.variables]
        if not missing:
            return plain
        ends = [name for name in missing if not name.startswith(_EXTREMES)]
        extremes = [name.partition("_")[2] for name in missing if name.startswith(_EXTREMES)]
        there = [name for name in wanted if name in Report.quantities]
        return flights(what, report=Report((*there, *ends), tuple(dict.fromkeys(extremes))))
    if not isinstance(what, Simulation):
        raise Misfit(
            f"{shown(what)} is nothing that can be run; give a Maneuver, or flight.flights(…)"
        )
    return what
