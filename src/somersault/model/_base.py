"""Which body of a tree is the one in the air.

A file says so with a free joint, or with virtual joints between the ground and its first body that
let it move in all six ways. Where it says neither, `base` can: "free" lets go of what stands on
the ground, "fixed" holds the free body.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Literal

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.attitude import AXES
from somersault.model._bodies import GROUND, Body, Joint
from somersault.model._model import Model
from somersault.model._vectors import IDENTITY, ZERO, Matrix
from somersault.model._weld import merge_welded

Base = Literal["free", "fixed"]

_NEGLIGIBLE = 1e-6  # of the greatest mass and inertia: what a carrier of virtual joints may have
_PARALLEL = 1e-3  # of the sine between two axes, or the volume that three span
_NOTHING: Matrix = (ZERO, ZERO, ZERO)


@dataclass(frozen=True)
class Rooted:
    """Bodies without welds, and whether the first of them is free in the air.

    `let_go` are the joints that were between it and the ground, `still` the names of the bodies
    with mass that are fixed to the ground and thereby gone.
    """

    bodies: tuple[Body, ...]
    free: bool
    let_go: tuple[Joint, ...] = ()
    still: tuple[str, ...] = ()


def rooted(name: str, bodies: Sequence[Body], free: bool, base: Base | None = None) -> Rooted:
    """The bodies of a file, welded together where nothing moves, on the base that is asked for.

    Parameters
    ----------
    name : str
        The file's, for what is refused.
    bodies : sequence of Body
        Parents first; with `free`, the first is the free body.
    free : bool
        Whether the file says that it is.
    base : {"free", "fixed"}, optional
        What to make of it; by default what the file says.

    Raises
    ------
    SomersaultError
        If it cannot be let go because several bodies stand on the ground.
    """
    still = tuple(body.name for body in _fixed(bodies, free) if body.mass != 0)
    whole = Rooted(merge_welded(list(bodies), free), free, still=still)
    if not free:
        whole = _virtually_free(whole)
    if base == "free" and not whole.free:
        return _let_go(name, list(bodies))
    if base == "fixed" and whole.free:
        return replace(whole, bodies=merge_welded(list(whole.bodies), free=False), free=False)
    return whole


def rebased(model: Model, base: Base | None) -> Model:
    """The same model on the base that is asked for; as it is where none is."""
    if base is None or model.free == (base == "free"):
        return model
    on = rooted(model.name, model.bodies, model.free, base)
    return replace(model, free=on.free, bodies=on.bodies, axes=model.axes if on.free else AXES)


def _fixed(bodies: Sequence[Body], free: bool) -> list[Body]:
    """The bodies that nothing moves, a free one not among them."""
    fixed: set[int] = set()
    for index, body in enumerate(bodies):
        if free and index == 0:
            continue
        if not body.joints and (body.parent == GROUND or body.parent in fixed):
            fixed.add(index)
    return [bodies[index] for index in sorted(fixed)]


def _virtually_free(whole: Rooted) -> Rooted:
    """The first body that can move in all six ways, free, without the joints that let it.

    The six may be on one body or shared with carriers without mass below it, each the only thing
    that stands on the one before it; three slides, and three hinges or a ball, in any order.
    Springs or rotors on them hold the body, which is then a machine on the ground.
    """
    bodies = whole.bodies
    most_mass = max((body.mass for body in bodies), default=0.0)
    most_inertia = max((np.abs(body.inertia).max() for body in bodies), default=0.0)
    joints: list[Joint] = []
    axes: list[Array] = []
    turn = np.eye(3)
    index = 0
    while bodies:
        body = bodies[index]
        turn = turn @ np.array(body.rotation)
        joints += body.joints
        axes += [turn @ np.array(joint.axis) for joint in body.joints]
        if len(joints) >= 4 and _six(joints, axes):
            return Rooted(_in_the_air(bodies, index), True, tuple(joints), whole.still)
        children = [number for number, child in enumerate(bodies) if child.parent == index]
        heavy = (
            body.mass > _NEGLIGIBLE * most_mass
            or np.abs(body.inertia).max() > _NEGLIGIBLE * most_inertia
        )
        if len(joints) > 5 or heavy or len(children) != 1:
            break
        index = children[0]
    return whole


def _six(joints: list[Joint], axes: list[Array]) -> bool:
    """Whether joints in sequence let a body move in all six ways, and do nothing else."""
    if any(joint.stiffness or joint.armature or joint.follows for joint in joints):
        return False
    kinds = [joint.kind for joint in joints]
    slides = [axis for kind, axis in zip(kinds, axes, strict=True) if kind == "slide"]
    hinges = [axis for kind, axis in zip(kinds, axes, strict=True) if kind == "hinge"]
    if len(slides) != 3 or abs(np.linalg.det(slides)) < _PARALLEL:
        return False
    if kinds.count("ball"):
        return kinds.count("ball") == 1 and not hinges
    return len(hinges) == 3 and all(
        np.linalg.norm(np.cross(one, other)) > _PARALLEL for one, other in pairwise(hinges)
    )


def _in_the_air(bodies: Sequence[Body], base: int) -> tuple[Body, ...]:
    """The bodies with `base` first, free, and its carriers gone."""
    carriers = set()
    above = bodies[base].parent
    while above != GROUND:
        carriers.add(above)
        above = bodies[above].parent
    order = [base, *(n for n in range(len(bodies)) if n != base and n not in carriers)]
    places = {old: new for new, old in enumerate(order)} | {GROUND: GROUND}
    free = replace(bodies[base], parent=GROUND, position=ZERO, rotation=IDENTITY, joints=())
    rest = [replace(bodies[old], parent=places[bodies[old].parent]) for old in order[1:]]
    return (free, *rest)


def root(bodies: Sequence[Body], base: str) -> tuple[Body, ...]:
    """The bodies from the ground to the one called `base`, each the parent of the next."""
    chain: list[Body] = []
    at = next(index for index, body in enumerate(bodies) if body.name == base)
    while at != GROUND:
        chain.insert(0, bodies[at])
        at = bodies[at].parent
    return tuple(replace(body, parent=number - 1) for number, body in enumerate(chain))


def base_on_its_joints(model: Model) -> Model | None:
    """The base alone, on the joints that connect it to the ground in the model's file.

    Parameters
    ----------
    model : Model

    Returns
    -------
    Model or None
        Its frame is that of the base; its masses mean nothing. None if the file has no such joints.
    """
    chain = [
        replace(body, mass=1.0, com=ZERO, inertia=IDENTITY, shapes=())
        for body in model.file_coordinates.root
    ]
    if not chain:
        return None
    return Model(f"the base of {model.name}", False, merge_welded(chain, free=False))


def _let_go(name: str, bodies: list[Body]) -> Rooted:
    """Free what is fixed to the ground; where that weighs nothing, the body that stands on it."""
    fixed = _fixed(bodies, free=False)
    if any(body.mass > 0 for body in fixed):
        ground = Body(fixed[0].name, GROUND, 0.0, ZERO, _NOTHING)
        hung = [replace(body, parent=body.parent + 1) for body in bodies]
        return Rooted(merge_welded([ground, *hung], free=True), True)
    merged = merge_welded(bodies, free=False)
    standing = [body for body in merged if body.parent == GROUND]
    if len(standing) > 1:
        raise SomersaultError(
            f"{name} cannot be let go: {standing[0].name!r} and {standing[1].name!r} both stand "
            "on the ground, and only one body flies; join them"
        )
    joints = standing[0].joints if standing else ()
    return Rooted(_in_the_air(merged, 0) if merged else (), True, joints)
