"""What candidates of a design come to on the same starts."""

from __future__ import annotations

import fnmatch
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.designs._candidates import CANDIDATE, Candidates
from somersault.designs._choose import Choose, Move
from somersault.designs._limit import Limit
from somersault.designs._objective import Objective
from somersault.ensembles import Plan, Vary, carried_out, plan
from somersault.simulation import ENDED, Simulation


@dataclass(frozen=True)
class Outcome:
    """What P candidates came to.

    `figures` and `costs` (P,) are of the objective, `beyond` (P,) by how much of its limit each is
    beyond the limits that it is beyond, summed: 0 where it keeps to all.
    """

    figures: Array
    costs: Array
    beyond: Array

    @property
    def ranks(self) -> Array:
        """What a search makes small, (P,): those that keep to the limits come first."""
        worst = np.nanmax(np.abs(self.costs), initial=1.0)
        return np.where(self.beyond > 0, 2 * worst + self.beyond, self.costs)


@dataclass(frozen=True, eq=False)
class Trial:
    """What is run for each candidate, and what it is judged by.

    Parameters
    ----------
    simulation : Simulation
    chosen : mapping of str to Choose
    moves : mapping of str to tuple of Move
        The numbers that each of them moves.
    vary : mapping of str to Vary
        The scatter.
    objective : Objective
    limits : tuple of Limit
    size, seed, sequence
        Of the scatter, as for an ensemble.
    """

    simulation: Simulation
    chosen: Mapping[str, Choose]
    moves: Mapping[str, tuple[Move, ...]]
    vary: Mapping[str, Vary]
    objective: Objective
    limits: tuple[Limit, ...]
    size: int
    seed: int
    sequence: str

    def planned(self, table: Array) -> Plan:
        """The ensemble of candidates (P, chosen): their runs from the same starts."""
        candidates = Candidates(self.simulation, self.chosen, self.moves, table)
        which = Vary(sets=CANDIDATE, values=np.arange(len(table)))
        return plan(
            candidates, {CANDIDATE: which, **self.vary}, self.size, self.seed, self.sequence
        )

    def run(self, table: Array, **where: Any) -> dict[str, Array]:
        """What is reported of the runs, (P, N) each; `where` is as for `carried_out`."""
        planned = self.planned(table)
        if any(value is not None for value in where.values()):
            data = carried_out(planned, **where).dataset
            rows = {str(name): data[name].values for name in data.data_vars}
        else:
            rows = planned.run(0, planned.count)
        return {n: x.reshape(len(table), -1) for n, x in rows.items() if n in self._read}

    @cached_property
    def _read(self) -> set[str]:
        return {self.objective.quantity, ENDED, *(n for row in self._limited for n in row)}

    @cached_property
    def _limited(self) -> list[list[str]]:
        """What each limit is for, of all that is reported."""
        there = [n for n, v in self.simulation.variables.items() if not v.over_time]
        return [fnmatch.filter(there, limit.quantity) or [limit.quantity] for limit in self.limits]

    def failed(self, ended: Array) -> Array:
        """Which runs failed."""
        endings = self.simulation.endings
        return np.isin(ended, [endings.code(word) for word in endings.failed])

    def outcome(self, rows: Mapping[str, Array]) -> Outcome:
        """What the candidates of some runs came to."""
        failed = self.failed(rows[ENDED])
        values = rows[self.objective.quantity]
        beyond = np.zeros(len(values))
        for limit, names in zip(self.limits, self._limited, strict=True):
            beyond += sum(limit.beyond(rows[name], failed) for name in names)
        return Outcome(
            self.objective.figures(values, failed), self.objective.costs(values, failed), beyond
        )

    def check(self) -> None:
        """SomersaultError for a quantity that is not reported, and where nothing is scattered."""
        there = [n for n, v in self.simulation.variables.items() if not v.over_time]
        for name in sorted(self._read - {ENDED}):
            if name not in there:
                raise SomersaultError(
                    f"{name} is not reported of these {self.simulation.endings.called}; there are "
                    f"{', '.join(there)}"
                )
        if not self.vary:
            raise SomersaultError(
                "nothing is scattered, so nothing is more reliable than anything else; say what "
                "varies"
            )
        if CANDIDATE in self.vary:
            raise SomersaultError(f"vary.{CANDIDATE} is what candidates are called; rename it")
        sets = {target for row in self.moves.values() for target in (m.name for m in row)}
        for name, vary in self.vary.items():
            if vary.adds:
                continue
            taken = [t.name for path in vary.targets for t in self.simulation.targets(path)]
            if sets & set(taken):
                raise SomersaultError(
                    f"vary.{name} sets a number that the design chooses; let it be added to it"
                )
