"""A body that moves alike on both sides, seen from the side: two limbs are one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.checks import instance
from somersault._core.errors import SomersaultError
from somersault.model._bodies import GROUND, Body, Follow, Joint
from somersault.model._kinematics import body_frames
from somersault.model._mirror import common_name, mirror_pairs
from somersault.model._model import Model
from somersault.model._pose import pose
from somersault.model._vectors import IDENTITY, ZERO, as_matrix, as_vector
from somersault.model._weld import merge_welded

_PARALLEL = 1e-6  # of the sine between a hinge and the normal of the plane
_ALIKE = 1e-6  # of a body's inertia: products of inertia, and what its place makes
_ONE_LINE = 1e-6  # m between the hinges of the two sides, seen from the side


def sagittal(model: Model, angles: Mapping[str, ArrayLike] | None = None) -> Model:
    """A free body of two like sides that move together, in its plane of symmetry.

    Joints of a left and a right side become one, with the springs and dampers of both, called as
    the two are together; so do the limbs that they move. What turns about no axis across the plane
    is held in a pose: an athlete's shoulders too, if abducted. The plane is that across the axis of
    somersault.

    Parameters
    ----------
    model : Model
        Free in the air.
    angles : mapping of str to float, optional
        The pose, by joint (rad, m); a joint that is not named stays as drawn. The new model is
        drawn in this pose, with the axes of all bodies along those of the base.

    Returns
    -------
    Model
        Planar.

    Raises
    ------
    SomersaultError
        For a fixed base, a pose that is none, or two sides that are not alike in it.

    Examples
    --------
    >>> import somersault as so
    >>> tumbler = so.sagittal(so.athlete(1.67, 64, knees=True), {"hip_flexion": 0.5})
    >>> [joint.name for joint in tumbler.joints]
    ['shoulder_flexion', 'hip_flexion', 'knee']
    """
    if not instance("model", model, Model).free:
        raise SomersaultError(
            f"{model.name} has a fixed base; take a model that is free in the air"
        )
    q = pose(model, angles)
    if q.ndim != 1:
        raise SomersaultError("angles of a pose must be one number each")
    sides = _Sides(model, *body_frames(model, q))
    bodies = [sides.body(number, q) for number in range(len(model.bodies))]
    names = {model.bodies[first].name: name for first, name in sides.names.items()}
    merged = [
        replace(body, name=names.get(body.name, body.name)) for body in merge_welded(bodies, True)
    ]
    across = model.axes[0]
    _require_alike(model, merged, across - 1)
    return Model(
        f"{model.name}, from the side", True, tuple(merged), model.ignored, model.axes, across
    )


def _require_alike(model: Model, bodies: Sequence[Body], normal: int) -> None:
    """SomersaultError where a body is not alike on both sides of the plane: it would be pushed out
    of it."""
    places: list[float] = []
    for body in bodies:
        above = 0.0 if body.parent == GROUND else places[body.parent]
        places.append(above + body.position[normal])
    middle = places[0] + bodies[0].com[normal]
    for body, place in zip(bodies, places, strict=True):
        inertia = np.abs(np.array(body.inertia))
        mixed = max(inertia[normal][k] for k in range(3) if k != normal)
        off = abs(place + body.com[normal] - middle)
        if mixed > _ALIKE * inertia.max() or off**2 * body.mass > _ALIKE * inertia.max():
            raise SomersaultError(
                f"{body.name} of {model.name} is not alike on both sides of its plane in this "
                "pose, so it would not stay in it; give both sides the same angles, or take a body "
                "of two like sides"
            )


class _Sides:
    """Which bodies and joints of a posed model are one, seen from the side.

    `second` are the bodies that become one with another, by their places, and `names` what that
    one is called.
    """

    def __init__(self, model: Model, rotations: Array, origins: Array) -> None:
        self._model, self._rotations, self._origins = model, rotations, origins
        self._normal = np.eye(3)[model.axes[0] - 1]
        place = {
            joint.name: number for number, body in enumerate(model.bodies) for joint in body.joints
        }
        self.second: dict[int, int] = {}
        self.names: dict[int, str] = {}
        self._together: dict[str, tuple[str, Joint | None]] = {}  # the new name, and the other side
        for joint in model.joints:
            if self._is_across(place[joint.name], joint):
                self._together[joint.name] = joint.name, None
        for pair in mirror_pairs(model):
            one, two = sorted(model.speeds[k] for k in {pair.left, pair.right}) * (
                1 if pair.left != pair.right else 2
            )
            if pair.left == pair.right or not {one, two} <= set(self._together):
                continue
            first, second = sorted((one, two), key=place.__getitem__)
            self._require_one_line(place, first, second)
            self._together[first] = pair.name, model.joint(second)
            del self._together[second]
            self.second[place[second]] = place[first]
            self.names[place[first]] = common_name(
                *(model.bodies[place[name]].name for name in (first, second))
            )

    def _is_across(self, number: int, joint: Joint) -> bool:
        """Whether a joint is a hinge across the plane."""
        axis = self._rotations[number] @ np.array(joint.axis)
        return joint.kind == "hinge" and bool(
            np.linalg.norm(np.cross(axis, self._normal)) < _PARALLEL
        )

    def _require_one_line(self, place: Mapping[str, int], first: str, second: str) -> None:
        points = [
            self._origins[place[name]]
            + self._rotations[place[name]] @ np.array(self._model.joint(name).anchor)
            for name in (first, second)
        ]
        if np.linalg.norm(np.cross(points[1] - points[0], self._normal)) > _ONE_LINE:
            raise SomersaultError(
                f"{first} and {second} of {self._model.name} do not turn about one line in this "
                "pose; give both sides the same angles"
            )

    def body(self, number: int, q: Array) -> Body:
        """A body in the pose, its axes along the base's; without joints where it becomes one with
        another."""
        body, turn = self._model.bodies[number], self._rotations[number]
        parent = self.second.get(number, body.parent)
        inertia = turn @ np.array(body.inertia) @ turn.T
        return replace(
            body,
            parent=parent,
            com=as_vector(turn @ np.array(body.com)),
            inertia=as_matrix((inertia + inertia.T) / 2),
            position=ZERO
            if parent == GROUND
            else as_vector(self._origins[number] - self._origins[parent]),
            rotation=IDENTITY,
            joints=tuple(
                self._joint(joint, turn, q)
                for joint in body.joints
                if number not in self.second and joint.name in self._together
            ),
            shapes=tuple(shape.placed(np.zeros(3), turn) for shape in body.shapes),
        )

    def _joint(self, joint: Joint, turn: Array, q: Array) -> Joint:
        name, other = self._together[joint.name]
        both = (joint, joint if other is None else other)
        share = 1.0 if other is None else 2.0
        along = np.sign(turn @ np.array(joint.axis) @ self._normal) * self._normal + 0.0
        follows = joint.follows
        if follows is not None and follows.leader in self._together:
            leader, _ = self._together[follows.leader]
            follows = Follow(leader, follows.factor, follows.offset)
        return replace(
            joint,
            name=name,
            axis=as_vector(along),
            anchor=as_vector(turn @ np.array(joint.anchor)),
            reference=float(q[self._model.coordinate_slice(joint.name)][0]),
            follows=follows,
            **{
                what: share * sum(getattr(one, what) for one in both) / 2
                for what in ("stiffness", "damping", "armature")
            },
        )
