"""The principal axes of the posed body along a flight, and their attitude.

Joints that move turn the principal axes within the body, and it is these that somersault, tilt and
twist as the axes of a rigid body do: between moves of the joints they follow the map of rigid
rotation (Playter 1994, sections 2.5 and 4.4.1).
"""

from __future__ import annotations

import numpy as np

from somersault import rigid
from somersault._core.array import Array
from somersault._core.checks import instance
from somersault._core.errors import SomersaultError
from somersault.attitude import (
    in_sequence,
    matrix_from_quaternion,
    quaternion_from_matrix,
    side,
)
from somersault.flight._flight import Flight
from somersault.stability import PrincipalAxes, principal_axes


def principal_axes_along(flight: Flight) -> PrincipalAxes:
    """Principal inertias and axes of the posed body at each sample.

    Parameters
    ----------
    flight : Flight

    Returns
    -------
    PrincipalAxes
        `inertias` (time, 3), kg m², and `axes` (time, 3, 3), columns in the base's axes, each
        matched to the body axis it lies nearest.

    Examples
    --------
    >>> import somersault as so
    >>> from somersault.flight import principal_axes_along
    >>> flight = so.inertia_change(poses=("layout", "tuck")).fly()
    >>> layout, tuck = principal_axes_along(flight).inertias[[0, -1], 1]
    >>> bool(layout > 2 * tuck)
    True
    """
    instance("flight", flight, Flight)
    return principal_axes(flight.system.equations.inertia(flight.joint_coordinates))


def principal_attitude(flight: Flight) -> tuple[Array, Array]:
    """Tilt and twist of the principal axes about the angular momentum.

    They are latitude and longitude, with their signs changed, of the angular momentum in the
    principal axes (figure 2-8 of Playter 1994). With angular momentum along the inertial axis of
    somersault, either way, they are the tilt and twist of a rigid body in the principal axes.

    Parameters
    ----------
    flight : Flight

    Returns
    -------
    tilt, twist : numpy.ndarray, shape (time,)
        rad; twist in (−π, π].

    Raises
    ------
    SomersaultError
        For a flight without angular momentum.

    Examples
    --------
    >>> import numpy as np
    >>> import somersault as so
    >>> from somersault.flight import principal_attitude
    >>> tilt, twist = principal_attitude(so.arm_tilt(twists=None, duration=0.3).fly())
    >>> abs(np.degrees(tilt[[0, -1]])).round(1).tolist()
    [0.0, 9.4]
    """
    h = instance("flight", flight, Flight).start.momentum
    size = float(np.linalg.norm(h))
    if size == 0:
        raise SomersaultError(
            "without angular momentum there is nothing to measure tilt and twist about; use the "
            "body's own, flight.dataset.tilt and .twist"
        )
    turn = matrix_from_quaternion(flight.base_quaternion)
    axes = flight.model.axes
    sense = -1.0 if h[axes[0] - 1] < 0 else 1.0
    frame = turn @ principal_axes_along(flight).axes
    cosines = np.einsum("tij,i->tj", frame, sense * h / size)
    return rigid.tilt_and_twist(side(axes) * np.stack(in_sequence(cosines.T, axes), -1))


def rigid_continuation(flight: Flight) -> rigid.RigidMotion:
    """How the body would fly on from a flight's last sample with its joints held.

    Parameters
    ----------
    flight : Flight

    Returns
    -------
    rigid.RigidMotion
        The exact motion of the principal axes of the pose it ends in; its time begins there.

    Examples
    --------
    >>> import somersault as so
    >>> from somersault.flight import rigid_continuation
    >>> tilted = so.arm_tilt(twists=None, duration=0.3).fly()
    >>> rigid_continuation(tilted).monotonic_twist
    True
    """
    about = principal_axes_along(flight)
    turn = matrix_from_quaternion(flight.base_quaternion[-1]) @ about.axes[-1]
    return rigid.RigidMotion(
        about.inertias[-1],
        flight.angular_velocity[-1] @ about.axes[-1],
        quaternion_from_matrix(turn),
    )
