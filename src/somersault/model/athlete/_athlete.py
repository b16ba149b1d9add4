"""The tree of an athlete: which bodies, joined by which hinges, whatever measured them.

The thirteen joints are those of Playter (1994), section 6.3.1: three in each shoulder, one at
each elbow, two in each hip, and one in the torso, where the upper body twists against the lower.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import one_of, text, truth
from somersault.model._bodies import GROUND, Body, Joint
from somersault.model._model import Model
from somersault.model._vectors import IDENTITY, ZERO, Matrix, Vector
from somersault.model.shapes import Shape

Shoulders = Literal["hinges", "ball"]

# Hanging arms are drawn turned inward by this much, as relaxed ones are, so that the range of the
# middle shoulder hinge lies evenly about 0 and ends short of ±90°, where the other two align.
INWARD = math.radians(30)

# Ranges in degrees: American Academy of Orthopaedic Surgeons (1965) Joint Motion: Method of
# Measuring and Recording, unless said otherwise.
RANGES = {
    "torso_twist": (-45, 45),
    "shoulder_abduction": (-45, 190),  # 180 there; `furrer` has 189. Not all of its 75 inward
    "shoulder_rotation": (-72, 72),  # 42 outward to 102 inward; cut to stay off gimbal lock
    "shoulder_flexion": (-60, 180),
    "elbow": (0, 150),
    "hip_flexion": (-30, 160),  # 120 there, and 40 of the lumbar spine, which has no joint here
    "hip_abduction": (-30, 45),
    "knee": (0, 150),  # 135 there by itself, more when it is pulled into a tuck
    "ankle": (0, 125),  # from the foot in line with the shank; 35 up of 90 bearing weight, 20 there
}

FRONT, LEFT, HEAD = np.eye(3)


@dataclass(frozen=True, eq=False)
class Part:
    """Mass (kg), centre of mass (3,) in m, inertia (3, 3) about it, and looks, from some joint."""

    mass: float
    com: Array
    inertia: Array
    shapes: tuple[Shape, ...] = ()

    def moved(self, by: Array) -> Part:
        """The same part, seen from a point that lies at −`by` (3,)."""
        shapes = tuple(shape.placed(by, np.eye(3)) for shape in self.shapes)
        return Part(self.mass, self.com + by, self.inertia, shapes)

    def turned(self, rotation: Array) -> Part:
        """The same part, turned (3, 3), or mirrored, about the point it is seen from."""
        shapes = tuple(shape.placed(np.zeros(3), rotation) for shape in self.shapes)
        return Part(self.mass, rotation @ self.com, rotation @ self.inertia @ rotation.T, shapes)

    def looking(self, *shapes: Shape) -> Part:
        """The same part with these shapes."""
        return replace(self, shapes=shapes)

    def mirrored(self) -> Part:
        """The right side's part, if this is the left one's."""
        return self.turned(np.diag([1.0, -1.0, 1.0]))


def joined(*parts: Part) -> Part:
    """Several parts, seen from one point, as one rigid body."""
    mass = math.fsum(part.mass for part in parts)
    com = np.sum([part.mass * part.com for part in parts], 0) / mass
    inertia = np.zeros((3, 3))
    for part in parts:
        arm = part.com - com
        inertia += part.inertia + part.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return Part(mass, com, inertia, tuple(shape for part in parts for shape in part.shapes))


@dataclass(frozen=True, eq=False)
class Physique:
    """What an athlete is made of, standing with the arms hanging; the right side is the image
    of the left.

    Each part is seen from its inner joint, in axes front, left, head; `lower` from between the
    hips, `foot`, pointed, from the knee. The arm's parts are turned so that the elbow bends
    forward.
    Lengths in m: `twist` is the height of the torso's joint over the hips, `shoulder` and `hip` are
    places (3,) in the upper and the lower body, `upper_arm_length`, `thigh_length` and
    `shank_length` reach to the elbow, knee and ankle.
    """

    lower: Part
    upper: Part
    upper_arm: Part
    forearm: Part
    thigh: Part
    shank: Part
    foot: Part
    twist: float
    shoulder: Array
    hip: Array
    upper_arm_length: float
    thigh_length: float
    shank_length: float


def athlete_model(
    name: str, physique: Physique, shoulders: str, knees: bool, ankles: bool
) -> Model:
    """The athlete with that physique, in the air.

    Raises SomersaultError if `shoulders` is neither "hinges" nor "ball", or `knees` or `ankles` no
    truth value.
    """
    one_of("shoulders", shoulders, ("hinges", "ball"))
    text("name", name)
    knees, ankles = truth("knees", knees), truth("ankles", ankles)
    bodies = [
        _body("pelvis", GROUND, physique.lower),
        _body(
            "torso",
            0,
            physique.upper,
            physique.twist * HEAD,
            joints=(_hinge("torso_twist", HEAD),),
        ),
    ]
    for side in ("left", "right"):
        bodies += _arm(physique, side, len(bodies), shoulders)
    for side in ("left", "right"):
        bodies += _leg(physique, side, len(bodies), knees, ankles)
    return Model(name, True, tuple(bodies))


def _arm(physique: Physique, side: str, first: int, shoulders: str) -> list[Body]:
    """Upper arm, and forearm with hand; `first` is the upper arm's place among the bodies."""
    out = 1.0 if side == "left" else -1.0
    inward = _about_head(-out * INWARD)
    upper_arm, forearm = (
        part if side == "left" else part.mirrored()
        for part in (physique.upper_arm, physique.forearm)
    )
    hinges = (
        _hinge(f"{side}_shoulder_abduction", out * FRONT),
        _hinge(f"{side}_shoulder_rotation", -out * HEAD),
        _hinge(f"{side}_shoulder_flexion", -LEFT),
    )
    ball = (Joint(f"{side}_shoulder", "ball"),)
    return [
        _body(
            f"{side}_upper_arm",
            1,
            upper_arm.turned(inward),
            np.array([1.0, out, 1.0]) * physique.shoulder,
            joints=ball if shoulders == "ball" else hinges,
        ),
        _body(
            f"{side}_forearm",
            first,
            forearm,
            -physique.upper_arm_length * HEAD,
            inward,
            (_hinge(f"{side}_elbow", -LEFT),),
        ),
    ]


def _leg(physique: Physique, side: str, first: int, knees: bool, ankles: bool) -> list[Body]:
    """A leg in one to three parts; `first` is the place of the uppermost among the bodies."""
    out = 1.0 if side == "left" else -1.0
    thigh, shank, foot = (
        part if side == "left" else part.mirrored()
        for part in (physique.thigh, physique.shank, physique.foot)
    )
    knee, ankle = -physique.thigh_length * HEAD, -physique.shank_length * HEAD
    hip = np.array([1.0, out, 1.0]) * physique.hip
    joints = (
        _hinge(f"{side}_hip_flexion", -LEFT),
        _hinge(f"{side}_hip_abduction", out * FRONT),
    )
    if not ankles:
        shank = joined(shank, foot)
    if knees:
        legs = [
            _body(f"{side}_thigh", 0, thigh, hip, joints=joints),
            _body(f"{side}_shank", first, shank, knee, joints=(_hinge(f"{side}_knee", LEFT),)),
        ]
    else:
        legs = [_body(f"{side}_leg", 0, joined(thigh, shank.moved(knee)), hip, joints=joints)]
    if ankles:
        where = ankle if knees else knee + ankle
        below, hinge = first + len(legs) - 1, _hinge(f"{side}_ankle", -LEFT)
        legs.append(_body(f"{side}_foot", below, foot.moved(-ankle), where, joints=(hinge,)))
    return legs


def _hinge(name: str, axis: Array) -> Joint:
    low, high = RANGES[name.removeprefix("left_").removeprefix("right_")]
    return Joint(name, "hinge", axis=_vector(axis), limits=(math.radians(low), math.radians(high)))


def _body(
    name: str,
    parent: int,
    part: Part,
    position: Array | None = None,
    rotation: Array | None = None,
    joints: tuple[Joint, ...] = (),
) -> Body:
    return Body(
        name,
        parent,
        float(part.mass),
        _vector(part.com),
        _matrix((part.inertia + part.inertia.T) / 2),
        ZERO if position is None else _vector(position),
        IDENTITY if rotation is None else _matrix(rotation),
        joints,
        part.shapes,
    )


def _about_head(angle: float) -> Array:
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def _vector(values: Any) -> Vector:
    x, y, z = (float(v) + 0.0 for v in values)  # no negative zeros
    return x, y, z


def _matrix(rows: Any) -> Matrix:
    return _vector(rows[0]), _vector(rows[1]), _vector(rows[2])
