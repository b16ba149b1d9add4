"""What a picture, a film and a page need of any motion, whatever made it.

A flight, a swing on the bar and a recording read back from a file are all histories; what draws
them knows nothing else.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import file_path, instance
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
