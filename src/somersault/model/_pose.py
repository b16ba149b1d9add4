"""Poses given by the names of joints, and values given for both sides at once."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.checks import by_name, instance, shown, truth
from somersault._core.degrees import degrees_hint, note_degrees
from somersault._core.errors import SomersaultError
from somersault._core.numbers import floats, require_together
from somersault.model._bodies import LIMIT_SLACK, Follow, Joint
from somersault.model._mirror import sides
from somersault.model._model import Model


def pose(model: Model, angles: Mapping[str, ArrayLike] | None) -> Array:
    """Joint coordinates of a pose given by name; the rest stay as drawn.

    Parameters
    ----------
    model : Model
    angles : mapping of str to array_like, optional
        rad (m), which broadcast together. A pair's common name sets both sides, mirrored. A ball's
        `name.1`, `name.2`, `name.3` are the components of a rotation vector along its body's axes.

    Returns
    -------
    ndarray, (…, coordinates)

    Raises
    ------
    SomersaultError
        For what is no model, an unknown name, a value that is not finite, or one outside the
        joint's limits.

    Examples
    --------
    >>> import somersault as so
    >>> so.model.pose(so.load("furrer"), {"shoulder": 1.4}).tolist()
    [1.4, -1.4]
    """
    instance("model", model, Model)
    angles = {name: _numbers(name, value) for name, value in by_name("pose", angles).items()}
    given = {n: np.asarray(v) for n, v in spread(model, angles, mirrored=True).items()}
    shape = require_together({f"pose {name}": value.shape for name, value in given.items()})
    q = np.broadcast_to(model.home, (*shape, len(model.home))).copy()
    turns: dict[str, Array] = {}
    for name, value in given.items():
        joint = _owner(model, name)
        if joint.kind == "ball":
            own = turns.setdefault(joint.name, np.zeros((*shape, 3)))
            own[..., int(name[-1]) - 1] = value
        else:
            _check_limits(model, joint, value)
            q[..., model.coordinate_slice(joint.name)] = value[..., None]
    for name, turn in turns.items():
        half = np.linalg.norm(turn, axis=-1, keepdims=True) / 2
        vector = np.sinc(half / np.pi) / 2 * turn
        q[..., model.coordinate_slice(name)] = np.concatenate([np.cos(half), vector], -1)
    for joint in model.joints:
        if joint.follows is not None:
            _follow(model, joint, joint.follows, q, joint.name in given)
    return q


def _follow(model: Model, joint: Joint, follow: Follow, q: Array, named: bool) -> None:
    """Put a joint where the one that it follows has it."""
    own = model.coordinate_slice(joint.name)
    followed = follow.offset + follow.factor * q[..., model.coordinate_slice(follow.leader)]
    if named and np.abs(q[..., own] - followed).max() > LIMIT_SLACK:
        raise SomersaultError(
            f"pose {joint.name}={q[..., own].flat[0]:g}, but in {model.name} it follows "
            f"{follow.leader}, which has it at {followed.flat[0]:g}; leave it out"
        )
    q[..., own] = followed


def _numbers(name: str, value: ArrayLike) -> Array:
    numbers = floats(f"pose {name}", value)
    if not np.all(np.isfinite(numbers)):
        raise SomersaultError(f"pose {name} is {shown(value)}; angles must be finite numbers")
    return numbers


def _owner(model: Model, name: str) -> Joint:
    """The joint that a speed's name belongs to (`hip.2` belongs to the ball `hip`)."""
    if name not in model.speeds:
        joint = model.joint(name)  # raises, with the names there are, unless it is a ball
        raise SomersaultError(
            f"{joint.name} is a ball joint; give {name}.1, {name}.2 and {name}.3 in radians"
        )
    return next(j for j in model.joints if name in (j.name, *(f"{j.name}.{k}" for k in "123")))


def _check_limits(model: Model, joint: Joint, value: Array) -> None:
    if joint.limits is None:
        if joint.kind == "hinge":
            note_degrees(f"pose {joint.name}", value)
        return
    low, high = joint.limits
    out = value[(value < low - LIMIT_SLACK) | (value > high + LIMIT_SLACK)]
    if out.size:
        hint = degrees_hint(float(out.flat[0])) if joint.kind == "hinge" else ""
        raise SomersaultError(
            f"pose {joint.name}={out.flat[0]:g} is outside the joint's limits in {model.name}; "
            f"give {low:g} to {high:g}{hint}"
        )


def spread(
    model: Model, values: Mapping[str, ArrayLike], *, mirrored: bool
) -> dict[str, ArrayLike]:
    """The same values with each pair's common name replaced by its two speeds' names.

    Parameters
    ----------
    model : Model
    values : mapping of str to array_like
        By the names of joint speeds, or of pairs.
    mirrored : bool
        Whether the right side gets the sign and offset under which the pair is symmetric (a pose),
        or both the same number (a stiffness).

    Returns
    -------
    dict

    Raises
    ------
    SomersaultError
        For a joint that is given twice.
    """
    truth("mirrored", mirrored)
    result: dict[str, ArrayLike] = {}
    for name, value in by_name("what joints get", values).items():
        for speed, (factor, offset) in sides(model, name).items():
            if speed in result:
                raise SomersaultError(f"{speed} is given twice, by its own name and its pair's")
            image = mirrored and (factor, offset) != (1.0, 0.0)
            result[speed] = offset + factor * floats(name, value) if image else value
    return result
