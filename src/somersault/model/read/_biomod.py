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
from somersault.model._base import rooted
from somersault.model._bodies import GROUND, Body, Joint
from somersault.model._model import Model
from somersault.model._weld import merge_welded
from somersault.model.read._biomod_text import AXES, File, Segment
from somersault.model.read._biomod_words import Words, read_text, shown


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
    bodies = _bodies(segments)
    _refuse_mirrors(path.name, merge_welded(bodies, free=False))
    on = rooted(path.name, bodies, free=False)
    if not on.bodies:
        raise SomersaultError(
            f"{path.name}: no segment has translations or rotations, so nothing can fly; give "
            "the root segment translations xyz and rotations xyz"
        )
    return Model(
        name=path.stem,
        free=on.free,
        bodies=on.bodies,
        ignored=_ignored(file, segments, on.let_go),
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


def _ignored(file: File, segments: list[Segment], root: tuple[Joint, ...]) -> tuple[str, ...]:
    """What the file held that has no part in flight, in words; the joints of a free root too."""
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
    if any(joint.damping for joint in root):
        said.append("the dampings of the root")  # nothing damps a fall
    return tuple(said)
