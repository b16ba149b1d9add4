"""A maneuver: a model, how it takes off, and how long it flies."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import file_path, instance, shown, whole_number
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number, numbers
from somersault._core.places import check_file
from somersault.flight._batch import Batch
from somersault.flight._flight import Flight
from somersault.flight._flown import flown
from somersault.flight._plane import refuse_out_of_plane
from somersault.flight._prescribed import prescribed
from somersault.flight._spec import parsed, tables
from somersault.flight._strange import note_strange
from somersault.flight._takeoff import Takeoff, require_takeoff
from somersault.flight._variants import Variants
from somersault.flight.behaviours import OnPath
from somersault.model import Model, load
from somersault.motion import Motion
from somersault.spec import read_toml, write_toml

Event = Literal["quarter twist"]
STEPS = 100_000  # of one flight's integration
_MOST_STEPS = 10**9
_MOST_SAMPLES = 5_000_000


@dataclass(frozen=True, eq=False)
class Maneuver(Variants):
    """What a model does in the air, from takeoff to landing.

    Parameters
    ----------
    model : Model or str
        A model, the name of a shipped one, or a file.
    takeoff : Takeoff
        How it begins, and what its joints do.
    duration : float
        Of the flight, s.
    gravity : sequence of float, (3,)
        m/s², in inertial axes, 3 being up; it moves the centre of mass and nothing else.
    accuracy : float
        rad, the attitude error to stay below over a flight of some somersaults; a body that tumbles
        multiplies errors as it does all deviations.
    samples : int or sequence of float, optional
        How many evenly spaced times are kept, the ends included, or the times themselves (s); 100 a
        second unless it is given.
    until : {"quarter twist"}, optional
        What ends the flight earlier: the body's axis of somersault at right angles to the inertial
        one (twist ±π/2), found to rounding.
    steps : int
        A flight that is not done after so many steps of the integration, and twenty more for every
        sample and every 0.6 rad that it may turn, is given up: a joint in gimbal lock, or a spring
        too stiff.

    Raises
    ------
    SomersaultError
        For anything that does not fit.

    Examples
    --------
    >>> import somersault as so
    >>> twist = so.arm_tilt()
    >>> flight = twist.compliant(30.0, pose="wrap").off_nominal(tilt=-0.05).fly()
    >>> flight.ended
    'duration'
    """

    model: Model
    takeoff: Takeoff
    duration: float = 1.0
    gravity: Sequence[float] = (0.0, 0.0, 0.0)
    accuracy: float = 1e-9
    samples: int | Sequence[float] | Array | None = None
    until: Event | None = None
    steps: int = STEPS

    def __post_init__(self) -> None:
        object.__setattr__(self, "model", load(self.model))
        require_takeoff(self.takeoff)
        object.__setattr__(self, "duration", flight_time(self.duration))
        numbers("gravity", self.gravity, 3)
        refuse_out_of_plane(self.model, "gravity", "gravity", self.gravity)
        check_limits_of_flight(self.accuracy, self.until, self.steps)

    @classmethod
    def moves(
        cls,
        model: str | Model,
        keyframes: Mapping[str, Sequence[tuple[float, float]]],
        takeoff: Takeoff,
        duration: float = 1.0,
        **options: Any,
    ) -> Maneuver:
        """A maneuver whose joints move smoothly through keyframes.

        Parameters
        ----------
        model : str or Model
        keyframes : mapping of str to list of (float, float)
            Times (s) and angles (rad, m) by joint, as `Motion.moves` takes them; joints of the
            takeoff that are named here move so.
        takeoff : Takeoff
        duration : float
            s.
        **options
            Other fields of the maneuver.

        Returns
        -------
        Maneuver

        Examples
        --------
        >>> import somersault as so
        >>> arms = {"shoulder": [(0.1, 1.4), (0.4, 0.2)]}
        >>> so.Maneuver.moves("furrer", arms, so.Takeoff(spin=7.0), 0.8)
        Maneuver(furrer, 0.8 s)
        """
        instance("takeoff", takeoff, Takeoff)
        body = load(model)
        joints = prescribed(body, Motion.moves(body, keyframes))
        moving = replace(takeoff, joints={**takeoff.joints, **joints})
        return cls(body, moving, duration, **options)

    def __repr__(self) -> str:
        return f"Maneuver({self.model.name}, {self.duration:g} s)"

    # --------------------------------------------------------------------------- flying

    @property
    def times(self) -> Array:
        """Sample times, s."""
        return _times(self.duration, self.samples)

    @property
    def batch(self) -> Batch:
        """The flights that share this one's equations."""
        return Batch(self.model, self.takeoff, self.duration, self.until, differing=())

    def fly(self, **options: Any) -> Flight:
        """The flight.

        Parameters
        ----------
        **options
            Fields of the maneuver that are to be others: accuracy, samples, until …

        Returns
        -------
        Flight
            Where it broke off, or joints went far beyond their limits, with a SomersaultWarning
            that says so.

        Examples
        --------
        >>> import somersault as so
        >>> layout = so.Maneuver("furrer", so.Takeoff(spin=8.64), 0.5)
        >>> layout.fly(samples=11).times.shape
        (11,)
        """
        if options:
            return self.changed(**options).fly()
        gravity = numbers("gravity", self.gravity, 3)
        flight = flown(self.batch, self.times, gravity, self.accuracy, self.steps)
        note_strange(flight)
        return flight

    @property
    def keyframes(self) -> dict[str, list[tuple[float, float]]]:
        """Times (s) and angles (rad, m) of the joints that are moved through such, by name."""
        return {
            name: list(zip(does.times, does.angles, strict=True))
            for name, does in self.takeoff.joints.items()
            if isinstance(does, OnPath) and does.path is None
        }

    @property
    def motion(self) -> Motion:
        """The motion of all joints that move through keyframes."""
        return Motion.moves(self.model, self.keyframes)

    # ---------------------------------------------------------------------------- files

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Maneuver:
        r"""The maneuver in a TOML file, a SPEC as `somersault fly` takes it.

        Parameters
        ----------
        path : str or path-like
            Its model, and its recording if it has one, are looked for beside it.

        Returns
        -------
        Maneuver

        Raises
        ------
        SomersaultError
            Naming the key, for what does not fit.

        Examples
        --------
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> import somersault as so
        >>> with TemporaryDirectory() as folder:
        ...     spec = Path(folder) / "layout.toml"
        ...     _ = spec.write_text('model = "furrer"\nduration = 0.5\n[takeoff]\nspin = 8.64\n')
        ...     so.Maneuver.read(spec).duration
        0.5
        """
        file = file_path("a SPEC", path)
        return cls.parse(read_toml(file), file.parent)

    @classmethod
    def parse(cls, tables: Mapping[str, Any], beside: str | os.PathLike[str] = ".") -> Maneuver:
        """The maneuver that the tables of a SPEC describe.

        Parameters
        ----------
        tables : mapping
            As TOML has them.
        beside : path-like
            The folder in which files that they name are looked for.

        Returns
        -------
        Maneuver

        Raises
        ------
        SomersaultError
            Naming the key, for what does not fit.

        Examples
        --------
        >>> import somersault as so
        >>> spec = {"model": "furrer", "duration": 0.5, "takeoff": {"spin": 8.64}}
        >>> so.Maneuver.parse(spec).duration
        0.5
        """
        return cls(**parsed(tables, file_path("beside", beside)))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the maneuver as a TOML file, whole or not at all.

        It flies the same, bit for bit, when it is read again, and by `somersault fly`. A model
        that does not ship with the package is written to the same folder as MJCF, under the same
        name; a file of that name that is something else stays as it is. Frames and inertias that
        are turned to each other come back from there with another last bit.

        Parameters
        ----------
        path : str or path-like
            It ends in .toml.

        Raises
        ------
        SomersaultError
            For what a SPEC cannot hold, or a file that cannot be written.

        Examples
        --------
        >>> from tempfile import TemporaryDirectory
        >>> import somersault as so
        >>> layout = so.Maneuver("furrer", so.Takeoff(spin=8.64), 0.5)
        >>> with TemporaryDirectory() as folder:
        ...     layout.save(f"{folder}/layout.toml")
        ...     so.Maneuver.read(f"{folder}/layout.toml").duration
        0.5
        """
        file = check_file(path, (".toml",))
        write_toml(file, tables(self, file))

    # -------------------------------------------------------------------- other maneuvers


def flight_time(duration: float) -> float:
    """A duration in s; SomersaultError for one that is no flight."""
    if number("duration", duration) <= 0:
        raise SomersaultError(f"duration {duration:g} s is no flight; give a positive number")
    return float(duration)


def check_limits_of_flight(accuracy: float, until: str | None, steps: int) -> None:
    """SomersaultError unless a flight can be flown so accurately, until such an event, in so many
    steps."""
    if not 1e-14 <= number("accuracy", accuracy) <= 1e-2:
        raise SomersaultError(f"accuracy {accuracy:g} rad is out of reach; give 1e-14 to 1e-2")
    if until is not None and not (isinstance(until, str) and until == "quarter twist"):
        raise SomersaultError(f"until {shown(until)} is no event; use 'quarter twist'")
    whole_number("steps", steps, 1, _MOST_STEPS)


def _times(duration: float, samples: int | Sequence[float] | Array | None) -> Array:
    if samples is None:
        samples = int(min(max(2, math.ceil(100 * duration) + 1), 100_001))
    if isinstance(samples, int | np.integer) and not isinstance(samples, bool):
        if not 2 <= samples <= _MOST_SAMPLES:
            raise SomersaultError(f"samples must be 2 to {_MOST_SAMPLES}, and is {shown(samples)}")
        return np.linspace(0.0, duration, int(samples))
    times = numbers("samples", samples)
    if not times.size or np.any(np.diff(times) <= 0) or times[0] < 0 or times[-1] > duration:
        raise SomersaultError("samples must be times that increase from 0 or later to the duration")
    return times
