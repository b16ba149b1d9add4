"""Flights of one maneuver, one or a million: what they share, and how any of them are flown.

    plans -> kinds -> system -> starts -> course -> solve

is put together here and nowhere else. Flights of a batch share their equations and differ in the
numbers of the takeoff (`simulation.Name`), each of which is one for all or an array over the
flights.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from somersault._core.array import Array
from somersault.dynamics import parameter_values
from somersault.engine import MOST_STEPS, Solution
from somersault.flight._course import Course
from somersault.flight._plane import check_in_plane
from somersault.flight._plans import numbers, plans, sound
from somersault.flight._start import Start, Starts, in_si, start, starts
from somersault.flight._system import System, system
from somersault.flight._takeoff import Takeoff
from somersault.flight._tape import Tape, recorded, recorded_each
from somersault.flight.behaviours import JointPlan, kinds
from somersault.laws import seeds
from somersault.model import Model
from somersault.motion import Path
from somersault.simulation import Name, Numbers

_OF_JOINTS = ("times", "angles", "angle", "factor", "offset")  # what a nominal flight may vary
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

    def __post_init__(self) -> None:
        check_in_plane(self.model, self.takeoff, self.until)

    @cached_property
    def joints(self) -> tuple[JointPlan, ...]:
        """What each joint does."""
        return plans(self.model, self.takeoff)

    def differing_in(self, bodies: tuple[str, ...]) -> Batch:
        """The same flights, in which these numbers of bodies may differ.

        Parameters
        ----------
        bodies : tuple of str

        Returns
        -------
        Batch
        """
        other = replace(self, bodies=bodies)
        vars(other)["joints"] = self.joints  # which do the same; what is strange is noted once
        return other

    @cached_property
    def system(self) -> System:
        """The equations, shared with every batch that has the same."""
        taped = self.takeoff.tape is not None
        return system(self.model, kinds(self.joints), self.until, self.bodies, self.extremes, taped)

    @cached_property
    def values(self) -> Mapping[Name, float | Array]:
        """The numbers of the takeoff, and of the bodies that may differ."""
        values = numbers(self.takeoff, self.joints)
        of_model = parameter_values(self.model)
        for name in self.bodies:
            values[(name,)] = of_model[name]
        return values

    @cached_property
    def nominal(self) -> Batch:
        """The flights whose joint torques the motor tape records."""
        assert self.takeoff.tape is not None
        tape = tuple(float(x) for x in self.takeoff.tape)
        joints = in_si(self.joints, self.begun().starts.values)
        return _nominal(self.model, joints, tape, self.duration)

    @cached_property
    def recording(self) -> Tape:
        """The torques of this batch's one flight, as its takeoff gives it."""
        return recorded(self)

    def sound(self, values: Numbers, count: int) -> Array:
        """Whether each flight is one that could be asked for by itself.

        Parameters
        ----------
        values : mapping of tuple to float or ndarray, (count,)
            The numbers of the flights, by the names in `Batch.values`.
        count : int
            How many flights.

        Returns
        -------
        ndarray of bool, (count,)
        """
        return sound(self.joints, values, count)

    def begun(self, values: Numbers | None = None, count: int = 1) -> Begun:
        """The flights at takeoff.

        Parameters
        ----------
        values : mapping of tuple to float or ndarray, (count,), optional
            The numbers of the flights, by the names in `Batch.values`; by default the takeoff's
            own.
        count : int
            How many flights.

        Returns
        -------
        Begun
        """
        given = self.values if values is None else values
        return Begun(self, starts(self.system, self.takeoff, self.joints, given, count))


@dataclass(frozen=True, eq=False)
class Begun:
    """Flights of a batch with their numbers: ready to be solved."""

    batch: Batch
    starts: Starts

    @cached_property
    def start(self) -> Start:
        """The takeoff, of one flight."""
        batch = self.batch
        return start(batch.system, batch.takeoff, batch.joints, self.starts)

    @cached_property
    def course(self) -> Course:
        """Paths, motor tapes and lasting parameters."""
        batch, starts = self.batch, self.starts
        tape = None if batch.takeoff.tape is None else self._tape
        return Course(batch.system, batch.joints, starts, batch.duration, tape)

    @property
    def _tape(self) -> Path:
        """The motor tape of each flight, or one for all where they are alike."""
        nominal, values = self.batch.nominal, self.starts.values
        tape = nominal.recording
        moved = {n: x for n, x in values.items() if n in nominal.values and n[0] in _OF_JOINTS}
        if any(isinstance(x, np.ndarray) for x in moved.values()):
            tape = recorded_each(nominal, moved, len(self.starts.q), tape)
        played = [slot.joint.name for slot in self.batch.system.layout.slots if slot.tape]
        return tape.path([self.batch.model.speed_slice(name).start for name in played])

    @cached_property
    def rows(self) -> Array:
        """States at takeoff, with room behind them for what is watched, (N, state + watched)."""
        s = self.starts
        return self.batch.system.start(s.quaternion, s.omega, s.q, s.u, self._sensed)

    @property
    def _sensed(self) -> Array:
        """What is carried of the body before the first tick: its angles, and the noise's state."""
        angles, layout = self.starts.angles, self.batch.system.layout
        if not layout.noise:
            return angles
        which = np.broadcast_to(self.starts.values["takeoff", "noise"], len(angles))
        return np.concatenate([angles, seeds(which)], 1)

    def solve(self, samples: Array, accuracy: float, most_steps: int = MOST_STEPS) -> Solution:
        """Integrate the flights.

        Parameters
        ----------
        samples : ndarray, (K,) or (N, K)
            Times at which states are kept, s.
        accuracy : float
            Of the attitude, rad.
        most_steps : int
            A flight that has taken so many ends.

        Returns
        -------
        Solution
        """
        tolerance = accuracy * TOLERANCE_PER_ACCURACY
        with np.errstate(over="ignore", invalid="ignore"):
            return self.course.solve(self.rows, samples, tolerance, most_steps)


@lru_cache(maxsize=64)
def _nominal(
    model: Model, joints: tuple[JointPlan, ...], tape: tuple[float, ...], duration: float
) -> Batch:
    """The batch of a nominal flight, with the recording that it keeps."""
    does = {plan.joint.name: plan.does.nominal() for plan in joints}
    return Batch(model, Takeoff(angular_momentum=tape, joints=does), duration)
