"""From a takeoff to numbers: joint coordinates, angular velocity, pretension."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from somersault._array import Array
from somersault._errors import SomersaultError
from somersault.attitude import matrix_from_quaternion, quaternion_from_angles
from somersault.flight._system import System
from somersault.flight._takeoff import JointPlan, Takeoff
from somersault.stability import Spin


@dataclass(frozen=True)
class Start:
    """A takeoff in numbers: attitude, angular velocity (body axes), joints, springs.

    `momentum` is the angular momentum in inertial axes, (3,); all that stays the same.
    """

    quaternion: Array
    omega: Array
    q: Array
    u: Array
    momentum: Array
    plans: tuple[JointPlan, ...]


def start(system: System, takeoff: Takeoff, plans: tuple[JointPlan, ...], nominal: Spin) -> Start:
    """Resolve attitude, spin and pretension; `nominal` is the steady spin of the takeoff pose."""
    quaternion = _quaternion(takeoff)
    to_inertial = matrix_from_quaternion(quaternion)
    q = np.array([x for plan in plans for x in plan.position])
    u = np.array([x for plan in plans for x in _rates(plan)])
    inertia = system.equations.inertia(q)
    if takeoff.angular_velocity is not None:
        omega = np.asarray(takeoff.angular_velocity, float)
    else:
        wanted = _momentum(takeoff, nominal)
        of_joints = system.equations.momentum(q, _speeds(np.zeros(3), u))[:3]
        omega = np.linalg.solve(inertia, to_inertial.T @ wanted - of_joints)
    h = to_inertial @ system.equations.momentum(q, _speeds(omega, u))[:3]
    rate = _nominal_rate(takeoff, nominal, h)
    return Start(quaternion, omega, q, u, h, tuple(_pretensioned(p, nominal, rate) for p in plans))


def _quaternion(takeoff: Takeoff) -> Array:
    if takeoff.quaternion is not None:
        given = np.asarray(takeoff.quaternion, float)
        return given / np.linalg.norm(given)
    return quaternion_from_angles(takeoff.somersault, takeoff.tilt, takeoff.twist)


def _rates(plan: JointPlan) -> list[float]:
    return [0.0, 0.0, 0.0] if plan.joint.kind == "ball" else [plan.rate]


def _speeds(omega: Array, u: Array) -> Array:
    return np.concatenate([omega, np.zeros(3), u])


def _momentum(takeoff: Takeoff, nominal: Spin) -> Array:
    if takeoff.angular_momentum is not None:
        return np.asarray(takeoff.angular_momentum, float)
    along = np.array([0.0, 1.0, 0.0])
    return (takeoff.spin or 0.0) * nominal.principal_inertias[1] * along


def _nominal_rate(takeoff: Takeoff, nominal: Spin, momentum: Array) -> float:
    """Rate of the steady spin that springs are pretensioned for."""
    if takeoff.spin is not None:
        return takeoff.spin
    return float(np.linalg.norm(momentum) / nominal.principal_inertias[1])


def _pretensioned(plan: JointPlan, nominal: Spin, rate: float) -> JointPlan:
    if not plan.hold:
        return plan
    if rate == 0:
        raise SomersaultError(
            f"joint {plan.joint.name}: hold balances a spin, and this takeoff has none"
        )
    torque = nominal.holding_torques[plan.joint.name] * rate**2
    return replace(plan, rest=plan.position[0] + torque / plan.stiffness)
