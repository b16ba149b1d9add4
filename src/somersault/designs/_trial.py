"""What candidates of a design come to on the same starts."""

from __future__ import annotations

import fnmatch
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import instance
from somersault._core.errors import SomersaultError
from somersault.designs._candidates import CANDIDATE, Candidates
from somersault.designs._choose import Choose, table_of
from somersault.designs._limit import Limit
from somersault.designs._objective import Averaged, Objective
from somersault.designs._source import Group, Source
from somersault.ensembles import Plan, Vary, carried_out, plan
from somersault.simulation import ENDED, Simulation

MOST_SIZE = 10_000_000
MOST_SEED = 2**31
NOT_MADE = 1e6
"""How far beyond its limits a candidate is that cannot be made: farther than any other."""


@dataclass(frozen=True)
class Outcome:
    """What P candidates came to.

    `figures` and `costs` (P,) are of the objective, or (P, M) of M that are traded off; `beyond`
    (P,) is by how much of its limit each is beyond the limits that it is beyond, summed: 0 where it
    keeps to all.
    """

    figures: Array
    costs: Array
    beyond: Array


@dataclass(frozen=True, eq=False)
class Trial:
    """What is run for each candidate, and what it is judged by.

    Parameters
    ----------
    source : Source
        Of the candidates.
    vary : mapping of str to Vary
        The scatter.
    objectives : tuple of Objective
        One, or those that are traded off.
    limits : tuple of Limit
    size, seed, sequence
        Of the scatter, as for an ensemble.
    """

    source: Source
    vary: Mapping[str, Vary]
    objectives: tuple[Objective, ...]
    limits: tuple[Limit, ...]
    size: int
    seed: int
    sequence: str

    @property
    def simulation(self) -> Simulation:
        """What is run of the candidate with which the search begins."""
        return self.source.cases[0]

    @property
    def chosen(self) -> Mapping[str, Choose]:
        """What is chosen."""
        return self.source.chosen

    @property
    def objective(self) -> Objective:
        """The objective; the first, where several are traded off."""
        return self.objectives[0]

    def table(self, parts: Array) -> Array:
        """The values (P, chosen) of candidates at parts of their ways between the bounds."""
        return table_of(self.chosen, parts)

    def planned(self, table: Array) -> list[Plan]:
        """The ensembles of candidates (P, chosen) that are run first."""
        return [self.ensemble(case, self.vary) for case in self.source.candidates(table)[0].cases]

    def ensemble(self, simulation: Simulation, vary: Mapping[str, Vary]) -> Plan:
        """The ensemble of a simulation; of candidates, their runs from the same starts."""
        which: dict[str, Vary] = {}
        if isinstance(simulation, Candidates):
            which[CANDIDATE] = Vary(sets=CANDIDATE, values=np.arange(len(simulation.table)))
        size = self.size if vary else None
        return plan(simulation, {**which, **vary}, size, self.seed, self.sequence)

    def run(self, table: Array, **where: Any) -> dict[str, Array]:
        """What is reported of the runs of candidates (P, chosen): (P, N) each, or of several cases
        (P, cases · N). `where` is as for `carried_out`."""
        return self._rows(table, self.source.candidates(table), self.vary, where)

    def _rows(
        self, table: Array, groups: list[Group], vary: Mapping[str, Vary], where: Mapping[str, Any]
    ) -> dict[str, Array]:
        parts = [self._of_group(group, vary, where) for group in groups]
        rows = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
        shape, columns = rows[ENDED].shape, dict(zip(self.chosen, table.T, strict=True))
        for name in self._read - set(rows):
            rows[name] = np.broadcast_to(columns[name][:, None], shape)
        return rows

    def _of_group(
        self, group: Group, vary: Mapping[str, Vary], where: Mapping[str, Any]
    ) -> dict[str, Array]:
        if not group.cases:
            return self._not_made(group.count, vary)
        self._check_alike(group.cases)
        parts = []
        for case in group.cases:
            planned = self.ensemble(case, vary)
            if any(value is not None for value in where.values()):
                data = carried_out(planned, **where).dataset
                rows = {str(name): data[name].values for name in data.data_vars}
            else:
                rows = planned.run(0, planned.count)
            parts.append({n: x.reshape(group.count, -1) for n, x in rows.items()})
        return {name: np.concatenate([part[name] for part in parts], 1) for name in self._reported}

    def _check_alike(self, cases: Sequence[Simulation]) -> None:
        """SomersaultError for candidates that could not be compared."""
        first = len(self.source.cases)
        if len(cases) != first:
            raise SomersaultError(
                f"a candidate is run as {len(cases)} cases, and the first as {first}; let the "
                "function make as many for all"
            )
        for case in cases:
            for name in sorted(self._reported - {ENDED} - set(case.variables)):
                raise SomersaultError(
                    f"{name} is not reported of a candidate, and is of the first; let the function "
                    "report the same of all"
                )

    def _not_made(self, count: int, vary: Mapping[str, Vary]) -> dict[str, Array]:
        """What is reported of candidates that cannot be made: none of their runs can begin."""
        known, endings = self.simulation.variables, self.simulation.endings
        shape = count, len(self.source.cases) * self.ensemble(self.simulation, vary).count
        rows = {n: np.full(shape, known[n].fill, known[n].dtype) for n in self._reported - {ENDED}}
        return rows | {ENDED: np.full(shape, endings.code(endings.unsound), np.uint8)}

    @cached_property
    def _read(self) -> set[str]:
        return {
            *(one.quantity for one in self.objectives),
            ENDED,
            *(n for row in self._limited for n in row),
        }

    @property
    def _reported(self) -> set[str]:
        """What is read of the runs: all but what is chosen."""
        return self._read - set(self.chosen)

    @cached_property
    def _limited(self) -> list[list[str]]:
        """What each limit is for, of all that is reported."""
        there = [n for n, v in self.simulation.variables.items() if not v.over_time]
        there += self.chosen
        return [fnmatch.filter(there, limit.quantity) or [limit.quantity] for limit in self.limits]

    def failed(self, ended: Array) -> Array:
        """Which runs failed."""
        endings = self.simulation.endings
        return np.isin(ended, [endings.code(word) for word in endings.failed])

    def figures(self, rows: Mapping[str, Array]) -> Array:
        """The objective's figures (P,) of the runs of P candidates."""
        return self.all_figures(rows)[:, 0]

    def all_figures(self, rows: Mapping[str, Array]) -> Array:
        """The figures (P, objectives) of the runs of P candidates."""
        failed = self.failed(rows[ENDED])
        figures = [one.figures(rows[one.quantity], failed) for one in self.objectives]
        return np.stack(figures, 1)

    def interval(self, objective: Objective, runs: Mapping[str, Array]) -> tuple[float, float]:
        """The confidence interval of one candidate's figure, of its runs (cases · N,): what is run
        from the same start, all cases and points of a grid, hangs together."""
        values, failed = runs[objective.quantity], self.failed(runs[ENDED])
        return objective.interval(values.reshape(-1, self.size), failed.reshape(-1, self.size))

    def outcome(self, table: Array, **where: Any) -> Outcome:
        """What candidates (P, chosen) come to, by the objective."""
        every = self.traded(table, **where)
        return Outcome(every.figures[:, 0], every.costs[:, 0], every.beyond)

    def traded(self, table: Array, **where: Any) -> Outcome:
        """What candidates (P, chosen) come to, by all objectives."""
        groups = self.source.candidates(table)
        rows = self._rows(table, groups, self.vary, where)
        alone = rows
        if any(limit.unperturbed for limit in self.limits):
            alone = self._rows(table, groups, {}, {})
        beyond = np.repeat(
            [0.0 if group.cases else NOT_MADE for group in groups],
            [group.count for group in groups],
        )
        for limit, names in zip(self.limits, self._limited, strict=True):
            judged = alone if limit.unperturbed else rows
            failed = self.failed(judged[ENDED])
            beyond += sum(limit.beyond(judged[name], failed) for name in names)
        failed = self.failed(rows[ENDED])
        costs = [one.costs(rows[one.quantity], failed) for one in self.objectives]
        return Outcome(self.all_figures(rows), np.stack(costs, 1), beyond)

    def words(self, objective: Objective) -> str:
        """What an objective is, in words: of something chosen its name."""
        return objective.quantity if objective.quantity in self.chosen else objective.words

    def unit(self, objective: Objective) -> str:
        """Of an objective's figure: that of its quantity, or "1" for a share."""
        if not isinstance(objective, Averaged):
            return "1"
        if objective.quantity in self.chosen:
            return self.chosen[objective.quantity].unit
        return self.simulation.variables[objective.quantity].unit

    def check(self) -> None:
        """SomersaultError for a quantity that is not reported, and where nothing is scattered."""
        there = [n for n, v in self.simulation.variables.items() if not v.over_time]
        for name in sorted(self._read - {ENDED}):
            if name in there and name in self.chosen:
                raise SomersaultError(f"{name} is both chosen and reported; rename what is chosen")
            if name not in there and name not in self.chosen:
                raise SomersaultError(
                    f"{name} is not reported of these {self.simulation.endings.called}; there are "
                    f"{', '.join(there)}"
                )
        if all(one.quantity in self.chosen for one in self.objectives):
            raise SomersaultError(
                f"{self.objective.quantity} is chosen, so nothing has to be run for it; let an "
                "objective be of something reported"
            )
        if not self.vary:
            raise SomersaultError(
                "nothing is scattered, so nothing is more reliable than anything else; say what "
                "varies"
            )
        if all(instance(f"vary.{n}", v, Vary).grid is not None for n, v in self.vary.items()):
            raise SomersaultError(
                "a grid of values has no other starts, on which the best could be judged; let "
                "something that varies have a distribution, as uniform or normal"
            )
        for name in set(self.vary) & {CANDIDATE, "case"}:
            raise SomersaultError(f"vary.{name} has the name of what a design runs; rename it")
        sets = {move.name for row in self.source.moves.values() for move in row}
        for name, vary in self.vary.items():
            if vary.adds:
                continue
            taken = [t.name for path in vary.targets for t in self.simulation.targets(path)]
            if sets & set(taken):
                raise SomersaultError(
                    f"vary.{name} sets a number that the design chooses; let it be added to it"
                )
