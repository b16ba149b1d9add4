"""Candidates of a design as one simulation: numbers of their own, the same starts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.canonical import canonical
from somersault._core.errors import SomersaultError
from somersault.designs._choose import Choose, Move
from somersault.simulation import Endings, Name, Numbers, Simulation, Target, Variable

CANDIDATE = "candidate"
_PLACE: Name = (CANDIDATE,)
_ORDER = ("sets", "adds", "multiplies")


@dataclass(frozen=True, eq=False)
class Candidates:
    """A simulation some numbers of which are those of a candidate: row k of a table.

    `table` (P, chosen) has what each candidate chooses, `chosen` the quantities in that order. One
    more number says which candidate runs: ("candidate",).
    """

    simulation: Simulation
    chosen: Mapping[str, Choose]
    moves: Mapping[str, tuple[Move, ...]]
    table: Array

    @property
    def name(self) -> str:
        """Of what is run."""
        return self.simulation.name

    @property
    def packages(self) -> tuple[str, ...]:
        """The packages whose versions decide the last digits."""
        return self.simulation.packages

    @property
    def specification(self) -> Mapping[str, Any]:
        """All that decides the numbers, as plain data."""
        return {
            **self.simulation.specification,
            "choose": canonical(dict(self.chosen)),
            "candidates": self.table.tolist(),
        }

    @property
    def values(self) -> Numbers:
        """The nominal numbers, and which candidate runs."""
        return {**self.simulation.values, _PLACE: 0.0}

    @property
    def variables(self) -> Mapping[str, Variable]:
        """What is reported of each run."""
        return self.simulation.variables

    @property
    def times(self) -> Array:
        """The times of what is reported over time, s."""
        return self.simulation.times

    @property
    def endings(self) -> Endings:
        """How a run can end."""
        return self.simulation.endings

    @property
    def together(self) -> int:
        """How many runs are best held in memory at once."""
        return self.simulation.together

    def targets(self, path: str) -> tuple[Target, ...]:
        """The numbers that a name means."""
        if path == CANDIDATE:
            return (Target(_PLACE, unit="1"),)
        return self.simulation.targets(path)

    def with_varied(self, names: tuple[Name, ...]) -> Candidates:
        """The same, for runs that differ in these numbers and in what is chosen."""
        varied = dict.fromkeys(name for name in names if name != _PLACE)
        varied |= dict.fromkeys(move.name for row in self.moves.values() for move in row)
        return replace(self, simulation=self.simulation.with_varied(tuple(varied)))

    def sound(self, values: Numbers, count: int) -> Array:
        """Whether each run can begin."""
        return self.simulation.sound(self._moved(values), count)

    def run(self, values: Numbers, count: int) -> Mapping[str, Array]:
        """The variables of some runs, each of its candidate."""
        return self.simulation.run(self._moved(values), count)

    def _moved(self, values: Numbers) -> dict[Name, float | Array]:
        """The numbers of runs: what is chosen in the place of the nominal, and what is scattered
        about that."""
        numbers = dict(values)
        which = np.atleast_1d(numbers.pop(_PLACE)).astype(int)
        nominal = self.simulation.values
        for name, number in self.numbers.items():
            numbers[name] = number[which] + (np.asarray(values[name]) - nominal[name])
        return numbers

    @property
    def numbers(self) -> dict[Name, Array]:
        """The numbers of the simulation that candidates choose, (P,) each."""
        result: dict[Name, Array] = {}
        nominal = self.simulation.values
        columns = dict(zip(self.chosen, self.table.T, strict=True))
        every = [(move, columns[name]) for name, row in self.moves.items() for move in row]
        for move, column in sorted(every, key=lambda one: _ORDER.index(one[0].how)):
            result[move.name] = move.of(column, result.get(move.name, nominal[move.name]))
        return {name: np.broadcast_to(x, len(self.table)) for name, x in result.items()}


def check_apart(moves: Mapping[str, tuple[Move, ...]]) -> None:
    """SomersaultError where two chosen quantities set one number."""
    owner: dict[Name, str] = {}
    for name, row in moves.items():
        for move in row:
            if move.how == "sets" and owner.setdefault(move.name, name) != name:
                raise SomersaultError(
                    f"choose.{owner[move.name]} and choose.{name} set the same number; let one of "
                    "them multiply it, or be added to it"
                )
