"""Flights of one maneuver, one or a million: what they share, and how any of them are flown.

    plans -> kinds -> system -> starts -> course -> solve

is put together here and nowhere else. Flights of a batch share their equations and differ in the
numbers of the takeoff (`_columns`), each of which is one for all or an array over the flights.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from somersault._core.array import Array
from somersault.dynamics._tree import parameter_value
from somersault.engine import MOST_STEPS, Solution
from somersault.flight._columns import Name, Numbers, numbers, sound
from somersault.flight._course import Course
from somersault.flight._start import Starts, starts
from somersault.flight._system import System, system
from somersault.flight._takeoff import JointPlan, Takeoff, kinds, plans
from somersault.flight._tape import course
from somersault.model import Model

TOLERANCE_PER_ACCURACY = 1 / 20  # measured: eight somersaults add up about ten step errors


@dataclass(frozen=True, eq=False)
class Batch:
    """A model and its takeoff, for `duration` seconds or `until` an event.

    `bodies` names numbers of the bodies that differ between the flights, `extremes` what is watched
    besides the turns (None: not even those).
    """

    model: Model
    takeoff: Takeoff
    duration: float
    until: str | None = None
    bodies: tuple[str, ...] = ()
    extremes: tuple[str, ...] | None = None

    @cached_property
    def joints(self) -> tuple[JointPlan, ...]:
        """What each joint does."""
        return plans(self.model, self.takeoff.joints)

    @cached_property
    def system(self) -> System:
        """The equations, shared with every batch that has the same."""
        taped = self.takeoff.tape is not None
        return system(self.model, kinds(self.joints), self.until, self.bodies, self.extremes, taped)

    @cached_property
    def values(self) -> Mapping[Name, float | Array]:
        """The numbers of the takeoff, and of the bodies that may differ."""
        values = numbers(self.takeoff, self.joints)
        for name in self.bodies:
            values[(name,)] = parameter_value(self.model, name)
        return values

    def sound(self, values: Numbers, count: int) -> Array:
        """Whether each of `count` flights is one that could be asked for by itself, (count,)."""
        return sound(self.joints, values, count)

    def begun(self, values: Numbers | None = None, count: int = 1) -> Begun:
        """`count` flights whose numbers are `values`, by default the takeoff's own."""
        given = self.values if values is None else values
        return Begun(self, starts(self.system, self.takeoff, self.joints, given, count))


@dataclass(frozen=True, eq=False)
class Begun:
    """Flights of a batch with their numbers: ready to be solved."""

    batch: Batch
    starts: Starts

    @cached_property
    def course(self) -> Course:
        """Paths, motor tapes and lasting parameters."""
        batch = self.batch
        return course(batch.system, batch.takeoff, batch.joints, self.starts, batch.duration)

    @cached_property
    def rows(self) -> Array:
        """States at takeoff, with room behind them for what is watched, (N, state + watched)."""
        s = self.starts
        return self.batch.system.start(s.quaternion, s.omega, s.q, s.u)

    def solve(self, samples: Array, accuracy: float, most_steps: int = MOST_STEPS) -> Solution:
        """The flights, with states at `samples` (K,) or (N, K), s; `accuracy` in rad."""
        tolerance = accuracy * TOLERANCE_PER_ACCURACY
        with np.errstate(over="ignore", invalid="ignore"):
            return self.course.solve(self.rows, samples, tolerance, most_steps)
