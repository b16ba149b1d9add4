"""Where the bodies of a posed model are and how they move, for any number of samples at once.

Everything is seen from the base: the frame of a free model's base body, or the ground's where the
base is fixed. The equations of motion have their own, symbolic, outward pass (`dynamics._motion`),
over links instead of bodies; the tests hold the two against each other.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.checks import instance
from somersault._core.numbers import floats, require_together
from somersault.attitude import matrix_from_quaternion
from somersault.model._bodies import GROUND, Joint
from somersault.model._model import Model


def body_frames(model: Model, q: ArrayLike) -> tuple[Array, Array]:
    """Rotations and origins of all body frames, in the base's axes.

    Parameters
    ----------
    model : Model
    q : array_like, (…, coordinates)
        Joint coordinates (rad, m, unit quaternions), in the order of `model.coordinates`.

    Returns
    -------
    rotations : ndarray, (…, bodies, 3, 3)
        Columns are the body's axes.
    origins : ndarray, (…, bodies, 3)
        In m.

    Examples
    --------
    >>> import somersault as so
    >>> from somersault.model import body_frames
    >>> gymnast = so.load("gymnast")
    >>> rotations, origins = body_frames(gymnast, gymnast.home)
    >>> origins.shape == (len(gymnast.bodies), 3)
    True
    """
    rotations, origins, _, _ = _outward(model, q, None)
    return rotations, origins


def body_velocities(model: Model, q: ArrayLike, u: ArrayLike) -> tuple[Array, Array]:
    """Angular velocities of all bodies and velocities of their origins, with the base at rest.

    Parameters
    ----------
    model : Model
    q : array_like, (…, coordinates)
        Joint coordinates.
    u : array_like, (…, speeds)
        Joint speeds (rad/s, m/s), in the order of `model.speeds`.

    Returns
    -------
    angular, linear : ndarray, (…, bodies, 3)
        rad/s and m/s, in the base's axes. With a base that turns with ω and whose origin moves
        with v, a body at `origin` has angular + ω and linear + v + ω × origin.
    """
    _, _, angular, linear = _outward(model, q, u)
    return angular, linear


def centre_of_mass(model: Model, q: ArrayLike) -> Array:
    """The whole body's centre of mass (…, 3) in m, in the base's axes.

    Parameters
    ----------
    model : Model
    q : array_like, (…, coordinates)
        Joint coordinates.

    Returns
    -------
    ndarray, (…, 3)
        m, in the base's axes.
    """
    return _centres(model, *body_frames(model, q))[1]


def segment_momenta(model: Model, q: ArrayLike, omega: ArrayLike, u: ArrayLike) -> Array:
    """Angular momentum of each body about the whole body's centre of mass.

    Its own spin and the motion of its centre of mass: R I Rᵀ ω + m (r − r_c) × (v − v_c).

    Parameters
    ----------
    model : Model
    q : array_like, (…, coordinates)
        Joint coordinates.
    omega : array_like, (…, 3)
        Angular velocity of the base in its own axes, rad/s.
    u : array_like, (…, speeds)
        Joint speeds.

    Returns
    -------
    ndarray, (…, bodies, 3)
        kg m²/s, in the base's axes.
    """
    rotations, origins, angular, linear = _outward(model, q, u)
    base = floats("omega", omega, 3)[..., None, :]
    angular, linear = angular + base, linear + np.cross(base, origins)
    centres, whole = _centres(model, rotations, origins)
    velocities = linear + np.cross(angular, centres - origins)
    masses = np.array([body.mass for body in model.bodies])
    drift = np.einsum("b,...bi->...i", masses, velocities) / masses.sum()
    inertias = rotations @ np.array([body.inertia for body in model.bodies])
    spins = np.einsum("...bij,...bkj,...bk->...bi", inertias, rotations, angular)
    arms = centres - whole[..., None, :]
    return spins + masses[:, None] * np.cross(arms, velocities - drift[..., None, :])


def _centres(model: Model, rotations: Array, origins: Array) -> tuple[Array, Array]:
    """Centres of mass of the bodies (…, bodies, 3), and of all of them (…, 3)."""
    coms = np.array([body.com for body in model.bodies])
    masses = np.array([body.mass for body in model.bodies])
    centres = origins + np.einsum("...bij,bj->...bi", rotations, coms)
    return centres, np.einsum("b,...bi->...i", masses, centres) / masses.sum()


def _outward(model: Model, q: ArrayLike, u: ArrayLike | None) -> tuple[Array, Array, Array, Array]:
    """Rotations and origins, and from joint speeds the rates of both (zeros without)."""
    instance("model", model, Model)
    q = floats("q", q, len(model.coordinates))
    u = np.zeros(len(model.speeds)) if u is None else floats("u", u, len(model.speeds))
    require_together({"q": q.shape[:-1], "u": u.shape[:-1]})
    shape = (*q.shape[:-1], len(model.bodies))
    rotations, origins = np.empty((*shape, 3, 3)), np.empty((*shape, 3))
    angular, linear = np.zeros((*shape, 3)), np.zeros((*shape, 3))
    for index, body in enumerate(model.bodies):
        turn, at = np.array(body.rotation), np.array(body.position)
        spin = rate = np.zeros(3)
        if model.free and index == 0:  # it is the base, wherever its file has it stand
            turn, at = np.eye(3), np.zeros(3)
        if body.parent != GROUND:
            parent, foot = rotations[..., body.parent, :, :], origins[..., body.parent, :]
            arm = parent @ at
            spin = angular[..., body.parent, :]
            rate = linear[..., body.parent, :] + np.cross(spin, arm)
            turn, at = parent @ turn, foot + arm
        for joint in body.joints:
            own, shift = _displaced(joint, q[..., model.coordinate_slice(joint.name)])
            anchor = np.array(joint.anchor)
            pivot = at + _turned(turn, anchor + shift)
            turned = turn @ own
            moved = pivot - _turned(turned, anchor)
            if u is not None:
                turning, sliding = _rates(joint, u[..., model.speed_slice(joint.name)])
                rate = rate + np.cross(spin, pivot - at) + _turned(turn, sliding)
                spin = spin + _turned(turned, turning)
                rate = rate + np.cross(spin, moved - pivot)
            turn, at = turned, moved
        rotations[..., index, :, :], origins[..., index, :] = turn, at
        angular[..., index, :], linear[..., index, :] = spin, rate
    return rotations, origins, angular, linear


def _turned(rotation: Array, vector: Array) -> Array:
    return (rotation @ vector[..., None])[..., 0]


def _displaced(joint: Joint, q: Array) -> tuple[Array, Array]:
    """How a joint at its coordinates (…, 1 or 4) turns its body's axes, and shifts its anchor."""
    if joint.kind == "ball":
        return matrix_from_quaternion(q), np.zeros(3)
    axis, way = np.array(joint.axis), q - joint.reference
    if joint.kind == "slide":
        return np.eye(3), way * axis
    return matrix_from_quaternion(
        np.concatenate([np.cos(way / 2), np.sin(way / 2) * axis], -1)
    ), np.zeros(3)


def _rates(joint: Joint, u: Array) -> tuple[Array, Array]:
    """The angular velocity that a joint's speeds (…, 1 or 3) give, along the axes of its body, and
    the velocity of its anchor, along the axes before it."""
    if joint.kind == "ball":
        return u, np.zeros(3)
    along = u * np.array(joint.axis)
    return (np.zeros(3), along) if joint.kind == "slide" else (along, np.zeros(3))
