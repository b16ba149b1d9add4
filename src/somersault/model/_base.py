"""Which body of a tree is the one in the air.

A file says so with a free joint, or with virtual joints between the ground and its first body that
let it move in all six ways, or in the three of a plane. Where it says neither, or otherwise, `base`
can: "free" lets go of what stands on the ground, "planar" does so in a plane, "fixed" holds the
free body.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Literal

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import instance
from somersault._core.errors import SomersaultError
from somersault.attitude import AXES, Axes
from somersault.model._bodies import GROUND, Body, Joint
from somersault.model._model import Model
from somersault.model._vectors import IDENTITY, ZERO, Matrix
from somersault.model._weld import merge_welded

Base = Literal["free", "planar", "fixed"]

_NEGLIGIBLE = 1e-6  # of the greatest mass and inertia: what a carrier of virtual joints may have
_PARALLEL = 1e-3  # of the sine between two axes, or the volume that three span
_IN_PLANE = 1e-9  # of the sine by which slides may leave a plane, and hinges its normal
_OF_PLANE: dict[int, Axes] = {1: (1, 2, 3), 2: AXES, 3: (3, 1, 2)}  # of somersault across it
_NOTHING: Matrix = (ZERO, ZERO, ZERO)


@dataclass(frozen=True)
class Rooted:
    """Bodies without welds, and whether the first of them is free in the air, in what plane.

    `plane` and `axes` are those of a `Model`, `let_go` are the joints that were between the base
    and the ground, `still` the names of the bodies with mass that are fixed to the ground and
    thereby gone.
    """

    bodies: tuple[Body, ...]
    free: bool
    plane: int | None = None
    axes: Axes = AXES
    let_go: tuple[Joint, ...] = ()
    still: tuple[str, ...] = ()


def rooted(
    name: str,
    bodies: Sequence[Body],
    free: bool,
    base: Base | None = None,
    axes: Axes = AXES,
) -> Rooted:
    """The bodies of a file, welded together where nothing moves, on the base that is asked for.

    Parameters
    ----------
    name : str
        The file's, for what is refused.
    bodies : sequence of Body
        Parents first; with `free`, the first is the free body.
    free : bool
        Whether the file says that it is.
    base : {"free", "planar", "fixed"}, optional
        What to make of it; by default what the file says. A body on the joints of a plane stays on
        them where it is fixed.
    axes : tuple of int
        Of somersault, tilt and twist, unless the file has a plane that is not across the first.

    Raises
    ------
    SomersaultError
        If it cannot be let go because several bodies stand on the ground.
    """
    still = tuple(body.name for body in _fixed(bodies, free) if body.mass != 0)
    whole = Rooted(merge_welded(list(bodies), free), free, still=still)
    if not free:
        whole = _virtually_free(whole, in_plane=base != "fixed")
    if base == "fixed" and whole.free:
        return replace(whole, bodies=merge_welded(list(whole.bodies), free=False), free=False)
    if base in ("free", "planar") and not whole.free:
        whole = _let_go(name, list(bodies))
    if not whole.free:
        return whole
    if whole.plane not in (None, axes[0]):
        axes = _OF_PLANE[whole.plane]
    plane = {None: whole.plane, "free": None, "planar": axes[0]}[base]
    return replace(whole, plane=plane, axes=axes)


def rebased(model: Model, base: Base | None) -> Model:
    """The same model on the base that is asked for; as it is where none is."""
    now = "fixed" if not model.free else "free" if model.plane is None else "planar"
    if base is None or base == now:
        return model
    on = rooted(model.name, model.bodies, model.free, base, model.axes)
    return replace(model, free=on.free, bodies=on.bodies, axes=on.axes, plane=on.plane)


def _fixed(bodies: Sequence[Body], free: bool) -> list[Body]:
    """The bodies that nothing moves, a free one not among them."""
    fixed: set[int] = set()
    for index, body in enumerate(bodies):
        if free and index == 0:
            continue
        if not body.joints and (body.parent == GROUND or body.parent in fixed):
            fixed.add(index)
    return [bodies[index] for index in sorted(fixed)]


def _virtually_free(whole: Rooted, in_plane: bool) -> Rooted:
    """The first body that can move in all six ways, free, without the joints that let it.

    The six may be on one body or shared with carriers without mass below it, each the only thing
    that stands on the one before it; three slides, and three hinges or a ball, in any order. With
    `in_plane`, and where nothing moves in six ways and nothing else stands on the ground, likewise
    two slides and the hinge across them.
    Springs or rotors on them hold the body, which is then a machine on the ground.
    """
    bodies, planar = whole.bodies, whole
    in_plane = in_plane and [body.parent for body in bodies].count(GROUND) == 1
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
            return replace(
                whole, bodies=_in_the_air(bodies, index), free=True, let_go=tuple(joints)
            )
        plane = _plane(joints, axes, turn) if in_plane else None
        if plane is not None:
            planar = replace(
                whole,
                bodies=_in_the_air(bodies, index),
                free=True,
                plane=plane,
                let_go=tuple(joints),
            )
        children = [number for number, child in enumerate(bodies) if child.parent == index]
        heavy = (
            body.mass > _NEGLIGIBLE * most_mass
            or np.abs(body.inertia).max() > _NEGLIGIBLE * most_inertia
        )
        if len(joints) > 5 or heavy or len(children) != 1:
            break
        index = children[0]
    return planar


def _six(joints: list[Joint], axes: list[Array]) -> bool:
    """Whether joints in sequence let a body move in all six ways, and do nothing else."""
    if _held(joints):
        return False
    kinds = [joint.kind for joint in joints]
    slides, hinges = _directions(joints, axes, "slide"), _directions(joints, axes, "hinge")
    if len(slides) != 3 or abs(np.linalg.det(slides)) < _PARALLEL:
        return False
    if kinds.count("ball"):
        return kinds.count("ball") == 1 and not hinges
    return len(hinges) == 3 and all(
        np.linalg.norm(np.cross(one, other)) > _PARALLEL for one, other in pairwise(hinges)
    )


def _plane(joints: list[Joint], axes: list[Array], turn: Array) -> int | None:
    """The axis, of a body turned so, across the plane in which joints in sequence let it move, if
    they do that and nothing else."""
    slides, hinges = _directions(joints, axes, "slide"), _directions(joints, axes, "hinge")
    if len(joints) != 3 or len(slides) != 2 or len(hinges) != 1 or _held(joints):
        return None
    (one, other), (about,) = slides, hinges
    if np.linalg.norm(np.cross(one, other)) < _PARALLEL:
        return None
    if max(abs(one @ about), abs(other @ about)) > _IN_PLANE:
        return None
    normal = turn.T @ about
    across = int(np.argmax(np.abs(normal)))
    return across + 1 if np.linalg.norm(np.delete(normal, across)) < _IN_PLANE else None


def _held(joints: list[Joint]) -> bool:
    """Whether something else than a damper acts at joints."""
    return any(joint.stiffness or joint.armature or joint.follows for joint in joints)


def _directions(joints: list[Joint], axes: list[Array], kind: str) -> list[Array]:
    """The axes of the joints of a kind."""
    return [axis for joint, axis in zip(joints, axes, strict=True) if joint.kind == kind]


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
        for body in instance("model", model, Model).file_coordinates.root
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
    return Rooted(_in_the_air(merged, 0) if merged else (), True, let_go=joints)
