"""What a flight was: a labelled history, its landing, and how well it kept what it must."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.array import Array
from somersault._core.datasets import save_history
from somersault.attitude import matrix_from_quaternion, unwrapped_angles
from somersault.flight._ballistic import BallisticPath
from somersault.flight._course import Course
from somersault.flight._landing import Landing
from somersault.flight._plane import kept
from somersault.flight._start import Start
from somersault.flight._system import System
from somersault.history import summary
from somersault.model import Model, centre_of_mass, segment_momenta
from somersault.view import Filmed

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False)
class Flight(Filmed):
    """One flight, as `fly` returns it. It is a `somersault.history.History`.

    Attributes
    ----------
    model : Model
        The one that was given, with its shapes.
    dataset : xarray.Dataset
        The whole history over `time`, labelled, with units.
    landing : Landing
        How it ended.
    start : Start
        The takeoff in numbers: attitude, angular velocity, joints, angular momentum.
    ended : str
        "duration", "event", "too many steps" or "not finite".
    steps : int
        Steps of the integration.
    momentum_drift, energy_drift : float
        Largest relative change of the angular momentum (of a planar model: about the axis across
        its plane), and of the energy where it is kept.

    Examples
    --------
    >>> import somersault as so
    >>> flight = so.fly("book", so.Takeoff(spin=3.0, tilt=0.1), duration=2.0)
    >>> flight.momentum_drift < 1e-12 and flight.energy_drift < 1e-12
    True
    """

    model: Model
    system: System
    start: Start
    position: Array
    velocity: Array
    gravity: Array
    _moments: Array
    _states: Array
    _keep: Array
    _course: Course
    ended: str
    steps: int

    def __repr__(self) -> str:
        return f"{summary(self)}, ended by {self.ended}"

    @cached_property
    def _angles(self) -> Array:
        """Somersault, tilt, twist at every point, unwrapped, (points, 3)."""
        path = unwrapped_angles(self._states[:, :4], self.model.axes, self.start.angles)
        return _from(path, self.start.angles)

    @property
    def angles(self) -> Array:
        """Somersault, tilt and twist at the sample times, unwrapped, (time, 3), rad."""
        return self._angles[self._keep]

    @property
    def base_quaternion(self) -> Array:
        """Scalar first, base to inertial, (time, 4)."""
        return self.states[:, :4]

    @cached_property
    def base_position(self) -> Array:
        """Of the base frame's origin in inertial axes, (time, 3), m."""
        centre = centre_of_mass(self.model, self.joint_coordinates)
        turn = matrix_from_quaternion(self.base_quaternion)
        return self.centre_of_mass - np.einsum("tij,tj->ti", turn, centre)

    @property
    def joint_coordinates(self) -> Array:
        """At the sample times, (time, coordinates), rad, m, or quaternions."""
        return self._read[1]

    @cached_property
    def centre_of_mass(self) -> Array:
        """Of the whole body in inertial axes, (time, 3), m.

        It falls; across the plane of a planar model it goes with what moves there, as the base
        stays in the plane.
        """
        path = self.ballistic_path.at(self.times)
        if self.model.plane is not None:
            across = self.model.plane - 1
            of_pose = centre_of_mass(self.model, self.joint_coordinates)[:, across]
            path[:, across] += of_pose - centre_of_mass(self.model, self.start.q)[across]
        return path

    @property
    def ballistic_path(self) -> BallisticPath:
        """The parabola of the centre of mass: its apex, and when it comes down to a height."""
        return BallisticPath(self.position, self.velocity, self.gravity)

    @cached_property
    def times(self) -> Array:
        """Sample times in s, (time,)."""
        return self._moments[self._keep]

    @cached_property
    def states(self) -> Array:
        """States at the sample times, (time, state), quaternions of unit length."""
        states = self._states[self._keep].copy()
        states[:, :4] /= np.linalg.norm(states[:, :4], axis=1, keepdims=True)
        return states

    @cached_property
    def _read(self) -> tuple[Array, Array, Array]:
        """ω, joint coordinates and speeds at the sample times."""
        return self.system.read(self._states[self._keep], self.times, self._parameters)

    @property
    def _parameters(self) -> Array:
        return self._course.parameters(self.times[None], self._states[None, self._keep])[0]

    @property
    def phase(self) -> Array:
        """The time of paths and motor tape at the sample times, (time,), s: another one than that
        of the clock where the takeoff has a replay."""
        return self._course.phase(self.times, self._states[self._keep])[0]

    @property
    def phase_rate(self) -> Array:
        """How fast paths and motor tape are played at the sample times, (time,), 1 being as they
        are."""
        return self._course.phase(self.times, self._states[self._keep])[1]

    @property
    def angular_velocity(self) -> Array:
        """In body axes, (time, 3), rad/s."""
        return self._read[0]

    @property
    def _joints(self) -> tuple[Array, Array]:
        return self._read[1:]

    @cached_property
    def _loads(self) -> Array:
        x = [self._states[self._keep], self.times[:, None], self._parameters]
        return self.system.loads(np.concatenate(x, 1))

    @property
    def joint_torques(self) -> xr.DataArray:
        """What acts at the joints, by springs, dampers and muscles, (time, joint speeds), N m (N):
        the inverse dynamics of the flight."""
        import xarray as xr

        return xr.DataArray(
            self._loads[:, 6:],
            {"time": self.times, "joint_speed": list(self.model.speeds)},
            ("time", "joint_speed"),
            "joint_torque",
            {"units": "N m or N"},
        )

    @property
    def external_moment(self) -> Array:
        """What the motion would need from outside, about the base's centre of mass and in body
        axes, (time, 3), N m: zero, but for rounding, unless something holds the base in a plane."""
        return self._loads[:, :3]

    @cached_property
    def _speeds(self) -> Array:
        """(ω, velocity of the base with the centre of mass at rest, joint speeds); a base in a
        plane does not move across it."""
        q, u = self._joints
        still = np.concatenate([self.angular_velocity, np.zeros((len(u), 3)), u], 1)
        linear = self.system.equations.momentum(q, still)[:, 3:]
        shifts = [way for way in self.model.base_ways if way >= 3]
        still[:, shifts] = (-linear / self.model.mass)[:, [way - 3 for way in shifts]]
        return still

    @cached_property
    def angular_momentum(self) -> Array:
        """About the centre of mass, in inertial axes, (time, 3), kg m²/s."""
        h = self.system.equations.momentum(self._joints[0], self._speeds)[:, :3]
        return np.einsum("tij,tj->ti", matrix_from_quaternion(self.states[:, :4]), h)

    @property
    def segment_momentum(self) -> xr.DataArray:
        """Angular momentum of each body about the whole body's centre of mass, in inertial axes,
        (time, body, inertial_axis), kg m²/s: over the bodies it sums to `angular_momentum`."""
        import xarray as xr

        q, u = self._joints
        momenta = segment_momenta(self.model, q, self.angular_velocity, u)
        turn = matrix_from_quaternion(self.base_quaternion)
        return xr.DataArray(
            np.einsum("tij,tbj->tbi", turn, momenta),
            {
                "time": self.times,
                "body": [body.name for body in self.model.bodies],
                "inertial_axis": [1, 2, 3],
            },
            ("time", "body", "inertial_axis"),
            "segment_momentum",
            {"units": "kg m2/s"},
        )

    @cached_property
    def kinetic_energy(self) -> Array:
        """Of motion about the centre of mass, (time,), J."""
        return self.system.equations.kinetic_energy(self._joints[0], self._speeds)

    @cached_property
    def spring_energy(self) -> Array:
        """Held by the springs and pretensions of sprung joints, (time,), J."""
        q, _ = self._joints
        total = np.zeros(len(q))
        for plan in self.start.plans:
            where = self.model.coordinate_slice(plan.joint.name)
            total += plan.does.energy(plan.joint, q[:, where])
        return total

    @property
    def momentum_drift(self) -> float:
        """Largest change of angular momentum, over its size (kg m²/s where that is zero)."""
        h = kept(self.model, self.angular_momentum)
        size = float(np.linalg.norm(h[0]))
        return float(np.linalg.norm(h - h[0], axis=1).max() / (size or 1.0))

    @property
    def conservative(self) -> bool:
        """Whether energy is kept: nothing damped, nothing driven."""
        return all(plan.does.conservative for plan in self.start.plans)

    @property
    def energy_drift(self) -> float | None:
        """Largest relative change of energy; None where it is not kept."""
        if not self.conservative:
            return None
        energy = self.kinetic_energy + self.spring_energy
        return float(np.abs(energy - energy[0]).max() / (abs(energy[0]) or 1.0))

    @property
    def landing(self) -> Landing:
        """How it ended."""
        somersault, tilt, twist = self._angles[-1].tolist()
        state, time = self._states[-1], self._moments[-1]
        last = self._course.parameters(self._moments[None, -1:], self._states[None, -1:])[0]
        omega, q, _ = self.system.read(self._states[-1:], self._moments[-1:], last)
        return Landing(
            float(time), somersault, tilt, twist,
            state[:4] / np.linalg.norm(state[:4]), omega[0],
            dict(zip(self.model.coordinates, q[0].tolist(), strict=True)), self.ended,
        )  # fmt: skip

    @cached_property
    def dataset(self) -> xr.Dataset:
        """The history as a labelled dataset over `time`."""
        import xarray as xr

        return xr.Dataset(self._variables(), self._coordinates(), self._attributes())

    def _variables(self) -> dict[str, Any]:
        angles = self.angles
        q, u = self._joints
        rad = {"units": "rad"}
        replayed = {
            "phase": ("time", self.phase, {"units": "s"}),
            "phase_rate": ("time", self.phase_rate, {"units": "1"}),
        }
        return {
            **(replayed if self.system.symbols.playback is not None else {}),
            "somersault": ("time", angles[:, 0], rad),
            "tilt": ("time", angles[:, 1], rad),
            "twist": ("time", angles[:, 2], rad),
            "quaternion": (("time", "component"), self.states[:, :4], {"units": "1"}),
            "angular_velocity": (("time", "body_axis"), self.angular_velocity, {"units": "rad/s"}),
            "joint_angle": (("time", "joint"), q, {"units": "rad or m"}),
            "joint_rate": (("time", "joint_speed"), u, {"units": "rad/s or m/s"}),
            "angular_momentum": (
                ("time", "inertial_axis"), self.angular_momentum, {"units": "kg m2/s"},
            ),
            "kinetic_energy": ("time", self.kinetic_energy, {"units": "J"}),
            "spring_energy": ("time", self.spring_energy, {"units": "J"}),
            "centre_of_mass": (("time", "inertial_axis"), self.centre_of_mass, {"units": "m"}),
            "base_position": (("time", "inertial_axis"), self.base_position, {"units": "m"}),
        }  # fmt: skip

    def _coordinates(self) -> dict[str, Any]:
        model = self.model
        return {
            "time": ("time", self.times, {"units": "s"}),
            "component": list("wxyz"),
            "body_axis": [1, 2, 3],
            "inertial_axis": [1, 2, 3],
            "joint": list(model.coordinates),
            "joint_speed": list(model.speeds),
        }

    def _attributes(self) -> dict[str, Any]:
        model = self.model
        return {
            "model": model.name, "axes": list(model.axes), "ended": self.ended, "steps": self.steps,
        }  # fmt: skip

    def plot(self) -> Figure:
        """The history as a picture.

        Returns
        -------
        matplotlib.figure.Figure
            Its `.savefig(file)` writes it.
        """
        from somersault.view import time_histories

        return time_histories(self, f"{self.model.name}, ended by {self.ended}")

    def save(self, path: str | Path) -> None:
        """Write the history to a file, whole or not at all.

        Parameters
        ----------
        path : str or Path
            A NetCDF file (.nc) or a table (.csv).

        Raises
        ------
        SomersaultError
            For a file of another kind, or one that cannot be written.

        Examples
        --------
        >>> from tempfile import TemporaryDirectory
        >>> import somersault as so
        >>> flight = so.fly("furrer", so.Takeoff(spin=8.64), 0.5)
        >>> with TemporaryDirectory() as folder:
        ...     flight.save(f"{folder}/layout.nc")
        ...     so.read_recording(f"{folder}/layout.nc", flight.model)
        Recording of furrer: 51 samples, 0 to 0.5 s
        """
        save_history(self.dataset, path)


def _from(path: Array, given: Array) -> Array:
    """The path in the representation, and with the whole turns, that it takes off with."""
    other = path + np.pi
    other[:, 1] = np.pi - path[:, 1]
    best = path
    for choice in (path, other):
        turned = choice + 2 * np.pi * np.round((given - choice[0]) / (2 * np.pi))
        if choice is path or np.abs(turned[0] - given).sum() < np.abs(best[0] - given).sum():
            best = turned
    return best
