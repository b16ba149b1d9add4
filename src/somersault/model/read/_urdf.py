"""A URDF file as a `Model`: its links' inertias, its joints, and, for pictures, its visuals.

The reader is ours because MuJoCo's compiles the meshes, refuses what cannot be simulated and gives
a link without <inertial> the mass of its shape, and because the parsers on PyPI bring lxml and
mesh libraries and neither bound nor check what they read. Meanings are urdfdom's and pinocchio's,
with which the tests compare mass matrices.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault._core.notes import note
from somersault.attitude import matrix_from_quaternion
from somersault.model._base import Base, rooted
from somersault.model._bodies import GROUND, Body, Joint
from somersault.model._model import Model
from somersault.model._vectors import as_matrix, as_vector
from somersault.model.read._drawn import Drawn
from somersault.model.read._follow import leaders
from somersault.model.read._urdf_elements import Elements, UrdfJoint
from somersault.model.read._urdf_shapes import link_shapes
from somersault.model.read._xml import read_xml

_GROUND_LINK = "world"  # by the custom of ROS
_ONE_ANGLE = ("revolute", "continuous", "prismatic")


def read_urdf(path: Path, base: Base | None = None) -> Model:
    """The robot in a URDF file.

    Its root link is the free base, unless it is called `world`, which by the custom of ROS is the
    ground, or is a mere frame: no mass, and one joint on it. A `floating` joint on the root link
    frees what it carries, and the root is then the ground.

    Parameters
    ----------
    path : Path
    base : {"free", "planar", "fixed"}, optional
        Let the robot go, or hold it by its root link (or what its floating joint frees).

    Raises
    ------
    SomersaultError
        For a file that is no robot, or none that can fly.
    """
    robot = read_xml(path)
    file = Elements(path.name, robot)
    if not any(link.mass > 0 for link in file.links.values()):
        raise SomersaultError(
            f"{path.name} has no mass: no link of it has an <inertial> with one; add masses"
        )
    order, free = _order(file, _root(file), _moving_something(file, _led(file)))
    drawn = link_shapes(file, robot, path.parent)
    on = rooted(path.name, _bodies(file, order, drawn), free, base)
    if not on.bodies:
        raise SomersaultError(
            f"{path.name} is fixed to the ground as a whole, so nothing can fly; give it "
            'base = "free"'
        )
    for sentence in file.strange.sentences():
        note(f"{path.name}: {sentence}")
    left_out = [
        f"{count} {what}{'' if count == 1 else 's'}" for what, count in file.no_part.items()
    ]
    left_out += [f"link {name}, fixed to the ground" for name in on.still]
    if any(joint.damping for joint in on.let_go):
        left_out.append("the dampings of the root")
    return Model(path.stem, on.free, on.bodies, tuple(left_out), on.axes, on.plane)


def _root(file: Elements) -> str:
    """The link that is nobody's child; SomersaultError unless the links form one tree."""
    parents: dict[str, str] = {}
    for joint in file.joints:
        if joint.child in parents:
            raise SomersaultError(
                f"{file.file}: link {joint.child!r} is the child of two joints, "
                f"{parents[joint.child]!r} and {joint.name!r}; a robot is a tree, so remove one"
            )
        parents[joint.child] = joint.name
    roots = [name for name in file.links if name not in parents]
    if not roots:
        raise SomersaultError(f"{file.file}: its links form a loop; cut it at one joint")
    if len(roots) > 1:
        raise SomersaultError(
            f"{file.file} has {len(roots)} links without a parent, {roots[0]!r} and {roots[1]!r} "
            "among them; a robot is one tree, so join them or remove one"
        )
    return roots[0]


def _led(file: Elements) -> list[UrdfJoint]:
    """The joints, each that mimics another following the one that leads in the end.

    A joint that has no one angle of its own neither leads nor follows. What follows a fixed joint
    stands still, at its offset.
    """
    kinds = {joint.name: joint.kind for joint in file.joints}
    mimics = {j.name: j.mimic for j in file.joints if j.mimic is not None and j.kind in _ONE_ANGLE}
    ends = leaders(file.file, mimics, kinds)
    result = []
    for joint in file.joints:
        follow = ends.get(joint.name)
        if follow is None:
            joint = replace(joint, mimic=None)
        elif kinds[follow.leader] == "fixed":
            file.strange.add("joints that mimic a fixed joint are fixed", joint.name)
            joint = _stopped(joint, follow.offset)
        elif kinds[follow.leader] not in _ONE_ANGLE:
            raise SomersaultError(
                f"{file.file}: joint {joint.name!r} mimics {follow.leader!r}, which is "
                f"{kinds[follow.leader]} and has no one angle; let it mimic another"
            )
        else:
            joint = replace(joint, mimic=follow)
        result.append(joint)
    return result


def _stopped(joint: UrdfJoint, at: float) -> UrdfJoint:
    """The joint fixed where it has the coordinate `at`."""
    position, rotation = joint.position, joint.rotation
    if joint.kind == "prismatic":
        position = position + rotation @ (at * joint.axis)
    else:
        quaternion = np.concatenate([[np.cos(at / 2)], np.sin(at / 2) * joint.axis])
        rotation = rotation @ matrix_from_quaternion(quaternion)
    return replace(joint, kind="fixed", position=position, rotation=rotation, mimic=None)


def _moving_something(file: Elements, joints: list[UrdfJoint]) -> list[UrdfJoint]:
    """The joints with those fixed that move nothing, whose acceleration nothing would decide.

    One that others mimic stays: it moves what they move.
    """
    above = {joint.child: joint for joint in joints}
    heavy = set()
    for name, link in file.links.items():
        if link.moves:
            while name not in heavy:
                heavy.add(name)
                name = above[name].parent if name in above else name
    leading = {j.mimic.leader for j in joints if j.mimic is not None and j.child in heavy}
    result = []
    for joint in joints:
        if joint.kind != "fixed" and joint.child not in heavy and joint.name not in leading:
            file.strange.add("joints that move no mass are left out", joint.name)
            joint = replace(joint, kind="fixed", mimic=None)
        result.append(joint)
    return result


# ------------------------------------------------------------------------------- bodies

_Order = list[tuple[str, UrdfJoint | None]]


def _order(file: Elements, root: str, joints: list[UrdfJoint]) -> tuple[_Order, bool]:
    """The links, parents first, each with its joint, and whether the first is free in the air."""
    above = {joint.child: joint for joint in joints}
    below: dict[str, list[UrdfJoint]] = {name: [] for name in file.links}
    for joint in joints:
        below[joint.parent].append(joint)

    def outward(start: str, without: str = "") -> _Order:
        order: _Order = []
        waiting = [start]
        while waiting:
            name = waiting.pop()
            order.append((name, None if name == start else above[name]))
            waiting += [j.child for j in reversed(below[name]) if j.child != without]
        return order

    order = outward(root)
    if len(order) < len(file.links):
        lost = next(name for name in file.links if name not in dict(order))
        raise SomersaultError(
            f"{file.file}: link {lost!r} and those it hangs from form a loop; cut it at one joint"
        )
    still = {root}  # with what is fixed to it
    standing: list[UrdfJoint] = []
    for name, moved_by in order:
        if moved_by is None or moved_by.parent not in still:
            continue
        if moved_by.kind == "fixed":
            still.add(name)
        else:
            standing.append(moved_by)
    floating = [joint for joint in standing if joint.kind == "floating"]
    if len(floating) > 1:
        raise SomersaultError(
            f"{file.file} has two floating joints on the ground, {floating[0].name!r} and "
            f"{floating[1].name!r}; a model is one body in the air, so keep one"
        )
    if floating:
        base = floating[0].child
        return outward(base) + outward(root, without=base), True
    frame = len(standing) == 1 and not any(file.links[name].moves for name in still)
    return order, not frame and root != _GROUND_LINK


def _bodies(file: Elements, order: _Order, drawn: Drawn) -> list[Body]:
    numbers = {name: number for number, (name, _) in enumerate(order)}
    bodies = []
    for name, joint in order:
        link = file.links[name]
        body = Body(
            name,
            GROUND,
            link.mass,
            as_vector(link.com),
            as_matrix(link.inertia),
            shapes=drawn.of(name),
            inertia_from="file" if link.given else "nothing",
        )
        if joint is not None:
            body = replace(
                body,
                parent=numbers[joint.parent],
                position=as_vector(joint.position),
                rotation=as_matrix(joint.rotation),
                joints=_joints(joint),
            )
        bodies.append(body)
    return bodies


def _joints(joint: UrdfJoint) -> tuple[Joint, ...]:
    """The joints of a `Model` that move as one of URDF does."""
    name, axis, damping = joint.name, as_vector(joint.axis), joint.damping
    if joint.kind in ("revolute", "continuous"):
        return (
            Joint(name, "hinge", axis, limits=joint.limits, damping=damping, follows=joint.mimic),
        )
    if joint.kind == "prismatic":
        return (
            Joint(name, "slide", axis, limits=joint.limits, damping=damping, follows=joint.mimic),
        )
    if joint.kind == "planar":  # in the plane across its axis, and about it
        first, second = _across(joint.axis)
        return (
            Joint(f"{name}_1", "slide", as_vector(first), damping=damping),
            Joint(f"{name}_2", "slide", as_vector(second), damping=damping),
            Joint(f"{name}_turn", "hinge", axis, damping=damping),
        )
    if joint.kind == "floating":
        slides = (
            Joint(f"{name}_{k + 1}", "slide", as_vector(np.eye(3)[k]), damping=damping)
            for k in range(3)
        )
        return (*slides, Joint(f"{name}_turn", "ball", damping=damping))
    return ()


def _across(axis: Array) -> tuple[Array, Array]:
    """Two unit vectors across an axis, right-handed with it: x and y for z, y and z for x."""
    largest = int(np.argmax(np.abs(axis)))
    first = np.eye(3)[(largest + 1) % 3]
    first = first - (first @ axis) * axis
    first /= np.linalg.norm(first)
    return first, np.cross(axis, first)
