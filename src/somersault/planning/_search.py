"""One process' part of a search: starts that are drawn, and solutions that are refined."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from somersault._core.array import Array
from somersault.planning._guess import leap, random_start, refined
from somersault.planning._ipopt import Outcome, Solver
from somersault.planning._point import Point
from somersault.planning._task import Task
from somersault.planning._transcription import Transcription, transcribed

MOST_ITERATIONS = 500


@dataclass(frozen=True)
class Draw:
    """A start drawn at random.

    Parameters
    ----------
    intervals : int
    seed : sequence of int
    wild : bool
        Whether the joints wave.
    """

    intervals: int
    seed: Sequence[int]
    wild: bool


@dataclass(frozen=True, eq=False)
class Leap:
    """A solution whose joints are moved at random.

    Parameters
    ----------
    intervals : int
    x : array
        Its unknowns.
    seed : sequence of int
    """

    intervals: int
    x: Array
    seed: Sequence[int]


@dataclass(frozen=True, eq=False)
class Refine:
    """A solution on more intervals.

    Parameters
    ----------
    intervals : int
    coarse : int
        Intervals of the solution.
    x : array
        Its unknowns.
    """

    intervals: int
    coarse: int
    x: Array


Job = Draw | Leap | Refine


class Search:
    """Solves a task from many starts; what it compiles it keeps."""

    def __init__(self, task: Task) -> None:
        self.task = task
        self._point = Point(task.model, task.moving)
        self._grids: dict[int, Transcription] = {}
        self._solvers: dict[int, Solver] = {}

    def grid(self, intervals: int) -> Transcription:
        """The task's program on so many intervals."""
        if intervals not in self._grids:
            self._grids[intervals] = transcribed(self.task, self._point, intervals)
        return self._grids[intervals]

    def solve(self, job: Job) -> Outcome:
        """What the solver makes of a start."""
        grid = self.grid(job.intervals)
        if isinstance(job, Draw):
            start = random_start(grid, np.random.default_rng(job.seed), job.wild)
        elif isinstance(job, Leap):
            start = leap(grid, job.x, np.random.default_rng(job.seed))
        else:
            start = refined(self.grid(job.coarse), job.x, grid)
        return self._solver(job.intervals)(start)

    def _solver(self, intervals: int) -> Solver:
        if intervals not in self._solvers:
            self._solvers[intervals] = Solver(self.grid(intervals).program, MOST_ITERATIONS)
        return self._solvers[intervals]
