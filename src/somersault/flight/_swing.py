"""A body swung by what holds it, as round a bar, until it is let go and flies.

The swing is of a model with a fixed base (`model._mounted`); letting go changes no position and
no velocity, so `released` reads the takeoff of the free model off the last moment of the swing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.checks import by_name, instance, shown, whole_number
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number, numbers
from somersault.dynamics import Equations
from somersault.engine import STATUS, Integrator
from somersault.flight._prop import Prop
from somersault.history import summary
from somersault.model import (
    Model,
    centre_of_mass,
    pose,
    spread,
)
from somersault.view import Filmed

if TYPE_CHECKING:
    import xarray as xr

_MOST_SAMPLES = 1_000_000
GRAVITY = (0.0, 0.0, -9.81)  # m/s², inertial axes; 3 is up


@dataclass(frozen=True, eq=False)
class Swing(Filmed):
    """The motion of a model with a fixed base, as `swing` returns it: a `history.History`.

    Attributes
    ----------
    times : ndarray, (T,)
        s; the last is when it ended.
    q, u : ndarray, (T, joints)
        Joint coordinates and rates.
    ended : str
        "duration" or "event".
    dataset : xarray.Dataset
        All of it over `time` and `joint`, labelled, with units and energies.
    """

    model: Model
    gravity: Array
    stops: Mapping[str, Prop]
    times: Array
    q: Array
    u: Array
    ended: str

    def __repr__(self) -> str:
        return f"{summary(self)}, ended by {self.ended}"

    @property
    def base_position(self) -> Array:
        """Of the ground that holds it, (T, 3): zero."""
        return np.zeros((len(self.times), 3))

    @property
    def base_quaternion(self) -> Array:
        """Of the ground that holds it, (T, 4): no turn."""
        return np.tile([1.0, 0.0, 0.0, 0.0], (len(self.times), 1))

    @property
    def angles(self) -> Array:
        """Somersault, tilt and twist of the ground, (T, 3): zero."""
        return np.zeros((len(self.times), 3))

    @property
    def joint_coordinates(self) -> Array:
        """(T, joints), rad or m."""
        return self.q

    @cached_property
    def equations(self) -> Equations:
        """Of the model with its fixed base."""
        return Equations(self.model)

    @cached_property
    def stop_torques(self) -> Array:
        """What the stops give at each joint, (T, joints), N m."""
        return np.array([_stop_torques(self.model, self.stops, *x) for x in self._states()])

    @cached_property
    def spring_torques(self) -> Array:
        """What the joints' springs give, (T, joints), N m (N for a slide)."""
        joints = self.model.joints
        k, rest = (np.array([getattr(j, name) for j in joints]) for name in ("stiffness", "rest"))
        return -k * (self.q - rest)

    @cached_property
    def stop_energy(self) -> Array:
        """What the stops hold where they do not damp, (T,), J."""
        total = np.zeros(len(self.times))
        for name, stop in self.stops.items():
            q = self.q[:, self.model.coordinate_slice(name).start]
            passed = np.maximum(stop.side * (stop.angle - q), 0.0)
            total += 0.5 * stop.stiffness * passed**2
        return total

    @cached_property
    def height_energy(self) -> Array:
        """Potential energy of gravity, (T,), J."""
        return height_energy(self.equations, self.q, self.gravity)

    @cached_property
    def dataset(self) -> xr.Dataset:
        """The history as a labelled dataset over `time` and `joint`."""
        import xarray as xr

        kinetic = self.equations.kinetic_energy(self.q, self.u)
        spring = self.equations.spring_energy(self.q)
        along, joule = ("time", "joint"), {"units": "J"}
        return xr.Dataset(
            {
                "angle": (along, self.q, {"units": "rad or m"}),
                "rate": (along, self.u, {"units": "rad/s or m/s"}),
                "stop_torque": (along, self.stop_torques, {"units": "N m or N"}),
                "spring_torque": (along, self.spring_torques, {"units": "N m or N"}),
                "kinetic_energy": ("time", kinetic, joule),
                "spring_energy": ("time", spring, joule),
                "stop_energy": ("time", self.stop_energy, joule),
                "height_energy": ("time", self.height_energy, joule),
                "energy": (
                    "time", kinetic + spring + self.stop_energy + self.height_energy, joule,
                ),
            },
            {
                "time": ("time", self.times, {"units": "s"}),
                "joint": [joint.name for joint in self.model.joints],
            },
            {"model": self.model.name, "ended": self.ended},
        )  # fmt: skip

    def _states(self) -> list[tuple[list[float], list[float]]]:
        return list(zip(self.q.tolist(), self.u.tolist(), strict=True))


def swing(
    model: Model,
    angles: Mapping[str, float],
    duration: float,
    *,
    rates: Mapping[str, float] | None = None,
    gravity: Sequence[float] = GRAVITY,
    until: tuple[str, float] | None = None,
    stops: Mapping[str, Prop] | None = None,
    samples: int = 401,
    accuracy: float = 1e-10,
) -> Swing:
    """The swing of a model with a fixed base.

    Parameters
    ----------
    model : Model
        With a fixed base, such as a `mounted` one; its joints are hinges and slides, with their
        springs and dampers.
    angles, rates : mapping of str to float
        At the start, by joint, rad and rad/s; a joint that is not named is at its reference, at
        rest.
    duration : float
        s.
    gravity : sequence of float, (3,)
        m/s², along the ground's axes.
    until : (str, float), optional
        A joint and the angle (rad) at which the swing ends, found to rounding.
    stops : mapping of str to Prop, optional
        Props by joint.
    samples : int
        How many evenly spaced times are kept.
    accuracy : float
        Bounds each step's error relative to 1 + the size of the state.

    Returns
    -------
    Swing

    Raises
    ------
    SomersaultError
        For a free base, a ball joint, an unknown name, or anything that is no number.

    Examples
    --------
    >>> import somersault as so
    >>> hanging = so.load("furrer", base="fixed")
    >>> so.swing(hanging, {"left_shoulder": 0.3}, 0.5).ended
    'duration'
    """
    props = {n: instance(f"stop {n}", s, Prop) for n, s in by_name("stops", stops).items()}
    _check(instance("model", model, Model), props)
    if number("duration", duration) <= 0:
        raise SomersaultError(f"a swing needs a duration above 0 s, and {duration:g} is none")
    if not 1e-14 <= number("accuracy", accuracy) <= 1e-2:
        raise SomersaultError(f"accuracy {accuracy:g} is out of reach; give 1e-14 to 1e-2")
    whole_number("samples", samples, 2, _MOST_SAMPLES)
    g = numbers("gravity", gravity, 3)
    q0 = pose(model, angles)
    if q0.ndim != 1:
        raise SomersaultError("angles of a swing must be one number each; swing from each pose")
    u0 = np.zeros(len(model.speeds))
    for name, rate in spread(model, by_name("rates", rates), mirrored=True).items():
        u0[model.speed_slice(name)] = number(f"rate of {name}", np.asarray(rate)[()])
    solver = Integrator(_slope(model, g, props), None if until is None else _gauge(model, until))
    times = np.linspace(0.0, duration, samples)
    start = np.concatenate([q0, u0])[None]
    solution = solver.solve(start, np.zeros((1, 0)), times, number("accuracy", accuracy))
    before = times < solution.end[0]
    states = np.concatenate([solution.states[0][before], solution.final])
    moments = np.append(times[before], solution.end)
    n = len(q0)
    ended = STATUS[float(solution.status[0])]
    return Swing(model, g, props, moments, states[:, :n], states[:, n:], ended)


def height_energy(equations: Equations, q: ArrayLike, gravity: ArrayLike = GRAVITY) -> Array:
    """Potential energy of a model with a fixed base in gravity.

    Parameters
    ----------
    equations : Equations
        Of the model.
    q : array_like, (…, coordinates)
        Joint coordinates.
    gravity : array_like, (3,)
        m/s², in the ground's axes.

    Returns
    -------
    ndarray, (…)
        J; zero with the centre of mass at the height of the ground's origin.
    """
    model = instance("equations", equations, Equations).model
    return -model.mass * centre_of_mass(model, q) @ numbers("gravity", gravity, 3)


def _check(model: Model, stops: Mapping[str, Prop]) -> None:
    if model.free:
        raise SomersaultError(
            f"{model.name} is free in the air; a swing needs something that holds it (mounted)"
        )
    ball = next((joint.name for joint in model.joints if joint.kind == "ball"), None)
    if ball is not None:
        raise SomersaultError(f"joint {ball} is a ball; a swing takes hinges and slides only")
    for name in stops:
        model.joint(name)


# ------------------------------------------------------------------------------- symbols


def _slope(model: Model, gravity: Array, stops: Mapping[str, Prop]) -> ca.Function:
    forward = Equations(model).expression("forward_dynamics").function()
    n = len(model.joints)
    x = ca.SX.sym("x", 2 * n + 1)
    q, u = x[:n], x[n : 2 * n]
    torques = ca.vertcat(
        *_stop_torques(model, stops, [q[k] for k in range(n)], [u[k] for k in range(n)])
    )
    accelerations = forward(q, u, torques, ca.DM(gravity), ca.SX(0, 1))
    return ca.Function("slope", [x], [ca.cse(ca.densify(ca.vertcat(u, accelerations)))])


def _gauge(model: Model, until: tuple[str, float]) -> ca.Function:
    if not isinstance(until, tuple | list) or len(until) != 2:
        raise SomersaultError(
            f"until must be a joint and its angle, ('bar', 1.4), not {shown(until)}"
        )
    joint, angle = until
    x = ca.SX.sym("x", 2 * len(model.joints) + 1)
    at = model.coordinate_slice(joint).start
    return ca.Function("gauge", [x], [x[at] - number("until", angle)])


def _stop_torques(
    model: Model, stops: Mapping[str, Prop], q: Sequence[Any], u: Sequence[Any]
) -> list[Any]:
    return [
        stops[joint.name].torque(q[k], u[k]) if joint.name in stops else 0.0
        for k, joint in enumerate(model.joints)
    ]
