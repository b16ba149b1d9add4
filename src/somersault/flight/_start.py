"""From a takeoff to numbers: joint coordinates, angular velocity, pretension."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from somersault._array import Array
from somersault._errors import SomersaultError
from somersault.attitude import matrix_from_quaternion, quaternion_from_angles
from somersault.flight._system import System
from somersault.flight._takeoff import JointPlan, Takeoff
from somersault.model import Model
from somersault.stability import spin


@dataclass(frozen=True)
class Start:
    """A takeoff in numbers: attitude, angular velocity (body axes), joints, springs.

    `momentum` is the angular momentum in inertial axes, (3,); all that stays the same.
    `angles` are the somersault, tilt and twist asked for, None where a quaternion was.
    """

    quaternion: Array
    omega: Array
    q: Array
    u: Array
    momentum: Array
    plans: tuple[JointPlan, ...]
    angles: Array | None


def start(system: System, takeoff: Takeoff, plans: tuple[JointPlan, ...]) -> Start:
    """Resolve attitude, spin and pretension."""
    quaternion = _quaternion(takeoff)
    to_inertial = matrix_from_quaternion(quaternion)
    q = np.array([x for plan in plans for x in plan.position])
    u = np.array([x for plan in plans for x in plan.rate])
    if takeoff.angular_velocity is not None:
        omega = np.asarray(takeoff.angular_velocity, float)
    elif takeoff.angular_momentum is not None:
        of_joints = system.equations.momentum(q, _speeds(np.zeros(3), u))[:3]
        wanted = to_inertial.T @ np.asarray(takeoff.angular_momentum, float)
        omega = np.linalg.solve(system.equations.inertia(q), wanted - of_joints)
    else:
        omega = to_inertial[1] * (takeoff.spin or 0.0)
    h = to_inertial @ system.equations.momentum(q, _speeds(omega, u))[:3]
    if any(plan.hold for plan in plans):
        plans = _pretensioned(system.model, takeoff, plans, h)
    angles = None
    if takeoff.quaternion is None:
        angles = np.array([takeoff.somersault, takeoff.tilt, takeoff.twist], float)
    return Start(quaternion, omega, q, u, h, plans, angles)


def _quaternion(takeoff: Takeoff) -> Array:
    if takeoff.quaternion is not None:
        given = np.asarray(takeoff.quaternion, float)
        given = given / np.abs(given).max()
        return given / np.linalg.norm(given)
    return quaternion_from_angles(takeoff.somersault, takeoff.tilt, takeoff.twist)


def _speeds(omega: Array, u: Array) -> Array:
    return np.concatenate([omega, np.zeros(3), u])


def _pretensioned(
    model: Model, takeoff: Takeoff, plans: tuple[JointPlan, ...], momentum: Array
) -> tuple[JointPlan, ...]:
    """Plans whose held joints have the torque that balances the nominal spin.

    That is the steady spin of the takeoff pose about its principal axis nearest 2, at the rate
    asked for, or else at the one that has this angular momentum.
    """
    angles = {name: angle for plan in plans for name, angle in _angles(plan).items()}
    nominal = spin(model, 2, angles)
    rate = takeoff.spin or float(np.linalg.norm(momentum)) / nominal.principal_inertias[1]
    if rate == 0:
        held = next(plan.joint.name for plan in plans if plan.hold)
        raise SomersaultError(f"joint {held}: hold balances a spin, and this takeoff has none")
    return tuple(
        replace(p, pretension=nominal.holding_torques[p.joint.name] * rate**2) if p.hold else p
        for p in plans
    )


def _angles(plan: JointPlan) -> dict[str, float]:
    """A joint's takeoff pose by the names that `spin` takes."""
    name = plan.joint.name
    if plan.joint.kind != "ball":
        return {name: plan.position[0]}
    w, *vector = plan.position
    length = float(np.linalg.norm(vector))
    ratio = 2.0 if length == 0 else 2 * float(np.arctan2(length, w)) / length
    return {f"{name}.{k + 1}": ratio * x for k, x in enumerate(vector)}
