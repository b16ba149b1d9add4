"""Where the simulations of a design's candidates come from."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.designs._candidates import Candidates
from somersault.designs._choose import Choose, Move
from somersault.simulation import Simulation


class Misfit(SomersaultError):  # noqa: N818
    """What is given to be run is no such thing, whatever is chosen."""


@dataclass(frozen=True, eq=False)
class Group:
    """Some candidates that are run together: how many, and as which cases; none where they cannot
    be made."""

    count: int
    cases: tuple[Candidates, ...]


@dataclass(frozen=True, eq=False)
class Source(ABC):
    """What is run for each candidate: one simulation, or several cases.

    Parameters
    ----------
    cases : tuple of Simulation
        Those of the candidate with which the search begins.
    chosen : mapping of str to Choose
    moves : mapping of str to tuple of Move
        The numbers of the simulations that each of them moves.
    read : callable
        Makes simulations of what is given: maneuvers, say.
    """

    cases: tuple[Simulation, ...]
    chosen: Mapping[str, Choose]
    moves: Mapping[str, tuple[Move, ...]]
    read: Callable[[Any], tuple[Simulation, ...]]

    @property
    @abstractmethod
    def specification(self) -> Mapping[str, Any]:
        """What decides the simulations besides the cases, as plain data."""

    @abstractmethod
    def candidates(self, table: Array) -> list[Group]:
        """Candidates (P, chosen), in their order."""

    @abstractmethod
    def of(self, what: Any) -> Source:
        """The same choices in something else."""

    def group(self, cases: tuple[Simulation, ...], table: Array) -> Group:
        """Candidates that differ in numbers of the same simulations."""
        every = (Candidates(case, self.chosen, self.moves, table) for case in cases)
        return Group(len(table), tuple(every))
