"""`.bioMod` files, the text format of biorbd and bioptim, as a `Model`.

Meanings follow biorbd's sources (pyomeca/biorbd, src/ModelReader.cpp, src/RigidBody/Segment.cpp).
The reader is ours because biobuddy 0.3.2 refuses `variables`, arithmetic, actuators, patches and
the usual `root_actuated` header, takes the default of `rtinmatrix` wrongly in version 3, and
needs two seconds and pandas to import; biorbd itself insists on opening the mesh files at once.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from somersault._core.errors import SomersaultError
from somersault._core.notes import note
from somersault.model._base import Base, Rooted, root, rooted
from somersault.model._bodies import GROUND, Body, Joint
from somersault.model._model import FileCoordinates, Model
from somersault.model._weld import merge_welded
from somersault.model.read._biomod_blocks import PassiveTorque
from somersault.model.read._biomod_segment import AXES, GROUND_PARENT, Segment
from somersault.model.read._biomod_text import File
from somersault.model.read._biomod_words import Words, read_text, shown
from somersault.model.read._drawn import Drawn


def read_biomod(path: Path, base: Base | None = None) -> Model:
    """The model in a `.bioMod` file.

    Segments without degrees of freedom are welded to their parents. A root that can move in all
    six ways, or in the three of a plane, becomes the free base, in its own axes; any other root
    stays on joints to the ground, unless another `base` is asked for. Joints are named as biorbd
    names degrees of freedom (`RightUpperArm_RotY`), a quaternion joint `<segment>_Quat`. What is
    left out or read otherwise is said in warnings.
    Raises SomersaultError, with the line, for what cannot be read or cannot be flown.
    """
    file = File(Words(path.name, read_text(path)))
    file.read()
    segments = list(file.segments.values())
    bodies = _bodies(file, segments, Drawn(path.parent, file.strange))
    _refuse_mirrors(path.name, merge_welded(bodies, free=False))
    on = rooted(path.name, bodies, free=False, base=base)
    if not on.bodies:
        raise SomersaultError(
            f"{path.name}: no segment has translations or rotations, so nothing can fly; give "
            "the root segment translations xyz and rotations xyz"
        )
    held = root(bodies, on.bodies[0].name) if on.free else ()
    if on.free:
        _refuse_lost(path.name, segments, bodies, held[-1])
    moving = _sprung(file, on.bodies)
    for kind, number in file.acting.items():
        file.strange.add("acting in the file, but left out of flights", _counted(kind, number))
    for sentence in file.strange.sentences():
        note(f"{path.name}: {sentence}")
    return Model(
        name=path.stem,
        free=on.free,
        bodies=moving,
        ignored=_ignored(file, segments, on, base),
        axes=on.axes,
        plane=on.plane,
        file_coordinates=FileCoordinates(held),
    )


def _bodies(file: File, segments: list[Segment], drawn: Drawn) -> list[Body]:
    numbers = {segment.name: number for number, segment in enumerate(segments)}
    heavy: set[str] = set()  # what has mass, or carries it
    for segment in reversed(segments):
        if segment.mass or np.any(segment.inertia) or segment.name in heavy:
            heavy |= {segment.name, segment.parent}
    bodies = []
    for segment in segments:
        joints = _joints(segment)
        if joints and segment.name not in heavy:
            names = ", ".join(joint.name for joint in joints)
            file.strange.add("joints that move no mass, and so left out", names)
            joints = ()
        drawn.add(segment.name, partial(segment.look.shape, drawn))
        bodies.append(
            Body(
                name=segment.name,
                parent=numbers.get(segment.parent, GROUND),
                mass=segment.mass,
                com=segment.com,
                inertia=segment.inertia,
                position=segment.position,
                rotation=segment.rotation,
                joints=joints,
                shapes=drawn.of(segment.name),
            )
        )
    return bodies


def _refuse_lost(file: str, segments: list[Segment], bodies: list[Body], base: Body) -> None:
    """Refuse a segment below the base in the file that lost its parent: it would stand on the
    ground, apart from the body in the air."""
    free = next(number for number, body in enumerate(bodies) if body.name == base.name)
    for segment in segments[free + 1 :]:
        if segment.parent == GROUND_PARENT and not segment.hung and segment.mass:
            raise SomersaultError(
                f"{file}: segment {shown(segment.name)} names no parent, and so stands on the "
                f"ground with its {segment.mass:g} kg; name its parent, or write parent root if "
                "that is meant"
            )


def _sprung(file: File, bodies: tuple[Body, ...]) -> tuple[Body, ...]:
    """The bodies with the passive torques on their joints that are springs, τ = T0 + slope q."""
    slopes: dict[str, list[PassiveTorque]] = {}
    for torque in file.torques:
        if torque.slope is not None and torque.slope < 0:
            slopes.setdefault(torque.joint, []).append(torque)
        elif torque.slope != 0 or torque.constant != 0:
            file.acting["passive torque"] += 1
    joints = {joint.name: joint for body in bodies for joint in body.joints}
    for name, torques in slopes.items():
        if name not in joints:
            file.acting["passive torque"] += len(torques)
            continue
        stiffness = -sum(torque.slope or 0.0 for torque in torques)
        rest = sum(torque.constant or 0.0 for torque in torques) / stiffness
        joints[name] = replace(joints[name], stiffness=stiffness, rest=rest)
    return tuple(
        replace(body, joints=tuple(joints[joint.name] for joint in body.joints)) for body in bodies
    )


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


def _ignored(file: File, segments: list[Segment], on: Rooted, base: Base | None) -> tuple[str, ...]:
    """What the file held that has no part in flight, in words; the joints of a free root too."""
    said = [_counted(kind, number) for kind, number in file.ignored.items()]
    moving = {GROUND_PARENT: False}
    for segment in segments:
        free = bool(segment.translations or segment.rotations)
        moving[segment.name] = free or moving[segment.parent]
    fixed = [name for name, moves in moving.items() if not moves and name != GROUND_PARENT]
    if base in ("free", "planar"):  # which may have let go of them
        fixed = list(on.still)
    said += [f"segment {name}, fixed to the ground" for name in fixed]
    if any(joint.damping for joint in on.let_go):
        said.append("the dampings of the root")  # nothing damps a fall
    return tuple(said)


def _counted(kind: str, number: int) -> str:
    """How many there are of a kind; 0 where that does not matter."""
    return kind if number == 0 else f"{number} {kind}" + ("s" if number > 1 else "")
