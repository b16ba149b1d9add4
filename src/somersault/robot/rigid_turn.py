"""To where a rigid body in the air turns, as its controller foresees it: Euler's equations.

Plain functions of what is sensed. The angular momentum h stays what it is in the axes of the
course, and the body turns at I⁻¹ Cᵀ h in its own: a few steps of Runge and Kutta.
"""

from __future__ import annotations

from typing import Any

import casadi as ca

from somersault.robot._expressions import rotation

_STEPS = 10  # for all of a flight, errors of some hundredths of a radian; less the nearer its end


def facing(attitude: Any) -> Any:
    """The heading of a body, by the part of its turn that is about the vertical, rad."""
    return ca.atan2(attitude[1, 0] - attitude[0, 1], attitude[0, 0] + attitude[1, 1])


def turned(attitude: Any, momentum: Any, inertias: Any, time: Any) -> Any:
    """The attitude after a time.

    Parameters
    ----------
    attitude : matrix
        From the body's axes to those of the course.
    momentum : vector of 3
        kg m²/s, in the axes of the course.
    inertias : vector of 3
        About the body's axes, kg m².
    time : float
        s.

    Returns
    -------
    matrix

    Examples
    --------
    >>> import casadi as ca
    >>> from somersault.robot.rigid_turn import facing, turned
    >>> then = turned(ca.SX.eye(3), ca.DM([0.0, 0.0, 2.0]), ca.DM([3.0, 3.0, 1.0]), 0.5)
    >>> round(float(facing(then)), 5)
    1.0
    """
    here = attitude.T @ momentum
    q = ca.vertcat(1.0, 0.0, 0.0, 0.0)  # since now
    step = time / _STEPS
    for _ in range(_STEPS):
        k1 = _rate(q, here, inertias)
        k2 = _rate(q + step / 2 * k1, here, inertias)
        k3 = _rate(q + step / 2 * k2, here, inertias)
        k4 = _rate(q + step * k3, here, inertias)
        q = q + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return attitude @ rotation(q / ca.sqrt(ca.dot(q, q)))


def _rate(q: Any, momentum: Any, inertias: Any) -> Any:
    """Of the quaternion since now, with momentum in the axes that the body has now."""
    w = (rotation(q).T @ momentum) / inertias
    s, v = q[0], q[1:4]
    return ca.vertcat(-ca.dot(v, w), s * w + ca.cross(v, w)) / 2
