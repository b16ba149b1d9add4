"""A body swung by what holds it, as round a bar, until it is let go and flies.

The swing is of a model with a fixed base (`model._mounted`); letting go changes no position and
no velocity, so `released` reads the takeoff of the free model off the last moment of the swing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.checks import by_name, instance, shown, whole_number
from somersault._core.errors import SomersaultError
from somersault._core.notes import note
from somersault._core.numbers import number, numbers
from somersault.dynamics import Equations
from somersault.engine import STATUS
from somersault.flight._broken import BROKEN
from somersault.flight._course import Course
from somersault.flight._held import held_system
from somersault.flight._plans import by_joint, plans
from somersault.flight._plans import numbers as numbers_of
from somersault.flight._prop import Prop
from somersault.flight._start import Starts
from somersault.flight._takeoff import Takeoff
from somersault.flight.behaviours import JointPlan, JointTakeoff, Sprung, begin, kinds
from somersault.history import summary
from somersault.laws import seeds
from somersault.model import Model, as_vector, centre_of_mass, pose, spread
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
    joint_torques : ndarray, (T, joints)
        What acts at the joints, by springs, dampers, muscles and stops, N m (N for a slide): the
        inverse dynamics of the swing.
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
    joint_torques: Array
    ended: str
    plans: tuple[JointPlan, ...]

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
        given = np.zeros(self.q.shape)
        for name, stop in self.stops.items():
            k = self.model.coordinate_slice(name).start
            given[:, k] = [stop.torque(q, u) for q, u in zip(*self._states(k), strict=True)]
        return given

    def _states(self, k: int) -> tuple[list[float], list[float]]:
        return self.q[:, k].tolist(), self.u[:, k].tolist()

    @cached_property
    def spring_torques(self) -> Array:
        """What springs give at joints that have no path, (T, joints), N m (N for a slide)."""
        sprung = [p.does if isinstance(p.does, Sprung) else Sprung() for p in self.plans]
        k, rest = (
            np.array([getattr(does, name) or 0.0 for does in sprung])
            for name in ("stiffness", "rest")
        )
        return -k * (self.q - rest)

    @cached_property
    def spring_energy(self) -> Array:
        """What the springs hold, (T,), J."""
        energies = [
            np.broadcast_to(plan.does.energy(plan.joint, self.q[:, k : k + 1]), len(self.q))
            for k, plan in enumerate(self.plans)
        ]
        return np.asarray(np.sum(energies, 0))

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
        spring = self.spring_energy
        along, joule = ("time", "joint"), {"units": "J"}
        return xr.Dataset(
            {
                "angle": (along, self.q, {"units": "rad or m"}),
                "rate": (along, self.u, {"units": "rad/s or m/s"}),
                "stop_torque": (along, self.stop_torques, {"units": "N m or N"}),
                "spring_torque": (along, self.spring_torques, {"units": "N m or N"}),
                "joint_torque": (along, self.joint_torques, {"units": "N m or N"}),
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


def swing(
    model: Model,
    angles: Mapping[str, float],
    duration: float,
    *,
    rates: Mapping[str, float] | None = None,
    joints: Mapping[str, JointTakeoff] | None = None,
    gravity: Sequence[float] = GRAVITY,
    until: tuple[str, float] | None = None,
    stops: Mapping[str, Prop] | None = None,
    noise: float = 0.0,
    samples: int = 401,
    accuracy: float = 1e-10,
) -> Swing:
    """The swing of a model with a fixed base.

    Parameters
    ----------
    model : Model
        With a fixed base, such as a `mounted` one; its joints are hinges and slides.
    angles, rates : mapping of str to float
        At the start, by joint, rad and rad/s; a joint that is not named is at its reference, at
        rest.
    joints : mapping of str to JointTakeoff, optional
        What joints do that do not just swing with their springs and dampers: they may go along
        paths, be driven by torques, or follow laws of what is sensed of other joints. Their angles
        and rates stand here.
    duration : float
        s.
    gravity : sequence of float, (3,)
        m/s², along the ground's axes.
    until : (str, float), optional
        A joint and the angle (rad) at which the swing ends, found to rounding.
    stops : mapping of str to Prop, optional
        Props by joint.
    noise : float
        Which deviates there are where laws sense with noise, as in `Takeoff`.
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
        For a free base, a ball joint, an unknown name, joints none of which moves by itself, or
        anything that is no number.

    Examples
    --------
    >>> import somersault as so
    >>> hanging = so.load("furrer", base="fixed")
    >>> so.swing(hanging, {"left_shoulder": 0.3}, 0.5).ended
    'duration'
    >>> raised = so.JointTakeoff.prescribed(times=[0.0, 0.4], angles=[0.0, 1.2])
    >>> swung = so.swing(hanging, {}, 0.5, joints={"left_shoulder": raised})
    >>> round(float(swung.q[-1, 0]), 6)
    1.2
    """
    props = {n: instance(f"stop {n}", s, Prop) for n, s in by_name("stops", stops).items()}
    _check(instance("model", model, Model), props)
    if number("duration", duration) <= 0:
        raise SomersaultError(f"a swing needs a duration above 0 s, and {duration:g} is none")
    if not 1e-14 <= number("accuracy", accuracy) <= 1e-2:
        raise SomersaultError(f"accuracy {accuracy:g} is out of reach; give 1e-14 to 1e-2")
    whole_number("samples", samples, 2, _MOST_SAMPLES)
    g = numbers("gravity", gravity, 3)
    settled = _settled(model, angles, by_name("rates", rates), by_name("joints", joints))
    if not any(plan.does.in_state for plan in settled):
        raise SomersaultError("no joint of this swing moves by itself; leave one of them free")
    system = held_system(
        model, kinds(settled), as_vector(g), tuple(props.items()), _until(model, until)
    )
    values = numbers_of(Takeoff(noise=noise), settled)
    q, u = begin(settled, values, 1)
    nowhere = np.zeros((1, 3))
    begun = Starts(np.zeros((1, 4)), nowhere, q, u, nowhere, values, np.empty((1, 0)))
    course = Course(system, settled, begun, duration)
    times = np.linspace(0.0, duration, samples)
    sensed = nowhere
    if system.layout.noise:
        sensed = np.concatenate([nowhere, seeds(np.reshape(values["takeoff", "noise"], 1))], 1)
    start = system.start(begun.quaternion, begun.omega, q, u, sensed)
    solution = course.solve(start, times, number("accuracy", accuracy))
    before = times < solution.end[0]
    states = np.concatenate([solution.states[0][before], solution.final])
    moments = np.append(times[before], solution.end)
    parameters = course.parameters(moments[None], states[None])[0]
    _, coordinates, speeds = system.read(states, moments, parameters)
    acting = system.loads(np.concatenate([states, moments[:, None], parameters], 1))[:, 6:]
    ended = STATUS[float(solution.status[0])]
    if ended in BROKEN:
        note(
            f"the swing broke off after {moments[-1]:.4g} s: {ended}; a spring, damper, move or "
            "law is too stiff or fast, or gives no number"
        )
    return Swing(model, g, props, moments, coordinates, speeds, acting, ended, settled)


def _settled(
    model: Model, angles: Mapping[str, float], rates: Mapping[str, float],
    joints: Mapping[str, JointTakeoff],
) -> tuple[JointPlan, ...]:  # fmt: skip
    """What each joint does."""
    for name, one in joints.items():
        instance(f"joint {name}", one, JointTakeoff)
    given = by_joint(model, joints)
    for what, at_start in (("angle", angles), ("rate", rates)):
        for name in spread(model, by_name(f"{what}s", at_start), mirrored=True):
            if name in given:
                raise SomersaultError(
                    f"joint {name} is told what to do, so its {what} at the start stands there; "
                    f"leave it out of {what}s"
                )
    q0 = pose(model, angles)
    if q0.ndim != 1:
        raise SomersaultError("angles of a swing must be one number each; swing from each pose")
    u0 = np.zeros(len(model.speeds))
    for name, rate in spread(model, rates, mirrored=True).items():
        u0[model.speed_slice(name)] = number(f"rate of {name}", np.asarray(rate)[()])
    for joint, angle, rate in zip(model.joints, q0.tolist(), u0.tolist(), strict=True):
        if joint.name not in given and joint.follows is None:
            kind = "sprung" if joint.stiffness else "free"
            given[joint.name] = JointTakeoff(kind, angle=angle, rate=rate)
    settled = plans(model, Takeoff(joints=given))
    held = [p.joint.name for p in settled if isinstance(p.does, Sprung) and p.does.hold]
    if held:
        raise SomersaultError(f"joint {held[0]}: hold balances a spin, and a swing has none")
    return settled


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


def _until(model: Model, until: tuple[str, float] | None) -> tuple[str, float] | None:
    if until is None:
        return None
    if not isinstance(until, tuple | list) or len(until) != 2:
        raise SomersaultError(
            f"until must be a joint and its angle, ('bar', 1.4), not {shown(until)}"
        )
    joint, angle = until
    return model.joint(joint).name, number("until", angle)
