"""The same tree of bodies, seen from another one of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.model._bodies import GROUND, Body, Joint
from somersault.model._vectors import IDENTITY, ZERO, as_matrix, as_vector


def rerooted(bodies: Sequence[Body], root: int) -> tuple[list[Body], list[int]]:
    """A tree of bodies on body 0 as one on another, which comes first.

    Frames of bodies stay where they are in them, and joints keep their names and angles: a hinge
    that turned the child against its parent turns the parent against its child the other way.

    Parameters
    ----------
    bodies : sequence of Body
        In order, parents first; body 0 is the base.
    root : int
        Place of the body that the others are to stand on.

    Returns
    -------
    bodies : list of Body
    places : list of int
        Where each body is now.

    Raises
    ------
    SomersaultError
        For a ball between the two, whose quaternion would be another one.
    """
    path = [root]  # from the root to the base
    while bodies[path[-1]].parent != GROUND:
        path.append(bodies[path[-1]].parent)
    above = dict(zip(path[1:], path[:-1], strict=True))  # who carries them now
    parents = [above.get(number, body.parent) for number, body in enumerate(bodies)]
    parents[root] = GROUND
    order = [root]
    for number in order:
        order += [child for child, parent in enumerate(parents) if parent == number]
    places = [order.index(number) for number in range(len(bodies))]
    turned: list[Body] = []
    for number in order:
        body = bodies[number]
        if number == root:
            body = replace(body, position=ZERO, rotation=IDENTITY, joints=())
        elif number in above:
            body = _turned(body, bodies[above[number]])
        parent = parents[number]
        turned.append(replace(body, parent=GROUND if parent == GROUND else places[parent]))
    return turned, places


def _turned(parent: Body, child: Body) -> Body:
    """A body on what was its child."""
    position, rotation = np.array(child.position), np.array(child.rotation)
    return replace(
        parent,
        position=as_vector(-rotation.T @ position),
        rotation=as_matrix(rotation.T),
        joints=tuple(_joint(joint, position, rotation) for joint in reversed(child.joints)),
    )


def _joint(joint: Joint, position: Array, rotation: Array) -> Joint:
    """A joint of the child in the axes of what was its parent."""
    if joint.kind == "ball":
        raise SomersaultError(
            f"joint {joint.name} is a ball, so what is behind it cannot be held; hold a body on "
            "its near side"
        )
    axis = -(rotation @ np.array(joint.axis)) + 0.0  # no negative zeros
    anchor = position + rotation @ np.array(joint.anchor)
    return replace(joint, axis=as_vector(axis), anchor=as_vector(anchor))
