"""Bodies and joints of a `.osim` file, however its version writes them down.

Before version 4 a joint stands within the body that it moves, and its places in both bodies are
its own properties. Since then joints stand by themselves and connect frames by their paths, such
as `/bodyset/pelvis` or `../ground_offset`, and a frame may be offset from another one.
"""

from __future__ import annotations

import posixpath
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from somersault._core.array import Array
from somersault.model._vectors import ZERO, Matrix, Vector, as_vector
from somersault.model.read._osim_joints import KINDS, Links, frame, moves
from somersault.model.read._osim_words import Words
from somersault.model.read._xml import Element

GROUND_NAME = "ground"
_MOST_BODIES = 2000
_NOTHING: Matrix = (ZERO, ZERO, ZERO)
_SETS = {"BodySet": "bodyset", "JointSet": "jointset", "ComponentSet": "componentset"}


@dataclass(frozen=True, slots=True)
class Part:
    """A body's name, mass (kg), centre of mass (m) and inertia about it (kg m2), in its axes."""

    name: str
    mass: float
    com: Vector
    inertia: Matrix


def parts_and_links(words: Words, model: Element) -> tuple[dict[str, Part], list[Links], Frames]:
    """All bodies but the ground by their names, all joints in the order of the file, and all
    frames."""
    _refuse_files(words, model)
    parts, links, apart = dict[str, Part](), list[Links](), list[tuple[Element, str]]()
    frames = Frames(words)
    for element, path in components(model, ""):
        name = element.attributes.get("name", "")
        if element.tag == "Body":
            if name.lower() != GROUND_NAME:
                if name in parts or not name:
                    raise words.error("has no name, or that of another body; rename it", element)
                parts[name] = _part(words, element)
                frames.add_body(path, name)
            links += [_within(words, joint, name) for joint in element.below("Joint")]
        elif element.tag.endswith("Frame"):
            frames.add(path, element)
        elif element.tag.endswith("Joint") and element.tag != "Joint":
            apart.append((element, path))
        if len(parts) > _MOST_BODIES:
            raise words.error(f"is one of over {_MOST_BODIES} bodies; is this one model?", element)
    links += [_apart(words, frames, joint, path) for joint, path in apart]
    for link in links:
        for end in (link.parent, link.child):
            if end != GROUND_NAME and end not in parts:
                raise words.error(
                    f"joins the body {end!r}, which the model has not; correct it", link.element
                )
    return parts, links, frames


def _refuse_files(words: Words, model: Element) -> None:
    for element in model.children:
        if element.attributes.get("file") and element.tag in _SETS:
            raise words.error(
                f"is in another file, {element.attributes['file'][:80]!r}, which is not opened; "
                "put its contents here",
                element,
            )


def components(element: Element, path: str) -> Iterator[tuple[Element, str]]:
    """Everything that may be a body, a joint or a frame, with its path, in the file's order."""
    for child in element.children:
        here = f"{path}/{child.attributes.get('name', '')}"
        if child.tag in _SETS:
            yield from components(child, f"/{_SETS[child.tag]}")
        elif child.tag in ("objects", "components", "frames"):
            yield from components(child, path)
        elif child.tag.endswith(("Body", "Joint", "Frame")) and child.tag != "Joint":
            yield child, here
            yield from components(child, here)


def _part(words: Words, body: Element) -> Part:
    mass = words.number(body, "mass")
    if mass < 0:
        raise words.error(f"has the negative mass {mass:g}; masses are positive", body)
    com = words.numbers(body, "mass_center", ZERO, 3)
    if words.child(body, "inertia") is None:  # before version 4
        entries = [
            _six_digits(words.number(body, f"inertia_{which}", 0.0))
            for which in ("xx", "yy", "zz", "xy", "xz", "yz")
        ]
    else:
        entries = words.numbers(body, "inertia", count=6)
    xx, yy, zz, xy, xz, yz = entries
    inertia = ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
    # OpenSim too takes no inertia from a body without mass.
    return Part(
        body.attributes["name"], mass, as_vector(np.array(com)), inertia if mass else _NOTHING
    )


# ------------------------------------------------------------------ a joint within its body


def _within(words: Words, joint: Element, child: str) -> Links:
    if joint.tag not in KINDS:
        raise _unknown(words, joint)
    link = Links(
        name=joint.attributes.get("name", ""),
        parent=_body_name(words.text(joint, "parent_body", GROUND_NAME)),
        child=child,
        in_parent=_placed(words, joint, "location_in_parent", "orientation_in_parent"),
        in_child=_placed(words, joint, "location", "orientation"),
        moves=moves(words, joint),
        element=joint,
    )
    return _reversed(link) if words.truth(joint, "reverse") else link


def _placed(words: Words, joint: Element, position: str, angles: str) -> Array:
    """A joint's frame in a body, of a file before version 4."""
    return frame(
        *(
            [_six_digits(x) for x in words.numbers(joint, name, ZERO, 3)]
            for name in (position, angles)
        )
    )


def _six_digits(value: float) -> float:
    """What OpenSim 4 makes of joints' places and bodies' inertias in older files: it rounds them
    as it converts the file. So do we, or mass matrices would differ in the seventh digit."""
    return float(f"{value:.6g}")


def _reversed(link: Links) -> Links:
    """A joint whose coordinates are those of the parent's frame seen from the child's.

    Its parent and child stay, and so do the joint's frames in them.
    """
    return Links(
        link.name,
        link.parent,
        link.child,
        link.in_parent,
        link.in_child,
        tuple(move.backwards for move in reversed(link.moves)),
        link.element,
    )


def _body_name(path: str) -> str:
    name = path.rpartition("/")[2]
    return GROUND_NAME if name.lower() == GROUND_NAME else name


def _offset(words: Words, element: Element, position: str, angles: str) -> Array:
    return frame(words.numbers(element, position, ZERO, 3), words.numbers(element, angles, ZERO, 3))


def _unknown(words: Words, joint: Element) -> Exception:
    return words.error(
        f"is of a kind that is not supported; use one of {', '.join(KINDS)}",
        joint,
    )


# ------------------------------------------------------------------- joints between frames


class Frames:
    """Frames by their paths: where each is fixed, to which body."""

    def __init__(self, words: Words) -> None:
        self._words = words
        self._bodies: dict[str, str] = {}
        self._offsets: dict[str, Element] = {}
        self._named: dict[str, list[str]] = {}
        self.add_body(f"/{GROUND_NAME}", GROUND_NAME)

    def add_body(self, path: str, name: str) -> None:
        self._bodies[path] = name
        self._name(path)

    def add(self, path: str, element: Element) -> None:
        self._offsets[path] = element
        self._name(path)

    def _name(self, path: str) -> None:
        self._named.setdefault(path.rpartition("/")[2], []).append(path)

    def find(self, path: str, at: str, asks: Element) -> tuple[str, Array]:
        """The body to which the frame at a path is fixed, and the frame in it.

        The path may be relative to the component that stands at `at` and `asks` for it.
        """
        chain = np.eye(4)
        for _ in range(len(self._offsets) + 1):
            path = self._full(path, at, asks)
            if path in self._bodies:
                return self._bodies[path], chain
            element = self._offsets[path]
            if element.tag != "PhysicalOffsetFrame":
                raise self._words.error(
                    "is a frame of a kind that is not read; use a PhysicalOffsetFrame", element
                )
            chain = _offset(self._words, element, "translation", "orientation") @ chain
            path, at, asks = _socket(self._words, element, "parent"), path, element
        raise self._words.error("is offset from itself; give it a body as its parent", asks)

    def _full(self, path: str, at: str, asks: Element) -> str:
        full = posixpath.normpath(posixpath.join(at, path))
        if full in self._bodies or full in self._offsets:
            return full
        name = path.rpartition("/")[2]  # OpenSim finds by name what is not at its path
        named = self._named.get(name, [])
        if len(named) != 1:
            raise self._words.error(
                f"refers to the frame {path[:80]!r}, of which there are {len(named)}; correct its "
                "path",
                asks,
            )
        return named[0]


def _socket(words: Words, element: Element, name: str) -> str:
    """The path that a socket is connected to, as several versions write it."""
    for written in (f"socket_{name}", f"socket_{name}_connectee_name"):
        if path := words.text(element, written):
            return path
    for connector in element.below("connectors"):
        if connector.attributes.get("name") == name:
            return words.text(connector, "connectee_name")
    raise words.error(f"has no socket_{name}; say what it is joined to", element)


def _apart(words: Words, frames: Frames, joint: Element, path: str) -> Links:
    if joint.tag not in KINDS:
        raise _unknown(words, joint)
    ends = [
        frames.find(_socket(words, joint, f"{end}_frame"), path, joint)
        for end in ("parent", "child")
    ]
    (parent, in_parent), (child, in_child) = ends
    return Links(
        joint.attributes.get("name", ""),
        parent,
        child,
        in_parent,
        in_child,
        moves(words, joint),
        joint,
    )
