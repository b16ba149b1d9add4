"""Which joints are each other's mirror image, left and right.

A left–right pair moves together in two ways: symmetrically, as a mirror would show it, and
antisymmetrically. Spins about an axis across the plane of symmetry keep the two apart
(Playter 1994, section 4.2), which is why the linear equations are written in them.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import instance, text
from somersault.attitude import from_sequence
from somersault.model._bodies import GROUND, Joint
from somersault.model._kinematics import body_frames
from somersault.model._model import Model

_CLOSE = 1e-6  # of the body's own size


@dataclass(frozen=True)
class Pair:
    """Two mirrored joint speeds, as places in a vector of joint speeds.

    A joint in the plane of symmetry is its own image, with left == right.

    Parameters
    ----------
    name : str
        What the two are called together.
    left, right : int
    sign : int
        In the symmetric motion right = sign · left; in the antisymmetric one right = −sign · left.
        Of a joint that is its own image: +1 if a mirrored motion leaves it as it is (it moves
        symmetrically), −1 if it reverses it.
    """

    name: str
    left: int
    right: int
    sign: int


def mirror_pairs(model: Model) -> tuple[Pair, ...]:
    """The pairs of a model in the pose in which its file draws it.

    The plane is the one across a base axis that mirrors the most joints, across the axis of
    somersault (left and right) where that does not decide.

    Parameters
    ----------
    model : Model

    Returns
    -------
    tuple of Pair
        Empty if it has no symmetry.

    Examples
    --------
    >>> import somersault as so
    >>> [pair.name for pair in so.model.mirror_pairs(so.load("furrer"))]
    ['shoulder']
    """
    return _mirror_pairs(instance("model", model, Model))


@lru_cache(maxsize=64)
def _mirror_pairs(model: Model) -> tuple[Pair, ...]:
    drawn = _drawn(model)
    best: tuple[Pair, ...] = ()
    for axis in model.axes:
        pairs = _pairs(model, drawn, axis - 1)
        if sum(p.left != p.right for p in pairs) > sum(p.left != p.right for p in best):
            best = pairs
    return best


def named_pairs(model: Model) -> dict[str, Pair]:
    """The left–right pairs by the name that they share.

    Parameters
    ----------
    model : Model

    Returns
    -------
    dict of str to Pair
    """
    return {pair.name: pair for pair in mirror_pairs(model) if pair.left != pair.right}


def reflection(model: Model, pair: Pair) -> tuple[float, float]:
    """What makes the left side's angle the right side's, about the poses in which the file draws
    them, which are each other's image.

    Parameters
    ----------
    model : Model
    pair : Pair

    Returns
    -------
    factor, offset : float
        right = offset + factor · left; the factor turns rates over.
    """
    instance("model", model, Model)
    instance("pair", pair, Pair)
    references = {joint.name: joint.reference for joint in model.joints if joint.kind != "ball"}
    left, right = (references.get(model.speeds[k], 0.0) for k in (pair.left, pair.right))
    return float(pair.sign), right - pair.sign * left


def sides(model: Model, name: str) -> dict[str, tuple[float, float]]:
    """The joint of a name, or both of the pair that is called by it.

    Parameters
    ----------
    model : Model
    name : str

    Returns
    -------
    dict of str to (float, float)
        For each joint the factor and the offset that make its angle of the first one's.
    """
    pair = named_pairs(model).get(text("name", name))
    if pair is None or name in model.speeds:
        return {name: (1.0, 0.0)}
    left, right = (model.speeds[k] for k in (pair.left, pair.right))
    return {left: (1.0, 0.0), right: reflection(model, pair)}


def mirror_images(model: Model) -> dict[str, tuple[str, float, float]]:
    """Each hinge's and slide's mirror image.

    Parameters
    ----------
    model : Model

    Returns
    -------
    dict of str to (str, float, float)
        Its name, and the factor and the offset that make its angle of this joint's.
    """
    pairs = mirror_pairs(model)
    joints = {joint.name for joint in model.joints if joint.kind != "ball"}
    images = {}
    for pair in pairs:
        left, right = model.speeds[pair.left], model.speeds[pair.right]
        if left in joints:
            factor, offset = reflection(model, pair)
            images[left] = (right, factor, offset)
            images[right] = (left, factor, -factor * offset)
    return images


@dataclass(frozen=True)
class _Drawn:
    """A body as the file draws it, in the base's axes: frame, centre of mass and inertia."""

    rotation: Array
    position: Array
    com: Array
    inertia: Array


def _drawn(model: Model) -> list[_Drawn]:
    drawn = [(1.0, 0.0, 0.0, 0.0) if j.kind == "ball" else (j.reference,) for j in model.joints]
    rotations, origins = body_frames(model, [x for joint in drawn for x in joint])
    return [
        _Drawn(
            rotation,
            origin,
            origin + rotation @ np.array(body.com),
            rotation @ np.array(body.inertia) @ rotation.T,
        )
        for body, rotation, origin in zip(model.bodies, rotations, origins, strict=True)
    ]


def _pairs(model: Model, drawn: list[_Drawn], normal: int) -> tuple[Pair, ...]:
    mirror = np.eye(3)
    mirror[normal, normal] = -1.0
    alone = sum(body.parent == GROUND for body in model.bodies) == 1
    origin = drawn[0].com if alone else np.zeros(3)  # of a trunk, or of what limbs are clamped to
    size = float(max(np.linalg.norm(d.com - origin) for d in drawn)) + 1e-3
    images: dict[int, int] = {GROUND: GROUND}
    for index, body in enumerate(model.bodies):
        for other in range(len(model.bodies)):
            if (
                images.get(body.parent, -2) == model.bodies[other].parent
                and other not in images.values()
                and _alike(model, drawn, index, other, mirror, origin, size)
            ):
                images[index] = other
                break
    pairs: list[Pair] = []
    for index, other in images.items():
        if index == GROUND or other < index:
            continue
        for joint, image in zip(
            model.bodies[index].joints, model.bodies[other].joints, strict=True
        ):
            pairs += _speed_pairs(model, drawn, index, other, joint, image, mirror, normal)
    return tuple(pairs)


def _alike(
    model: Model,
    drawn: list[_Drawn],
    index: int,
    other: int,
    mirror: Array,
    origin: Array,
    size: float,
) -> bool:
    """Whether a body and its joints are the image of another."""
    a, b = drawn[index], drawn[other]
    one, two = model.bodies[index], model.bodies[other]
    inertia = max(np.abs(a.inertia).max(), one.mass * size**2 * 1e-3)
    if (
        abs(one.mass - two.mass) > _CLOSE * one.mass
        or np.linalg.norm(origin + mirror @ (a.com - origin) - b.com) > _CLOSE * size
        or np.abs(mirror @ a.inertia @ mirror - b.inertia).max() > _CLOSE * inertia
        or [j.kind for j in one.joints] != [j.kind for j in two.joints]
    ):
        return False
    for joint, image in zip(one.joints, two.joints, strict=True):
        if _sign(a, b, joint, image, mirror) is None:
            return False
        gap = (
            origin
            + mirror @ (a.position + a.rotation @ np.array(joint.anchor) - origin)
            - (b.position + b.rotation @ np.array(image.anchor))
        )
        if joint.kind == "hinge":  # anywhere along its own axis it is the same hinge
            along = b.rotation @ np.array(image.axis)
            gap = gap - along * (along @ gap)
        if joint.kind != "slide" and np.linalg.norm(gap) > _CLOSE * size:
            return False
    return True


def _sign(a: _Drawn, b: _Drawn, joint: Joint, image: Joint, mirror: Array) -> Array | None:
    """For each of a joint's speeds, ±1 between it and its image; None if it is no image."""
    turned = mirror if joint.kind == "slide" else -mirror  # rotations are pseudo-vectors
    if joint.kind == "ball":
        map_ = b.rotation.T @ turned @ a.rotation
        signs = np.diag(map_)
        return signs.round() if np.abs(map_ - np.diag(signs.round())).max() < _CLOSE else None
    across = (b.rotation @ np.array(image.axis)) @ turned @ (a.rotation @ np.array(joint.axis))
    return np.array([np.round(across)]) if abs(abs(across) - 1) < _CLOSE else None


def _speed_pairs(
    model: Model,
    drawn: list[_Drawn],
    index: int,
    other: int,
    joint: Joint,
    image: Joint,
    mirror: Array,
    normal: int,
) -> list[Pair]:
    signs = _sign(drawn[index], drawn[other], joint, image, mirror)
    assert signs is not None
    first, second = joint, image
    left = np.zeros(3)
    left[normal] = from_sequence((1, 1, 1), model.axes)[normal]
    if index != other and _is_right(joint, image, drawn[index], drawn[other], left):
        first, second = image, joint
    one, two = model.speed_slice(first.name), model.speed_slice(second.name)
    name = common_name(first.name, second.name)
    return [
        Pair(
            name if joint.kind != "ball" else f"{name}.{k + 1}",
            one.start + k,
            two.start + k,
            int(sign),
        )
        for k, sign in enumerate(signs)
    ]


def _is_right(joint: Joint, image: Joint, a: _Drawn, b: _Drawn, left: Array) -> bool:
    for this, that, answer in ((joint, image, True), (image, joint, False)):
        if _side(this.name) == "right" or _side(that.name) == "left":
            return answer
    return bool(a.com @ left < b.com @ left)


_SIDE = re.compile(
    r"(?<![A-Za-z])(left|right|l|r)(?![A-Za-z])|(Left|Right)|(?<![A-Za-z])([LR])(?=[A-Z_])",
    re.VERBOSE,
)


def _side(name: str) -> str | None:
    found = _SIDE.search(name)
    if found is None:
        return None
    return "left" if found.group(0).lower().startswith("l") else "right"


def common_name(left: str, right: str) -> str:
    """The part of their names that two mirrored joints share.

    Parameters
    ----------
    left, right : str

    Returns
    -------
    str
        Of left_shoulder and right_shoulder "shoulder"; both names, joined by a plus sign, where
        they share nothing.
    """
    left, right = text("left", left), text("right", right)
    if left == right:
        return left
    one, two = (re.sub(r"[_\-. ]{2,}", "_", _SIDE.sub("", n, count=1)) for n in (left, right))
    one, two = one.strip("_-. "), two.strip("_-. ")
    return one if one == two and one else f"{left}+{right}"
