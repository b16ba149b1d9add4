"""What a picture, a film and a page need of any motion, whatever made it.

A flight, a swing on the bar and a recording read back from a file are all histories; what draws
them knows nothing else.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.checks import file_path, instance, shown
from somersault._core.errors import SomersaultError
from somersault._core.hdf5 import require_readable
from somersault._core.numbers import floats
from somersault.attitude import unwrapped_angles
from somersault.model import Model

_VARIABLES = ("base_position", "quaternion", "joint_angle", "somersault", "tilt", "twist")
_UNIT = 1e-6  # how far the length of a quaternion may be from 1


class History(Protocol):
    """How a model moved: the pose of its base and its joints at some times.

    The base is the frame of a free model's base body, or the ground where the base is fixed: then
    `base_position` is zero and `base_quaternion` is no turn.
    """

    @property
    def model(self) -> Model:
        """What moved."""
        ...

    @property
    def times(self) -> Array:
        """(T,), s, rising."""
        ...

    @property
    def base_position(self) -> Array:
        """Of the base frame's origin, in inertial axes, (T, 3), m."""
        ...

    @property
    def base_quaternion(self) -> Array:
        """Scalar first, from the base's axes to inertial ones, (T, 4)."""
        ...

    @property
    def joint_coordinates(self) -> Array:
        """In the order of `model.coordinates`, (T, coordinates), rad, m, or quaternions."""
        ...

    @property
    def angles(self) -> Array:
        """Somersault, tilt and twist, unwrapped, (T, 3), rad: attitudes alone do not hold the whole
        turns made between samples."""
        ...


@dataclass(frozen=True, eq=False)
class Recording:
    """A history by its numbers: of a file, a measurement, or another program.

    Parameters
    ----------
    model : Model
    times : array_like, (T,)
        s, rising.
    base_position : array_like, (T, 3)
        Of the base frame's origin, m, inertial axes.
    base_quaternion : array_like, (T, 4)
        Scalar first, from the base's axes to inertial ones.
    joint_coordinates : array_like, (T, coordinates)
        In the order of `model.coordinates`.
    angles : array_like, (T, 3), optional
        Somersault, tilt and twist, rad. Without them they are those of the attitudes, which must
        then be less than a quarter turn apart.

    Raises
    ------
    SomersaultError
        For arrays of other shapes, numbers that are not finite, times that do not rise, and
        quaternions that are not of unit length.
    """

    model: Model
    times: Array
    base_position: Array
    base_quaternion: Array
    joint_coordinates: Array
    angles: Array = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        instance("model", self.model, Model)
        count = floats("times of a recording", self.times).size
        shapes = {
            "times": (count,),
            "base_position": (count, 3),
            "base_quaternion": (count, 4),
            "joint_coordinates": (count, len(self.model.coordinates)),
        }
        if self.angles is not None:
            shapes["angles"] = (count, 3)
        for name, shape in shapes.items():
            object.__setattr__(self, name, _numbers(name, getattr(self, name), shape))
        if not count or np.any(np.diff(self.times) <= 0):
            raise SomersaultError("times of a recording must rise; sort them and drop doubles")
        if np.abs(np.linalg.norm(self.base_quaternion, axis=1) - 1).max() > _UNIT:
            raise SomersaultError("base_quaternion must be of unit length; divide by its length")
        if self.angles is None:
            path = unwrapped_angles(self.base_quaternion, self.model.axes)
            object.__setattr__(self, "angles", path)

    def __repr__(self) -> str:
        return summary(self)


def summary(history: History) -> str:
    """One line: what it is, of what model, how many samples, from when to when.

    Parameters
    ----------
    history : History

    Returns
    -------
    str
        Its model, how many samples it has, and from when to when.
    """
    first, last = history.times[[0, -1]]
    return (
        f"{type(history).__name__} of {history.model.name}: {len(history.times)} samples, "
        f"{first:g} to {last:g} s"
    )


def joined(histories: Sequence[History], clocks: ArrayLike) -> Recording:
    """One recording of several histories of the same body, as of a swing, a flight and a landing.

    Each is cut off where the next one begins. Whole turns that a history does not know of are those
    of the one before.

    Parameters
    ----------
    histories : sequence of History
        One after another.
    clocks : array_like, (histories,)
        What the recording's clock shows when that of each history shows zero, s.

    Returns
    -------
    Recording

    Raises
    ------
    SomersaultError
        For different models, and histories that do not begin one after another.

    Examples
    --------
    >>> import somersault as so
    >>> up = so.fly("book", so.Takeoff(spin=3.0), 0.5)
    >>> so.history.joined([up, up], clocks=[0.0, 0.5]).times[[0, -1]].tolist()
    [0.0, 1.0]
    """
    try:
        row = list(histories)
    except TypeError:
        row = []
    if not row or not all(hasattr(one, "joint_coordinates") for one in row):
        raise SomersaultError(
            f"histories must be a list of flights, swings or recordings, and is {shown(histories)}"
        )
    begin = floats("clocks", clocks)
    if begin.shape != (len(row),) or not np.all(np.isfinite(begin)):
        raise SomersaultError(f"clocks must be {len(row)} finite numbers, one for each history")
    if any(one.model != row[0].model for one in row):
        raise SomersaultError("only histories of the same model can be joined; give those of one")
    times = [one.times + clock for one, clock in zip(row, begin.tolist(), strict=True)]
    starts = [first[0] for first in times]
    if np.any(np.diff(starts) <= 0):
        raise SomersaultError("joined histories must begin one after another; sort them")
    kept = [
        clock < end if end is not None else np.full(clock.shape, True)
        for clock, end in zip(times, [*starts[1:], None], strict=True)
    ]

    def together(parts: list[Array]) -> Array:
        return np.concatenate([part[keep] for part, keep in zip(parts, kept, strict=True)])

    turned: list[Array] = []
    for one, keep in zip(row, kept, strict=True):
        ahead = turned[-1][-1] - one.angles[0] if turned else np.zeros(3)
        turned.append(one.angles[keep] + 2 * np.pi * np.round(ahead / (2 * np.pi)))
    return Recording(
        row[0].model,
        together(times),
        together([one.base_position for one in row]),
        together([one.base_quaternion for one in row]),
        together([one.joint_coordinates for one in row]),
        np.concatenate(turned),
    )


def _numbers(name: str, values: object, shape: tuple[int, ...]) -> Array:
    array = floats(f"{name} of a recording", values)
    if array.shape != shape:
        wanted = " x ".join(map(str, shape))
        given = " x ".join(map(str, array.shape)) or "one number"
        raise SomersaultError(f"{name} of this recording must be {wanted} numbers, and is {given}")
    if not np.all(np.isfinite(array)):
        raise SomersaultError(f"{name} of a recording must be finite numbers")
    return array


def read_recording(path: str | os.PathLike[str], model: Model) -> Recording:
    """The history in a NetCDF file that `Flight.save` wrote.

    Parameters
    ----------
    path : path-like
        The .nc file.
    model : Model
        What flew; the file holds its name and joints, but not its bodies.

    Returns
    -------
    Recording

    Raises
    ------
    SomersaultError
        For a file that is not there or holds no flight, or one of a model with other joints.

    Examples
    --------
    >>> import somersault as so
    >>> so.fly("furrer", so.Takeoff(spin=8.0), 1.0).save("flight.nc")  # doctest: +SKIP
    >>> so.read_recording("flight.nc", so.load("furrer"))  # doctest: +SKIP
    Recording of furrer: 201 samples, 0 to 1 s
    """
    instance("model", model, Model)
    file = file_path("path", path)
    data = _opened(file)
    if data["joint"] != model.coordinates:
        raise SomersaultError(
            f"{file.name} is of a model with {len(data['joint'])} joint coordinates, which are not "
            f"those of {model.name}; give the model that flew"
        )
    return Recording(
        model,
        data["time"],
        data["base_position"],
        data["quaternion"],
        data["joint_angle"],
        np.stack([data[name] for name in ("somersault", "tilt", "twist")], -1),
    )


def _opened(file: Path) -> dict[str, Any]:
    """The variables of a flight's NetCDF file, and the names of its `joint` coordinates.

    They are read as plain HDF5, which minds damaged dimension scales less.
    """
    import h5py

    require_readable(file)
    try:
        with h5py.File(file) as data:
            missing = [name for name in (*_VARIABLES, "time", "joint") if name not in data]
            read = {name: data[name][()] for name in (*_VARIABLES, "time") if not missing}
            if not missing:
                read["joint"] = tuple(data["joint"].asstr()[()].tolist())
    except Exception as error:  # whatever HDF5 meets in bytes that are not its own
        reason = " ".join(str(error).split()).rstrip(".")[:200] or type(error).__name__
        raise SomersaultError(
            f"{file.name} cannot be read as NetCDF: {reason}; give a .nc that Flight.save wrote"
        ) from None
    if missing:
        raise SomersaultError(
            f"{file.name} holds no flight: it has no {', '.join(missing)}; give a file that "
            "Flight.save wrote"
        )
    return read
