"""The history of a landing, from touchdown until the gymnast stands or has fallen."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault._core.datasets import save_history
from somersault.attitude import matrix_from_quaternion
from somersault.ground._gymnast import Gymnast
from somersault.history import summary
from somersault.model import Model, centre_of_mass
from somersault.view import Filmed

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, eq=False)
class Stance(Filmed):
    """A landing, as `land` returns it. It is a `somersault.history.History`.

    Attributes
    ----------
    gymnast : Gymnast
    times : ndarray, (T,)
        s, from touchdown on; the clock is the flight's.
    base_position : ndarray, (T, 3)
        Of the trunk's frame, m.
    joint_coordinates, joint_rates : ndarray, (T, 4)
        rad, rad/s, in the order of `model.coordinates`.
    angles : ndarray, (T, 3)
        Somersault, tilt and twist, rad; turns of the flight count.
    angular_velocity : ndarray, (T,)
        Of the trunk, forwards, rad/s.
    base_velocity : ndarray, (T, 2)
        Of the trunk's frame, along and up, m/s.
    joint_torques : ndarray, (T, 4)
        Of the muscles, from each sample to the next, N m, both sides together.
    ground_force : ndarray, (T, 2)
        Of the floor, along and up: the mean from each sample to the next, N.
    ended : str
        "stood": it stood still for two seconds. "fell": something besides the feet touched the
        floor. "duration": neither.
    fell_on : str or None
        The body that touched the floor.
    """

    gymnast: Gymnast
    times: Array
    base_position: Array
    base_velocity: Array
    angles: Array
    angular_velocity: Array
    joint_coordinates: Array
    joint_rates: Array
    joint_torques: Array
    ground_force: Array
    ended: str
    fell_on: str | None

    def __repr__(self) -> str:
        return f"{summary(self)}, {self.ended}"

    @property
    def model(self) -> Model:
        """Of the gymnast."""
        return self.gymnast.model

    @property
    def stood(self) -> bool:
        """Whether it landed and stood."""
        return self.ended == "stood"

    @cached_property
    def base_quaternion(self) -> Array:
        """Scalar first, trunk to inertial, (T, 4)."""
        half, none = self.angles[:, 0] / 2, np.zeros(len(self.times))
        return np.stack([np.cos(half), none, np.sin(half), none], -1)

    @cached_property
    def centre_of_mass(self) -> Array:
        """Of the whole body, (T, 3), m."""
        turn = matrix_from_quaternion(self.base_quaternion)
        own = centre_of_mass(self.model, self.joint_coordinates)
        return np.asarray(self.base_position + np.einsum("tij,tj->ti", turn, own))

    @cached_property
    def dataset(self) -> xr.Dataset:
        """The history as a labelled dataset over `time`, with units."""
        import xarray as xr

        joints, ways = ("time", "joint"), ("time", "way")
        radian = {"units": "rad"}
        return xr.Dataset(
            {
                **{
                    name: ("time", self.angles[:, k], radian)
                    for k, name in enumerate(("somersault", "tilt", "twist"))
                },
                "base_position": (("time", "axis"), self.base_position, {"units": "m"}),
                "base_velocity": (ways, self.base_velocity, {"units": "m/s"}),
                "centre_of_mass": (("time", "axis"), self.centre_of_mass, {"units": "m"}),
                "angular_velocity": ("time", self.angular_velocity, {"units": "rad/s"}),
                "joint_angle": (joints, self.joint_coordinates, radian),
                "joint_rate": (joints, self.joint_rates, {"units": "rad/s"}),
                "joint_torque": (joints, self.joint_torques, {"units": "N m"}),
                "ground_force": (ways, self.ground_force, {"units": "N"}),
            },
            {
                "time": ("time", self.times, {"units": "s"}),
                "joint": list(self.model.coordinates),
                "way": ["along", "up"],
                "axis": [1, 2, 3],
            },
            {"model": self.model.name, "ended": self.ended},
        )

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the dataset as NetCDF or CSV.

        Parameters
        ----------
        path : path-like
            A .nc or .csv file.
        """
        save_history(self.dataset, path)
