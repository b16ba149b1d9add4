"""How the links of a tree stand and move: the outward pass that every algorithm shares."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca

from somersault.dynamics._tree import Link, Tree
from somersault.dynamics._turn import Turn
from somersault.dynamics.vectors import Mat, Scalar, Vec, add, cross, mul, sub, vadd


@dataclass(frozen=True)
class Placed:
    """A link in a pose: how it is turned in its parent, and where (parent's axes)."""

    link: Link
    turn: Turn
    position: Vec


def placements(tree: Tree, q: Sequence[Scalar]) -> list[Placed]:
    """Every link in a pose.

    Parameters
    ----------
    tree : Tree
    q : sequence
        Joint coordinates.

    Returns
    -------
    list of Placed
    """
    return [_placed(link, q) for link in tree.links]


def _placed(link: Link, q: Sequence[Scalar]) -> Placed:
    joint = link.joint
    if joint is None:
        return Placed(link, Turn(link.rotation), link.position)
    if joint.kind == "ball":
        full = rotation(q[link.coordinates])
        return Placed(link, Turn(link.rotation, full), link.position)
    move = mul(link.sign, sub(q[link.coordinates][0], joint.reference))
    if joint.kind == "slide":
        shift: Vec = [0.0] * 3
        shift[link.axis] = move
        turn = Turn(link.rotation)
        return Placed(link, turn, vadd(link.position, turn.out(shift)))
    return Placed(
        link, Turn(link.rotation, None, link.axis, ca.cos(move), ca.sin(move)), link.position
    )


def rotation(quaternion: Sequence[Any]) -> Mat:
    """Rotation matrix of a unit quaternion, scalar first (child to parent)."""
    w, x, y, z = quaternion
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]


@dataclass(frozen=True)
class Rates:
    """A link's angular velocity ω and the parts of its acceleration that rates alone make.

    With the parent's angular acceleration α_p and its frame's acceleration a_p, this link has
    α = into(α_p) + spin and a = into(a_p + α_p × position) + pull, plus its own joint's.
    """

    omega: Vec
    spin: Vec
    pull: Vec


def joint_vector(link: Link, values: Sequence[Scalar]) -> Vec:
    """A joint's own speeds (or accelerations) as a vector along its link's axes."""
    along = list(values[link.speeds])
    if link.joint is not None and link.joint.kind == "ball":
        return along
    vector: Vec = [0.0] * 3
    vector[link.axis] = mul(link.sign, along[0])
    return vector


def rates(placed: Sequence[Placed], omega: Vec, speeds: Sequence[Scalar]) -> list[Rates]:
    """Angular velocities and velocity-dependent accelerations, base outward.

    `omega` is the base's angular velocity in its own axes (zero for a fixed base). Frame
    accelerations are those of the frames' origins in inertial space, so that no linear
    velocity enters: a body's motion relative to a steadily moving observer is the same.
    """
    result: list[Rates] = []
    for at in placed:
        link = at.link
        if link.joint is None:
            result.append(Rates(list(omega), [0.0] * 3, [0.0] * 3))
            continue
        outer = result[link.parent].omega if link.parent >= 0 else [0.0] * 3
        carried = at.turn.into(outer)
        centripetal = at.turn.into(cross(outer, cross(outer, at.position)))
        relative = joint_vector(link, speeds)
        if link.joint.kind == "slide":
            coriolis = cross(carried, relative)
            pull = vadd(centripetal, coriolis, coriolis)
            result.append(Rates(carried, [0.0] * 3, pull))
        else:
            moving = [add(carried[k], relative[k]) for k in range(3)]
            result.append(Rates(moving, cross(carried, relative), centripetal))
    return result
