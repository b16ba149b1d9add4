"""Joints of `.osim` files as moves, one after another, of a child's frame from its parent's.

Meanings are OpenSim's (opensim-org/opensim-core, OpenSim/Simulation/SimbodyEngine): every joint
moves first along axes of the parent's frame, then turns about axes that are carried along.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from somersault._core.array import Array
from somersault.model.read._osim_functions import Function, Line, function
from somersault.model.read._osim_words import Words
from somersault.model.read._xml import Element

_X, _Y, _Z = np.eye(3)

# In the order of a joint's coordinates: whether one turns, and its axis.
FREE = ((True, _X), (True, _Y), (True, _Z), (False, _X), (False, _Y), (False, _Z))
_SEQUENCES: dict[str, tuple[tuple[bool, Array], ...]] = {
    "WeldJoint": (),
    "PinJoint": ((True, _Z),),
    "SliderJoint": ((False, _X),),
    "UniversalJoint": ((True, _X), (True, _Y)),
    "BallJoint": ((True, _X), (True, _Y), (True, _Z)),
    "GimbalJoint": ((True, _X), (True, _Y), (True, _Z)),
    "PlanarJoint": ((True, _Z), (False, _X), (False, _Y)),
    "FreeJoint": FREE,
}
KINDS = (*_SEQUENCES, "CustomJoint")
_AXES = [f"{kind}{number}" for kind in ("rotation", "translation") for number in (1, 2, 3)]
_COLLINEAR = 1e-5  # OpenSim's tolerance


@dataclass(frozen=True, slots=True)
class Coordinate:
    """A generalized coordinate; its limits are None unless they are kept (`clamped`)."""

    name: str
    default: float = 0.0
    range: tuple[float, float] = (-10.0, 10.0)
    clamped: bool = False
    locked: bool = False
    prescribed: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class Move:
    """A turn about an axis, or a shift along it, by a function of a coordinate (rad or m)."""

    name: str
    turns: bool
    axis: Array
    coordinate: Coordinate | None
    function: Function

    def transform(self, value: float) -> Array:
        """The frame after a move by `value` in the frame before it, (4, 4)."""
        moved = np.eye(4)
        if self.turns:
            moved[:3, :3] = rotation(self.axis, value)
        else:
            moved[:3, 3] = value * self.axis
        return moved

    @property
    def backwards(self) -> Move:
        return replace(self, axis=-self.axis)


@dataclass(frozen=True, slots=True, eq=False)
class Links:
    """A joint between two bodies, `moves` of the child's frame in the parent's, in their order."""

    name: str
    parent: str
    child: str
    in_parent: Array
    in_child: Array
    moves: tuple[Move, ...]
    element: Element | None

    @property
    def backwards(self) -> Links:
        """The same joint seen from its child."""
        moves = tuple(move.backwards for move in reversed(self.moves))
        return replace(
            self,
            parent=self.child,
            child=self.parent,
            in_parent=self.in_child,
            in_child=self.in_parent,
            moves=moves,
        )


def rotation(axis: Array, angle: float) -> Array:
    """The rotation matrix about a unit vector."""
    cross = np.cross(np.eye(3), axis)
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross)


def frame(position: list[float], angles: list[float]) -> Array:
    """A frame at a position, turned about x, y, z, each carried by the turns before, (4, 4)."""
    placed = np.eye(4)
    for axis, angle in zip(np.eye(3), angles, strict=True):
        placed[:3, :3] = placed[:3, :3] @ rotation(axis, angle)
    placed[:3, 3] = position
    return placed


def moves(words: Words, joint: Element) -> tuple[Move, ...]:
    """The moves of a joint of any kind, shifts first."""
    if joint.tag == "CustomJoint":
        found = _custom(words, joint)
    else:
        sequence = _SEQUENCES[joint.tag]
        declared = _coordinates(words, joint)
        if len(declared) > len(sequence):
            raise words.error(
                f"has {len(declared)} coordinates, and its kind has {len(sequence)}; remove the "
                "others",
                joint,
            )
        names = [f"{joint.attributes.get('name')}_coord_{k}" for k in range(len(sequence))]
        coordinates = [*declared.values(), *map(Coordinate, names[len(declared) :])]
        found = [
            Move(coordinate.name, turns, axis, coordinate, Line(1.0))
            for (turns, axis), coordinate in zip(sequence, coordinates, strict=True)
        ]
    return tuple(sorted(found, key=lambda move: move.turns))


def _coordinates(words: Words, joint: Element) -> dict[str, Coordinate]:
    """The coordinates that a joint declares, by name."""
    found: dict[str, Coordinate] = {}
    for element in (*joint.below("coordinates"), *joint.below("CoordinateSet", "objects")):
        low, high = words.numbers(element, "range", (-10.0, 10.0), 2)
        coordinate = Coordinate(
            name=element.attributes.get("name", ""),
            default=words.number(element, "default_value", 0.0),
            range=(min(low, high), max(low, high)),
            clamped=words.truth(element, "clamped"),
            locked=words.truth(element, "locked"),
            prescribed=words.truth(element, "prescribed"),
        )
        if coordinate.name in found:
            raise words.error(f"has two coordinates named {coordinate.name!r}; rename one", joint)
        if coordinate.clamped and low > high:
            raise words.error(f"has a range from {low:g} down to {high:g}; swap its ends", element)
        found[coordinate.name] = coordinate
    return found


def _custom(words: Words, joint: Element) -> list[Move]:
    """The six axes of a CustomJoint: turns about the first three, shifts along the others."""
    declared = _coordinates(words, joint)
    elements: dict[str, Element] = {}
    for element in joint.below("SpatialTransform"):
        elements.setdefault(element.attributes.get("name", ""), element)
    found = []
    for number, name in enumerate(_AXES):
        axis = np.eye(3)[number % 3]
        if name in elements:
            found.append(_axis(words, elements[name], number < 3, axis, declared))
        else:
            found.append(Move(name, number < 3, axis, None, Line(0.0)))
    for three in (found[:3], found[3:]):
        for one, other in ((0, 1), (0, 2), (1, 2)):
            if np.linalg.norm(np.cross(three[one].axis, three[other].axis)) < _COLLINEAR:
                raise words.error(
                    f"has {three[one].name} and {three[other].name} about the same axis; give the "
                    "three axes different directions",
                    joint,
                )
    return found


def _axis(
    words: Words, element: Element, turns: bool, default: Array, declared: dict[str, Coordinate]
) -> Move:
    """The move of a TransformAxis."""
    axis = np.array(words.numbers(element, "axis", default.tolist(), 3))
    length = float(np.linalg.norm(axis))
    if length == 0:
        raise words.error("has an axis of length zero; give it a direction", element)
    names = words.text(element, "coordinates").split()
    if len(names) > 1:
        raise words.error(
            f"is moved by {len(names)} coordinates at once, {' and '.join(names[:2])}, which is "
            "not supported; give it one",
            element,
        )
    coordinate = declared.get(names[0], Coordinate(names[0])) if names else None
    by: Function = Line(0.0 if coordinate is None else 1.0)
    inside = element.first("function") or element  # since version 4 the function's own element
    functions = [f for f in inside.children if f.tag not in ("coordinates", "axis")]
    if functions:
        by = function(words, functions[0])
    if coordinate is None and not (isinstance(by, Line) and by.slope == 0):
        raise words.error("has a function but no coordinate; name one", element)
    return Move(element.attributes["name"], turns, axis / length, coordinate, by)
