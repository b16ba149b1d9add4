"""One flight along many directions at once, and what changes along them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import casadi as ca
import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.engine import STATUS, Pieces, Solution
from somersault.flight._batch import TOLERANCE_PER_ACCURACY, Begun
from somersault.flight._directions import Directions
from somersault.flight._tangent import Tangent, tangent


@dataclass(frozen=True, eq=False)
class Along:
    """A flight, flown along N directions."""

    begun: Begun
    directions: Directions

    @cached_property
    def tangent(self) -> Tangent:
        """Its equations with a direction."""
        on_the_way = any(np.any(part) for path in self.directions.paths for part in path)
        return tangent(self.begun.batch.system, on_the_way)

    def solve(self, samples: Array, tolerance: float, steps: int) -> Solution:
        """Fly, with states at `samples` (K,)."""
        course, tangent, along = self.begun.course, self.tangent, self.directions
        count, layout = len(along.rows), self.begun.batch.system.layout
        rows = np.repeat(self.begun.rows[:, : layout.state], count, 0)
        turns = np.repeat(self.begun.starts.angles, count, 0)
        still = np.repeat(course.still, count, 0)
        phases = course.knots[:, :-1]
        changes = along.now(course, phases[0])
        now = np.broadcast_to(course.now(phases), changes.shape)
        return tangent.integrator.solve(
            np.concatenate([tangent.state(rows, along.rows), turns], 1),
            np.concatenate([still, along.still], 1), samples, tolerance,
            pieces=Pieces(course.knots[:, 1:], np.concatenate([now, changes], 2)),
            most_steps=steps, every=layout.every,
        )  # fmt: skip

    def read(
        self, function: ca.Function, near: Array, both: Array, times: Array, phases: Array
    ) -> Array:
        """What a function of `Tangent` gives, (N, K, …), near (N, K, …), at states with their
        derivatives (N, K, …) and times (N, K), with the parameters of phases (K,)."""
        course, along = self.begun.course, self.directions
        states, derivatives = self.tangent.apart(both)
        parts = [
            near, states, times[..., None], course.now(phases[None]), course.still[:, None],
            derivatives, along.now(course, phases), along.still[:, None],
        ]  # fmt: skip
        given = np.concatenate(
            [np.broadcast_to(part, (*times.shape, part.shape[-1])) for part in parts], 2
        )
        flat = given.reshape(-1, given.shape[-1])
        return np.array(function.map(len(flat))(flat.T)).T.reshape(*times.shape, -1)


@dataclass(frozen=True, eq=False)
class Landed:
    """A flight along N directions that has landed."""

    along: Along
    solution: Solution

    @property
    def by_event(self) -> bool:
        """Whether an event ended it."""
        return STATUS[self.solution.status[0]] == "event"

    def quantities(self, names: tuple[str, ...]) -> Array:
        """Derivatives of the time of landing and of quantities there, (N, 1 + names)."""
        tangent = self.along.tangent
        return self._read(tangent.quantities(names, self.by_event), self.solution.watched_final)

    def motion(self) -> Array:
        """Derivatives of the time of landing and of what `moving_names` has there."""
        tangent = self.along.tangent
        states, _ = tangent.apart(self.solution.final)
        return self._read(tangent.motion(self.by_event), states)

    def _read(self, function: ca.Function, near: Array) -> Array:
        along, both, times = self.along, self.solution.final[:, None], self.solution.end[:, None]
        states, _ = along.tangent.apart(both)
        phases, _ = along.begun.course.phase(times[0], states[0])  # all fly the same flight
        return along.read(function, near[:, None], both, times, phases)[:, 0]


def landed(along: Along, accuracy: float, steps: int) -> Landed:
    """The flight, as accurate (rad) as without directions; SomersaultError where it breaks off."""
    end = np.array([along.begun.batch.duration])
    solution = along.solve(end, accuracy * TOLERANCE_PER_ACCURACY, steps)
    for status, time in zip(solution.status, solution.end, strict=True):
        if STATUS[status] not in ("duration", "event"):
            raise SomersaultError(
                f"the flight breaks off at {time:.4g} s ({STATUS[status]}), so it has no "
                "landing to differentiate; fly tells more of it"
            )
    return Landed(along, solution)
