"""`.bioMod` files, the text format of biorbd and bioptim, as a `Model`.

Meanings follow biorbd's sources (pyomeca/biorbd, src/ModelReader.cpp, src/RigidBody/Segment.cpp).
The reader is ours because biobuddy 0.3.2 refuses `variables`, arithmetic, actuators, patches and
the usual `root_actuated` header, takes the default of `rtinmatrix` wrongly in version 3, and
needs two seconds and pandas to import; biorbd itself skips unknown words in silence and insists
on opening the mesh files.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from somersault._core.errors import SomersaultError
from somersault.model._types import GROUND, IDENTITY, ZERO, Body, Joint, Model
from somersault.model._weld import merge_welded
from somersault.model.read._biomod_text import AXES, File, Segment
from somersault.model.read._biomod_words import Words, read_text, shown

_NEGLIGIBLE = 1e-6  # of the whole mass: what a carrier of the root's translations may weigh


def read_biomod(path: Path) -> Model:
    """The model in a `.bioMod` file.

    Segments without degrees of freedom are welded to their parents. A root that can move in all
    six ways becomes the free base, in its own axes; any other root stays on joints to the
    ground. Joints are named as biorbd names degrees of freedom (`RightUpperArm_RotY`), a
    quaternion joint `<segment>_Quat`. Gravity, meshes, markers, contacts and actuators are
    ignored, and said to be. Raises SomersaultError, with the line, for what cannot be read or
    cannot be flown.
    """
    file = File(Words(path.name, read_text(path)))
    file.read()
    segments = list(file.segments.values())
    bodies = merge_welded(_bodies(segments), free=False)
    if not bodies:
        raise SomersaultError(
            f"{path.name}: no segment has translations or rotations, so nothing can fly; give "
            "the root segment translations xyz and rotations xyz"
        )
    _refuse_mirrors(path.name, bodies)
    base = _base(bodies)
    return Model(
        name=path.stem,
        free=base is not None,
        bodies=bodies if base is None else _in_the_air(bodies, base),
        ignored=_ignored(file, segments, bodies[: base + 1] if base is not None else ()),
    )


def _bodies(segments: list[Segment]) -> list[Body]:
    numbers = {segment.name: number for number, segment in enumerate(segments)}
    return [
        Body(
            name=segment.name,
            parent=numbers.get(segment.parent, GROUND),
            mass=segment.mass,
            com=segment.com,
            inertia=segment.inertia,
            position=segment.position,
            rotation=segment.rotation,
            joints=_joints(segment),
        )
        for segment in segments
    ]


def _joints(segment: Segment) -> tuple[Joint, ...]:
    """Translations first, then rotations, each in the order written (Segment::fillSequence)."""
    joints = [
        Joint(f"{segment.name}_Trans{letter.upper()}", "slide", AXES[letter])
        for letter in segment.translations
    ]
    limits: list[tuple[float, float] | None] = list(segment.limits) or [None] * 6
    dampings = segment.dampings or [0.0] * 6
    if segment.rotations == "q":
        limits[len(joints)] = None
        joints.append(Joint(f"{segment.name}_Quat", "ball"))
    else:
        for number, letter in enumerate(segment.rotations):
            # biorbd gives both z of zyz one name; here every joint needs its own.
            again = "2" if letter in segment.rotations[:number] else ""
            name = f"{segment.name}_Rot{letter.upper()}{again}"
            joints.append(Joint(name, "hinge", AXES[letter]))
    return tuple(
        replace(joint, limits=limit, damping=damping)
        for joint, limit, damping in zip(joints, limits, dampings, strict=False)
    )


def _refuse_mirrors(file: str, bodies: tuple[Body, ...]) -> None:
    """A mirrored frame has a mass and an inertia, but a joint in it would turn backwards.

    Old models draw a left limb as the mirror image of a right one; welded, it does no harm.
    """
    for body in bodies:
        if np.linalg.det(np.array(body.rotation)) < 0:
            raise SomersaultError(
                f"{file}: the frame of segment {shown(body.name)} is a mirror image of its "
                "parent's, in which a joint has no meaning; give its rt a right-handed matrix"
            )


def _base(bodies: tuple[Body, ...]) -> int | None:
    """The body that becomes the free base: the first that can move in all six ways.

    The six may be split over a carrier without mass, as in the models with a quaternion root:
    one segment for the translations, its only child for the rotations.
    """
    total = sum(body.mass for body in bodies)
    slides = turns = False
    index = 0
    while True:
        body = bodies[index]
        kinds = [joint.kind for joint in body.joints]
        if kinds.count("slide") == 3 and not slides:
            slides = True
            kinds = [kind for kind in kinds if kind != "slide"]
        if kinds in (["ball"], ["hinge"] * 3) and not turns:
            turns = True
            kinds = []
        if kinds:
            return None
        if slides and turns:
            return index
        children = [number for number, child in enumerate(bodies) if child.parent == index]
        if turns or body.mass > _NEGLIGIBLE * total or len(children) != 1:
            return None
        index = children[0]


def _in_the_air(bodies: tuple[Body, ...], base: int) -> tuple[Body, ...]:
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


def _ignored(file: File, segments: list[Segment], base: tuple[Body, ...]) -> tuple[str, ...]:
    """What the file held that has no part in flight, in words; `base` and its carriers."""
    said = [
        kind if n == 0 else f"{n} {kind}" + ("s" if n > 1 else "")
        for kind, n in file.ignored.items()
    ]
    moving = {"root": False}
    for segment in segments:
        free = bool(segment.translations or segment.rotations)
        moving[segment.name] = free or moving[segment.parent]
    fixed = [name for name, moves in moving.items() if not moves and name != "root"]
    said += [f"segment {name}, fixed to the ground" for name in fixed]
    if any(joint.damping for body in base for joint in body.joints):
        said.append("the dampings of the root")  # nothing damps a fall
    return tuple(said)
