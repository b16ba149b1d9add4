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
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.dynamics import parameter_values
from somersault.engine import MOST_STEPS, Solution
from somersault.flight._course import Course
from somersault.flight._plane import check_in_plane
from somersault.flight._plans import numbers, plans, sound, without_idle_laws
from somersault.flight._playback import ERRORS, Playback
from somersault.flight._start import Start, Starts, in_si, start, starts
from somersault.flight._system import System, system
from somersault.flight._takeoff import Takeoff
from somersault.flight._tape import Kept, Sensed, Tape, Torques, recorded, recorded_each
from somersault.flight.behaviours import JointPlan, kinds
from somersault.laws import seeds
from somersault.model import Model
from somersault.simulation import Name, Numbers

_OF_JOINTS = ("times", "angles", "angle", "factor", "offset")  # what a nominal flight may vary
TOLERANCE_PER_ACCURACY = 1 / 20  # measured: eight somersaults add up about ten step errors


@dataclass(frozen=True, eq=False)
class Batch:
    """A model and its takeoff, for `duration` seconds or `until` an event.

    `bodies` names numbers of the bodies that differ between the flights, `extremes` what is watched
    besides the turns (None: not even those), `differing` all numbers in which flights may differ
    (None: any).
    """

    model: Model
    takeoff: Takeoff
    duration: float
    until: str | None = None
    bodies: tuple[str, ...] = ()
    extremes: tuple[str, ...] | None = None
    differing: tuple[Name, ...] | None = None

    def __post_init__(self) -> None:
        check_in_plane(self.model, self.takeoff, self.until)

    @cached_property
    def joints(self) -> tuple[JointPlan, ...]:
        """What each joint does."""
        return self._plainly(plans(self.model, self.takeoff))

    def _plainly(self, joints: tuple[JointPlan, ...]) -> tuple[JointPlan, ...]:
        if self.differing is None:
            return joints
        return without_idle_laws(self.model, joints, self.differing)

    def differing_in(self, names: tuple[Name, ...], bodies: tuple[str, ...]) -> Batch:
        """The same flights, which may differ in these numbers alone.

        Parameters
        ----------
        names : tuple of tuple
        bodies : tuple of str
            Those of them that are of bodies, as `Equations` has them.

        Returns
        -------
        Batch
        """
        other = replace(self, bodies=bodies, differing=names)
        # They do the same, and what is strange is noted once.
        vars(other)["joints"] = other._plainly(self.joints)
        return other

    @cached_property
    def system(self) -> System:
        """The equations, shared with every batch that has the same."""
        taped, playback = self.takeoff.tape is not None, self.playback
        return system(
            self.model, kinds(self.joints), self.until, self.bodies, self.extremes, taped,
            None if playback is None else playback.kind(),
        )  # fmt: skip

    @cached_property
    def playback(self) -> Playback | None:
        """What its takeoff's replay does in flight."""
        return None if self.takeoff.replay is None else Playback(self.takeoff.replay)

    @cached_property
    def values(self) -> Mapping[Name, float | Array]:
        """The numbers of the takeoff, and of the bodies that may differ."""
        values = numbers(self.takeoff, self.joints)
        values |= {} if self.playback is None else self.playback.numbers
        of_model = parameter_values(self.model)
        for name in self.bodies:
            values[(name,)] = of_model[name]
        return values

    @cached_property
    def nominal(self) -> Batch:
        """The flights whose joint torques the motor tape records."""
        assert self.takeoff.tape is not None
        tape = tuple(float(x) for x in self.takeoff.tape)
        return _nominal(self.model, self._in_si, tape, self.duration)

    @cached_property
    def perceived(self) -> Batch:
        """The flights against whose angles a replay's law measures errors; their turns are
        watched."""
        takeoff, replay = self.takeoff, self.takeoff.replay
        assert replay is not None
        for plan in self.joints:
            if plan.does.sensing is not None:
                raise SomersaultError(
                    f"joint {plan.joint.name} has a law too, so there is no nominal flight in "
                    "which only paths are followed; let the replay's law do without errors"
                )
        start, momentum = replay.nominal_angles, replay.nominal_momentum
        if start is None or momentum is None:
            angles = (takeoff.somersault, takeoff.tilt, takeoff.twist)
            start = angles if takeoff.quaternion is None else takeoff.quaternion
            momentum = takeoff.angular_momentum
            momentum = self.begun().start.momentum.tolist() if momentum is None else momentum
        attitude, h = (tuple(float(x) for x in row) for row in (start, momentum))
        return _nominal(self.model, self._in_si, h, self.duration, attitude, ())

    @property
    def recorded(self) -> dict[str, tuple[Batch, Kept, list[int]]]:
        """What is recorded before the flights, as `Course` calls it and in its order: of which
        flight, what of it, and which parts of that are used."""
        result: dict[str, tuple[Batch, Kept, list[int]]] = {}
        if self.takeoff.tape is not None:
            taped = [slot.joint.name for slot in self.system.layout.slots if slot.tape]
            played = [self.model.speed_slice(name).start for name in taped]
            result["tape"] = self.nominal, Torques(), played
        if self.playback is not None and self.playback.errors:
            names = tuple(ERRORS[name] for name in self.playback.errors)
            result["nominal"] = self.perceived, Sensed(names), list(range(len(names)))
        return result

    @property
    def _in_si(self) -> tuple[JointPlan, ...]:
        return in_si(self.joints, self.begun().starts.values)

    def recording(self, kept: Kept) -> Tape:
        """What is recorded of this batch's one flight, as its takeoff gives it."""
        if kept not in self._recordings:
            self._recordings[kept] = recorded(self, kept)
        return self._recordings[kept]

    def moved_by(self, name: Name) -> bool:
        """Whether a number of other flights is one of this nominal flight's too."""
        return name in self.values and name[0] in _OF_JOINTS

    @cached_property
    def _recordings(self) -> dict[Kept, Tape]:
        return {}

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
        good, playback = sound(self.joints, values, count), self.playback
        return good if playback is None else good & playback.sound(values, count)

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
        parts = {
            what: self._recorded(nominal, kept).path(played)
            for what, (nominal, kept, played) in batch.recorded.items()
        }
        return Course(batch.system, batch.joints, starts, batch.duration, **parts)

    def _recorded(self, nominal: Batch, kept: Kept) -> Tape:
        tape, values = nominal.recording(kept), self.starts.values
        moved = {n: x for n, x in values.items() if nominal.moved_by(n)}
        if any(isinstance(x, np.ndarray) for x in moved.values()):
            return recorded_each(nominal, kept, moved, len(self.starts.q), tape)
        return tape

    @cached_property
    def rows(self) -> Array:
        """States at takeoff, with room behind them for what is watched, (N, state + watched)."""
        s = self.starts
        rows = self.batch.system.start(s.quaternion, s.omega, s.q, s.u, self._sensed)
        if self.batch.extremes is not None:
            first = self.batch.system.layout.state
            rows[:, first : first + s.angles.shape[1]] = s.angles
        return rows

    @property
    def _sensed(self) -> Array:
        """What is carried of the body before the first tick: its angles, the noise's state, and
        the replay."""
        angles, values, playback = self.starts.angles, self.starts.values, self.batch.playback
        parts = [angles]
        if self.batch.system.layout.noise:
            parts.append(seeds(np.broadcast_to(values["takeoff", "noise"], len(angles))))
        if playback is not None:
            parts.append(playback.at_takeoff(values, len(angles)))
        return np.concatenate(parts, 1)

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
    model: Model, joints: tuple[JointPlan, ...], momentum: tuple[float, ...], duration: float,
    attitude: tuple[float, ...] = (0.0, 0.0, 0.0), extremes: tuple[str, ...] | None = None,
) -> Batch:  # fmt: skip
    """The batch of a nominal flight, with the recordings that it keeps; its attitude is given by
    angles, or as a quaternion."""
    does = {plan.joint.name: plan.does.nominal() for plan in joints}
    start: dict[str, Any] = {"quaternion": attitude}
    if len(attitude) == 3:
        start = dict(zip(("somersault", "tilt", "twist"), attitude, strict=True))
    takeoff = Takeoff(angular_momentum=momentum, joints=does, **start)
    return Batch(model, takeoff, duration, extremes=extremes)
