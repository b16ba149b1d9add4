"""From takeoffs to numbers: joint coordinates, angular velocity, pretension."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.attitude import (
    angles_from_quaternion,
    body_rates,
    matrix_from_quaternion,
    quaternion_from_angles,
)
from somersault.flight._plane import kept, turning
from somersault.flight._system import System
from somersault.flight._takeoff import Takeoff
from somersault.flight.behaviours import (
    NON_DIMENSIONAL,
    JointPlan,
    Sprung,
    begin,
    side_by_side,
)
from somersault.model import Model
from somersault.simulation import Name, Numbers
from somersault.stability import holding_torques


@dataclass(frozen=True, eq=False)
class Starts:
    """N takeoffs in numbers.

    `quaternion` (N, 4), `omega` (N, 3) in body axes, `q` (N, coordinates), `u` (N, speeds),
    `angles` (N, 3): somersault, tilt and twist in the representation asked for. `values` are the
    numbers with the pretension of held joints, `bodies` (N, …) those of the bodies.
    """

    quaternion: Array
    omega: Array
    q: Array
    u: Array
    angles: Array
    values: Numbers
    bodies: Array


@dataclass(frozen=True, eq=False)
class Start:
    """One takeoff in numbers: as `Starts`, without its first dimension.

    `momentum` is the angular momentum in inertial axes, (3,). `plans` have the pretension of held
    joints.
    """

    quaternion: Array
    omega: Array
    q: Array
    u: Array
    momentum: Array
    angles: Array
    plans: tuple[JointPlan, ...]


def start(system: System, takeoff: Takeoff, plans: tuple[JointPlan, ...], one: Starts) -> Start:
    """One takeoff, of the only one there is; SomersaultError for a joint held against no spin."""
    h = momentum(system, one)[0]
    held = []
    for plan in plans:
        does = plan.does
        if isinstance(does, Sprung) and does.hold:
            if takeoff.spin is None and not np.any(h):
                raise SomersaultError(
                    f"joint {plan.joint.name}: hold balances a spin, and this takeoff has none"
                )
            pretension = np.ravel(one.values["pretension", plan.joint.name])[0]
            does = replace(does, pretension=float(pretension))
        held.append(replace(plan, does=does))
    settled = in_si(tuple(held), one.values)
    return Start(
        one.quaternion[0], one.omega[0], one.q[0], one.u[0], h, one.angles[0], settled
    )  # fmt: skip


def in_si(plans: tuple[JointPlan, ...], values: Numbers) -> tuple[JointPlan, ...]:
    """What joints do in one flight, with springs and dampers in SI units."""
    result = []
    for plan in plans:
        does = plan.does
        if isinstance(does, Sprung):
            name = plan.joint.name
            k, b = (float(np.ravel(values[what, name])[0]) for what in ("stiffness", "damping"))
            does = replace(does, stiffness=k, damping=b, K=None, B=None)
        result.append(replace(plan, does=does))
    return tuple(result)


def starts(
    system: System, takeoff: Takeoff, plans: tuple[JointPlan, ...], values: Numbers, count: int
) -> Starts:
    """Attitude, spin and pretension of `count` flights whose numbers are `values`."""
    quaternion, angles = _attitude(takeoff, values, count, system.model)
    q, u = begin(plans, values, count)
    bodies = side_by_side(values, [(name,) for name in system.bodies], count)
    if ("angular_velocity", 1) in values:
        omega = side_by_side(values, [("angular_velocity", k) for k in (1, 2, 3)], count)
        omega = kept(system.model, omega)
    elif ("angular_momentum", 1) in values:
        of_joints = system.equations.momentum(q, _speeds(np.zeros((count, 3)), u), bodies)[:, :3]
        h = side_by_side(values, [("angular_momentum", k) for k in (1, 2, 3)], count)
        to_body = np.swapaxes(matrix_from_quaternion(quaternion), 1, 2)
        wanted = _turned(to_body, h) - of_joints
        ways = turning(system.model)
        inertia = system.equations.inertia(q, bodies)[:, ways][:, :, ways]
        omega = np.zeros((count, 3))
        omega[:, ways] = np.linalg.solve(inertia, wanted[:, ways, None])[..., 0]
    else:
        names: list[Name] = [("takeoff", n) for n in ("spin", "tilt_rate", "twist_rate")]
        rates = side_by_side(values, names, count)
        omega = body_rates(angles, rates, system.model.axes)
    begun = Starts(quaternion, omega, q, u, angles, values, bodies)
    return replace(begun, values=_with_springs(system, takeoff, plans, begun))


def momentum(system: System, begun: Starts) -> Array:
    """Angular momentum at takeoff in inertial axes, (N, 3): what of it is kept in flight."""
    h = system.equations.momentum(begun.q, _speeds(begun.omega, begun.u), begun.bodies)[:, :3]
    return kept(system.model, _turned(matrix_from_quaternion(begun.quaternion), h))


def _attitude(takeoff: Takeoff, values: Numbers, count: int, model: Model) -> tuple[Array, Array]:
    axes = model.axes
    if takeoff.quaternion is None:
        names: list[Name] = [("takeoff", n) for n in ("somersault", "tilt", "twist")]
        somersault, tilt, twist = (values[name] for name in names)
        quaternion = quaternion_from_angles(somersault, tilt, twist, axes)
        return np.broadcast_to(quaternion, (count, 4)), side_by_side(values, names, count)
    given = np.asarray(takeoff.quaternion, float)
    given = given / np.abs(given).max()
    given[1:] = kept(model, given[1:])
    given = given / np.linalg.norm(given)
    return np.tile(given, (count, 1)), np.tile(angles_from_quaternion(given, axes), (count, 1))


def _turned(matrix: Array, vector: Array) -> Array:
    """matrix (N, 3, 3) times vector (N, 3), in one order of adding."""
    return (
        matrix[..., 0] * vector[:, None, 0]
        + matrix[..., 1] * vector[:, None, 1]
        + matrix[..., 2] * vector[:, None, 2]
    )


def _speeds(omega: Array, u: Array) -> Array:
    return np.concatenate([omega, np.zeros_like(omega), u], 1)


def _with_springs(
    system: System, takeoff: Takeoff, plans: tuple[JointPlan, ...], begun: Starts
) -> Numbers:
    """The numbers with what the nominal spin of each flight decides.

    Springs and dampers that are given without dimension are added in SI units, and to the
    pretension of held joints the torque that balances the spin. That is the steady spin of the
    takeoff pose about its principal axis nearest that of somersault, at the rate asked for, or else
    at the one that has this angular momentum.
    """
    values, model = begun.values, system.model
    held = [p.joint.name for p in plans if isinstance(p.does, Sprung) and p.does.hold]
    scaled = [name for name in values if name[0] in NON_DIMENSIONAL]
    if not held and not scaled:
        return values
    inertia = torques = np.empty(0)
    if held or takeoff.spin is None:
        inertia, torques = _steady(system, begun)
    if takeoff.spin is not None:
        rate = np.asarray(values["takeoff", "spin"])
    else:
        h = momentum(system, begun)
        rate = np.sqrt(h[:, 0] ** 2 + h[:, 1] ** 2 + h[:, 2] ** 2) / inertia
    more: dict[Name, Array] = {}
    if scaled:
        outboard = system.equations.outboard_inertia(begun.q, begun.bodies)
        for what, name in scaled:
            in_si, power = NON_DIMENSIONAL[str(what)]
            unit = np.abs(rate) ** power * outboard[:, model.speed_slice(str(name)).start]
            more[in_si, name] = np.asarray(values[what, name]) * unit
    for name in held:
        own = torques[:, model.speed_slice(name).start] * rate**2
        more["pretension", name] = own + np.asarray(values["pretension", name])
    return {**values, **more}


def _steady(system: System, begun: Starts) -> tuple[Array, Array]:
    """Inertias and holding torques over Ω² of the steady spins in the poses of the flights."""
    values, q, bodies = begun.values, begun.q, begun.bodies
    shaped = [k for k in values if k[0] in ("angle", "times", "angles") or k[0] in system.bodies]
    if any(isinstance(values[k], np.ndarray) for k in shaped):
        both = np.concatenate([q, bodies], 1)
        fresh = np.append(True, np.any(both[1:] != both[:-1], 1))  # many in a row may be alike
        inertia, torques = holding_torques(
            system.model, q[fresh], system.bodies, bodies[fresh], compiled=True
        )
        same = np.cumsum(fresh) - 1
        return inertia[same], torques[same]
    return holding_torques(system.model, q[:1], system.bodies, bodies[:1], compiled=False)
