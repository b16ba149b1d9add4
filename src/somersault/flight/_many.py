"""Many flights of one maneuver, as an ensemble asks for them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.canonical import canonical
from somersault._core.checks import name_list
from somersault._core.errors import SomersaultError
from somersault.flight._batch import Batch
from somersault.flight._flight import Flight
from somersault.flight._flown import flown
from somersault.flight._maneuver import STEPS, Maneuver, check_limits_of_flight, flight_time
from somersault.flight._report import (
    ENDINGS,
    Report,
    check,
    error_weights,
    target_of,
    variables,
)
from somersault.flight._reported import reported, watch_from_takeoff
from somersault.flight._takeoff import Takeoff, require_takeoff
from somersault.flight._targets import body_names, targets
from somersault.model import Model, load, model_digest
from somersault.simulation import Endings, Name, Numbers, Target, Variable

ACCURACY = 1e-7  # rad
_TOGETHER = 16_384  # flights whose numbers are held at once,
_TOGETHER_BYTES = 2**26  # or as many as these hold
_FEWEST_TOGETHER = 8
_OF_PATHS = ("times", "angles", "angle", "torques", "factor", "offset")


@dataclass(frozen=True, eq=False)
class Flights:
    """Flights of one maneuver, and what is reported of each: a `somersault.simulation.Simulation`.

    Made by `flights`. `target` are the angles to land at, `accuracy` is in rad, and a flight that
    is not done after so many `steps` of the integration has failed. `varied` are the numbers in
    which the flights differ.
    """

    batch: Batch
    report: Report
    target: Mapping[str, float]
    accuracy: float
    steps: int
    varied: tuple[Name, ...] = ()

    def __repr__(self) -> str:
        return f"Flights({self.name}, {self.batch.duration:g} s)"

    def __getstate__(self) -> dict[str, Any]:
        state = {field.name: getattr(self, field.name) for field in fields(self)}
        return state | {"batch": replace(self.batch)}  # without what is compiled

    @property
    def name(self) -> str:
        """The model's."""
        return self.batch.model.name

    @property
    def packages(self) -> tuple[str, ...]:
        """The packages whose versions decide the last digits."""
        return ("somersault", "casadi", "llvmlite", "numpy", "scipy")

    @cached_property
    def specification(self) -> dict[str, Any]:
        """All that decides the numbers, as plain data."""
        batch = self.batch
        joints = {n: {"motion": j.motion, **canonical(j)} for n, j in batch.takeoff.joints.items()}
        return {
            "model": batch.model.name,
            "axes": list(batch.model.axes),
            "model_sha256": model_digest(batch.model),
            "duration": batch.duration,
            "until": batch.until,
            "accuracy": self.accuracy,
            "steps": self.steps,
            "takeoff": {**canonical(batch.takeoff), "joints": joints},
            "report": canonical(self.report),
            "target": canonical(self.target),
        }

    @property
    def values(self) -> Numbers:
        """The numbers of the takeoff, and those of bodies that are varied."""
        return self.batch.values

    @cached_property
    def variables(self) -> dict[str, Variable]:
        """What is reported of each flight."""
        return variables(self.report, self.batch.model)

    @cached_property
    def times(self) -> Array:
        """The times of histories, s."""
        return self.report.times(self.batch.duration)

    @property
    def endings(self) -> Endings:
        """How a flight can end."""
        return ENDINGS

    @cached_property
    def together(self) -> int:
        """How many flights are held in memory at once."""
        layout, report = self.batch.system.layout, self.report
        rows = 3 + 2 * len(report.extremes) + layout.state
        doubles = 12 * (rows + layout.parameters)
        doubles += len(self.times) * (3 * rows + 2 * layout.parameters)
        if any(name[0] in _OF_PATHS for name in self.varied):  # each has its own paths and tape
            knots = self.batch.begun().course.knots
            doubles += 6 * knots.shape[1] * layout.changing
        return min(_TOGETHER, max(_TOGETHER_BYTES // (8 * doubles), _FEWEST_TOGETHER))

    def targets(self, path: str) -> tuple[Target, ...]:
        """The numbers that a name means.

        Parameters
        ----------
        path : str
            "takeoff.tilt", say.

        Returns
        -------
        tuple of Target

        Raises
        ------
        SomersaultError
            For a name that means none of them.
        """
        return targets(self.batch, path)

    def with_varied(self, names: tuple[Name, ...]) -> Flights:
        """The same flights, ready to differ in some numbers.

        Parameters
        ----------
        names : tuple of tuple
            Of the numbers, as the targets have them.

        Returns
        -------
        Flights

        Raises
        ------
        SomersaultError
            For what cannot fly.
        """
        batch = self.batch.differing_in(names, body_names(names))
        _ = batch.system  # refuses what cannot fly, before anything is written
        return replace(self, batch=batch, varied=names)

    def sound(self, values: Numbers, count: int) -> Array:
        """Whether each flight can take off.

        Parameters
        ----------
        values : mapping of tuple to float or ndarray, (count,)
            The numbers of the flights.
        count : int
            How many flights.

        Returns
        -------
        ndarray of bool, (count,)
        """
        return self.batch.sound(values, count)

    def run(self, values: Numbers, count: int) -> dict[str, Array]:
        """Fly, and report.

        Parameters
        ----------
        values : mapping of tuple to float or ndarray, (count,)
            The numbers of the flights.
        count : int
            How many flights.

        Returns
        -------
        dict of str to ndarray, (count, …)
            What is reported of each, and how it ended.
        """
        begun = self.batch.begun(values, count)
        watch_from_takeoff(self.report, begun)
        samples = self.times if len(self.times) else np.array([self.batch.duration])
        solution = begun.solve(samples, self.accuracy, self.steps)
        return reported(self.report, self.target, begun, solution, self.times)

    def history(self, values: Numbers) -> Flight:
        """One of the flights, with its history at takeoff and at its end.

        Parameters
        ----------
        values : mapping of tuple to float or ndarray, (1,)
            The numbers of the flight, which can take off.

        Returns
        -------
        Flight
        """
        begun, times = self.batch.begun(values), np.array([0.0, self.batch.duration])
        return flown(self.batch, times, np.zeros(3), self.accuracy, self.steps, begun)

    def apart(self) -> tuple[Flights, dict[str, tuple[float, float]]]:
        """What the landing error is made of: e² = Σ (w (q − a))².

        Returns
        -------
        flights : Flights
            The same, reporting each q.
        parts : dict of str to (float, float)
            The angle a (rad, m) that is aimed at, and the weight w, by q's name.

        Raises
        ------
        SomersaultError
            Without angles to land at.
        """
        if not self.target:
            raise SomersaultError("these flights have no angles to land at; give them some")
        weights = error_weights(self.target)
        report = replace(self.report, quantities=tuple(self.target))
        parts = {name: (angle, weights[name]) for name, angle in self.target.items()}
        return replace(self, report=report), parts

    def ending_in_words(self, ending: str) -> str:
        """What flights did that ended so.

        Parameters
        ----------
        ending : str
            One of `ENDINGS`.

        Returns
        -------
        str
            Such as "flew for 2 s".
        """
        if ending == "duration":
            return f"flew for {self.batch.duration:.4g} s"
        return f"ended at a {self.batch.until}" if ending == "event" else ending


def flights(
    model: str | Model | Maneuver,
    takeoff: Takeoff | None = None,
    duration: float | None = None,
    *,
    report: Report | Sequence[str] = Report.quantities,
    against: Flight | Mapping[str, float] | None = None,
    until: str | None = None,
    accuracy: float | None = None,
    steps: int | None = None,
) -> Flights:
    """Flights of one maneuver that an ensemble may vary.

    Parameters
    ----------
    model : str, Model or Maneuver
        A maneuver has its own takeoff and duration.
    takeoff : Takeoff, optional
    duration : float, optional
        s; 1 by default.
    report : Report or sequence of str
        A `Report`, or the names of its quantities.
    against : Flight or mapping of str to float, optional
        What "landing_error" is measured against: the landing of a flight, or angles by name (rad;
        somersault, tilt, twist and joint coordinates).
    until : {"quarter twist"}, optional
        The event that ends a flight; by default the maneuver's, or none.
    accuracy : float, optional
        Of the attitude, rad; by default the maneuver's, or 1e-7.
    steps : int, optional
        A flight that is not done after so many steps of the integration has failed; by default the
        maneuver's, or 100,000.

    Returns
    -------
    Flights

    Raises
    ------
    SomersaultError
        For what does not fit.

    Examples
    --------
    >>> import somersault as so
    >>> so.flight.flights("furrer", so.Takeoff(spin=8.64), 2.0, report=["twist"]).name
    'furrer'
    """
    if isinstance(model, Maneuver):
        for name, given in (("takeoff", takeoff), ("duration", duration)):
            if given is not None:
                raise SomersaultError(f"{name} is given, but a maneuver has its own; leave it out")
        own, takeoff, duration = model, model.takeoff, model.duration
        until = own.until if until is None else until
        accuracy = own.accuracy if accuracy is None else accuracy
        steps = own.steps if steps is None else steps
        model = own.model
    accuracy = ACCURACY if accuracy is None else accuracy
    steps = STEPS if steps is None else steps
    duration = flight_time(1.0 if duration is None else duration)
    check_limits_of_flight(accuracy, until, steps)
    takeoff = Takeoff() if takeoff is None else takeoff
    require_takeoff(takeoff)
    if not isinstance(report, Report):
        report = Report(name_list("report, unless it is a Report,", report))
    target = target_of(against)
    batch = Batch(load(model), takeoff, duration, until, extremes=report.extremes)
    check(report, target, batch.model)
    return Flights(batch, report, target, float(accuracy), int(steps))
