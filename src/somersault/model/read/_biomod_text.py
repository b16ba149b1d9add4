"""The segments in the text of a `.bioMod` file.

What each word means follows biorbd's own reader (pyomeca/biorbd, src/ModelReader.cpp). It skips
what it does not know in silence; here an unknown word is a mistake, for it is mostly a known one
misspelt. Words are known in small and capital letters alike, names only as they are written.
"""

from __future__ import annotations

import difflib
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from somersault._core.errors import SomersaultError
from somersault.model._vectors import IDENTITY, ZERO, Matrix, Vector
from somersault.model._weld import Array, as_matrix, as_vector
from somersault.model.read._biomod_words import Words, shown

AXES: dict[str, Vector] = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}

NOTHING: Matrix = (ZERO, ZERO, ZERO)

# Blocks that have no part in flight: the words that end them, and what to call them.
_IGNORED = {
    "marker": (("endmarker",), "marker"),
    "imu": (("endimu", "endmimu", "endcustomrt"), "IMU"),
    "mimu": (("endimu", "endmimu", "endcustomrt"), "IMU"),
    "customrt": (("endimu", "endmimu", "endcustomrt"), "custom frame"),
    "contact": (("endcontact",), "contact"),
    "softcontact": (("endsoftcontact",), "soft contact"),
    "actuator": (("endactuator",), "actuator"),
    "scalingsegment": (("endscalingsegment",), "scaling rule"),
}
_MUSCLE = "flight is computed without muscles; delete its block and move the joint in the flight"
_REFUSED = {
    "musclegroup": _MUSCLE,
    "muscle": _MUSCLE,
    "viapoint": _MUSCLE,
    "wrapping": _MUSCLE,
    "ligament": "flight is computed without ligaments; delete its block or spring the joint",
    "passivetorque": "flight has springs and dampers; delete its block and spring the joint",
    "loopconstraint": "a body in the air is a tree without loops; delete its block or cut the loop",
}
_HEADER = {
    "root_actuated",
    "external_forces",
    "mesh_folder_prefix",
}  # one word each, no matter here
_TOP = ["segment", "variables", "gravity", *_IGNORED, *_REFUSED, *_HEADER]
_ENDS = {"endsegment", "endvariables", *(end for ends, _ in _IGNORED.values() for end in ends)}

_RANGES = {"ranges", "rangesq", "rangesqdot", "rangesqddot", "jointdampings"}
_DIGITS = "+-.0123456789"
_GROUND = ("root", "ROOT")  # biorbd's name and RBDL's, case and all; a segment may be Root
_BASES = {"root", "base", "none", "ground", "world"}  # seen in files; biorbd knows only root
_MOST_SEGMENTS = 1000  # the largest athletes have some 150
_DUST = 1e-8  # kg, kg m2: biorbd's own default mass, there only to keep its matrices regular


@dataclass(slots=True)
class Segment:
    """One segment as the file gives it; see `Body` for the meaning of the numbers."""

    name: str
    matrix: bool
    parent: str = "root"
    translations: str = ""
    rotations: str = ""
    limits: list[tuple[float, float]] = field(default_factory=list)
    dampings: list[float] = field(default_factory=list)
    mass: float = 0.0
    com: Vector = ZERO
    inertia: Matrix = NOTHING
    position: Vector = ZERO
    rotation: Matrix = IDENTITY
    placed: bool = False  # its rt has been read


class File:
    """One pass over the words of a file."""

    def __init__(self, words: Words) -> None:
        self.words = words
        self.version = 0.0
        self.segments: dict[str, Segment] = {}
        self.ignored: Counter[str] = Counter()
        self._readers: dict[str, Callable[[Segment, str], None]] = {
            "parent": self._parent,
            "translations": self._translations,
            "rotations": self._rotations,
            "ranges": self._limits,
            "rangesq": self._limits,
            "rangesqdot": self._rate_limits,
            "rangesqddot": self._rate_limits,
            "jointdampings": self._dampings,
            "mass": self._mass,
            "com": self._com,
            "centerofmass": self._com,
            "inertia": self._inertia,
            "inertiamatrix": self._inertia,
            "inertia_xxyyzz": self._inertia,
            "rtinmatrix": self._rtinmatrix,
            "rt": self._rt,
            "mesh": self._three,
            "patch": self._three,
            "meshcolor": self._three,
            "meshscale": self._three,
            "meshrt": self._meshrt,
            "meshfile": self._one,
            "ply": self._one,
            "forceplate": self._one,
            "externalforceindex": self._one,
        }

    # --------------------------------------------------------------------- the whole file

    def read(self) -> None:
        """Read everything; afterwards `segments` and `ignored` hold it."""
        words = self.words
        first = words.next()
        if first is None or first.lower() != "version":
            raise words.error("a bioMod file starts with the word version; is this one?")
        self.version = words.number("the version")
        if self.version not in (1, 2, 3, 4):
            raise words.error("its version is none of 1, 2, 3 and 4; save it as version 4")
        while (word := words.next()) is not None:
            self._element(word)

    def _element(self, word: str) -> None:
        words, key = self.words, word.lower()
        if key == "segment":
            self._segment()
        elif key == "variables":
            self._variables()
        elif key == "gravity":
            words.numbers(3, "gravity")
            self.ignored["gravity"] = 0
        elif key in _HEADER:
            words.word(f"the value of {key}")
        elif key in _IGNORED:
            self._skip(key)
        elif key in _REFUSED:
            line = words.line
            name = "" if key == "loopconstraint" else f" {shown(words.word('its name'))}"
            raise words.error(f"there is a {key}{name}, but {_REFUSED[key]}", line)
        else:
            raise self._unknown(word, _TOP)

    def _variables(self) -> None:
        line = self.words.line
        while (word := self.words.word("endvariables")).lower() != "endvariables":
            if word.lower() in _TOP:
                raise self.words.error("the variables never end; add endvariables", line)
            self.words.variable(word)

    def _skip(self, key: str) -> None:
        """Pass over a block that has no part in flight, but not over the rest of the file."""
        line, (ends, kind) = self.words.line, _IGNORED[key]
        name = self.words.word(f"the name of the {key}")
        while (word := self.words.next()) is not None:
            at_start, word = self.words.starts_line, word.lower()
            if word in ends:
                self.ignored[kind] += 1
                return
            if word in _ENDS or (at_start and word == "segment"):
                break
        raise self.words.error(f"the {key} {shown(name)} never ends; add {ends[0]}", line)

    def _unknown(self, word: str, known: list[str]) -> SomersaultError:
        if word[0] in _DIGITS:
            return self.words.error(
                f"the number {shown(word)} is one too many; remove it or add the word it belongs to"
            )
        near = difflib.get_close_matches(word[:40].lower(), known, 1)
        mend = f"did you mean {near[0]}?" if near else "remove it or correct it"
        return self.words.error(f"{shown(word)} is not a word of the format here; {mend}")

    # -------------------------------------------------------------------------- a segment

    def _segment(self) -> None:
        words = self.words
        line = words.line
        name = words.word("the name of the segment")
        if name in _GROUND:
            raise words.error(f"a segment cannot be named {name}, the ground's name; rename it")
        if name in self.segments:
            raise words.error(f"there are two segments {shown(name)}; rename one of them")
        if len(self.segments) == _MOST_SEGMENTS:
            raise words.error(
                f"there are more than {_MOST_SEGMENTS} segments; is this one athlete?"
            )
        segment = Segment(name, matrix=self.version < 3)  # version 3 turned the default round
        seen: set[str] = set()
        last = ""
        while (word := words.next()) is not None:
            key = word.lower()
            if key == "endsegment":
                if segment.mass == 0 and np.abs(segment.inertia).max() <= _DUST:
                    segment.inertia = NOTHING
                self.segments[name] = segment
                return
            if key in _ENDS or (words.starts_line and key in _TOP):
                break
            if not _speeds(segment) and last in _RANGES and word[0] in _DIGITS:
                continue  # ranges left behind when the axes were commented out, as biorbd has it
            if key not in self._readers:
                raise self._unknown(word, [*self._readers, "endsegment"])
            if key in seen and key not in ("mesh", "patch"):
                raise words.error(f"segment {shown(name)} has {key} twice; remove one of them")
            if key in ("translations", "rotations") and not seen.isdisjoint(_RANGES):
                raise words.error(f"{key} stand below the ranges of their axes; put them above")
            seen.add(last := key)
            self._readers[key](segment, key)
        raise words.error(f"segment {shown(name)} never ends; add endsegment", line)

    def _parent(self, segment: Segment, key: str) -> None:
        name = self.words.word("the name of the parent")
        if name.lower() in _BASES and name not in self.segments:
            name = "root"
        elif name not in self.segments:
            raise self.words.error(
                f"the parent {shown(name)} of {shown(segment.name)} is not a segment above it; "
                "correct the name or put the parent first"
            )
        segment.parent = name

    def _translations(self, segment: Segment, key: str) -> None:
        word = self._sequence(segment, key)
        if len(set(word)) < len(word):
            raise self.words.error(f"translations {shown(word)} name an axis twice; name it once")
        segment.translations = word

    def _rotations(self, segment: Segment, key: str) -> None:
        word = self._sequence(segment, key)
        if len(word) > 3 or any(a == b for a, b in pairwise(word)):
            raise self.words.error(
                f"rotations {shown(word)} turn about one axis twice; give at most three axes, "
                "neighbours different"
            )
        segment.rotations = word

    def _sequence(self, segment: Segment, key: str) -> str:
        word = self.words.word(f"the axes of {key}").lower()
        if not (set(word) <= set("xyz") or (key == "rotations" and word == "q")):
            raise self.words.error(
                f"{key} {shown(word)} are not axes; write some of x, y and z"
                + (", or q for a quaternion" if key == "rotations" else "")
            )
        return word

    def _limits(self, segment: Segment, key: str) -> None:
        # A quaternion has four ranges that say nothing of its angles; they are read, not used.
        turns = 4 if segment.rotations == "q" else len(segment.rotations)
        slides = len(segment.translations)
        total = f"it has {slides + turns}: {slides} for translations, {turns} for rotations"
        for number in range(slides + turns):
            low, high = (
                self.words.number(
                    f"the {end} of range {number + 1} of {shown(segment.name)} ({total})"
                )
                for end in ("start", "end")
            )
            if low > high:
                raise self.words.error(
                    f"range {number + 1} of {shown(segment.name)} runs from {low:g} down to "
                    f"{high:g}; give the smaller first"
                )
            segment.limits.append((low, high))

    def _rate_limits(self, segment: Segment, key: str) -> None:
        self.words.numbers(2 * _speeds(segment), f"{key} of {shown(segment.name)}")

    def _dampings(self, segment: Segment, key: str) -> None:
        segment.dampings = self.words.numbers(_speeds(segment), f"{key} of {shown(segment.name)}")
        if min(segment.dampings, default=0.0) < 0:
            raise self.words.error(f"{key} hold a negative number; damping takes energy away")
        if segment.rotations == "q" and len(set(segment.dampings[-3:])) > 1:
            raise self.words.error(
                f"the three {key} of the quaternion differ; give one damping for all three"
            )

    def _mass(self, segment: Segment, key: str) -> None:
        mass = self.words.number(f"the mass of {shown(segment.name)}")
        if mass < 0:
            raise self.words.error(f"the mass {mass:g} is negative; masses are positive")
        segment.mass = 0.0 if mass <= _DUST else mass

    def _com(self, segment: Segment, key: str) -> None:
        segment.com = as_vector(
            np.array(self.words.numbers(3, f"the {key} of {shown(segment.name)}"))
        )

    def _inertia(self, segment: Segment, key: str) -> None:
        what = f"the inertia of {shown(segment.name)}"
        if key == "inertia_xxyyzz":
            inertia = np.diag(self.words.numbers(3, what))
        else:
            inertia = np.array(self.words.numbers(9, what)).reshape(3, 3)
        if np.abs(inertia - inertia.T).max() > 1e-6 * np.abs(inertia).max():
            raise self.words.error(f"{what} is not symmetric; make it symmetric")
        segment.inertia = as_matrix(inertia)

    def _rtinmatrix(self, segment: Segment, key: str) -> None:
        if segment.placed:
            raise self.words.error("rtinmatrix stands below its rt; put it above")
        segment.matrix = self.words.number("rtinmatrix") != 0

    def _rt(self, segment: Segment, key: str) -> None:
        what = f"rt of {shown(segment.name)}"
        if segment.matrix:
            numbers = np.array(self.words.numbers(16, what)).reshape(4, 4)
            if np.abs(numbers[3] - (0, 0, 0, 1)).max() > 1e-6:
                raise self.words.error(f"{what} does not end with 0 0 0 1; give a 4 by 4 matrix")
            rotation, position = self._orthogonal(numbers[:3, :3], what), numbers[:3, 3]
        else:
            rotation, position = self._turned(what)
        segment.position, segment.rotation = as_vector(position), as_matrix(rotation)
        segment.placed = True

    def _turned(self, what: str) -> tuple[Array, Array]:
        """Three angles in rad, their carried axes, and a translation in m."""
        angles = self.words.numbers(3, f"the angles of {what}")
        axes = self.words.word(f"the axes of {what}").lower()
        if len(axes) != 3 or not set(axes) <= set("xyz"):
            raise self.words.error(
                f"{shown(axes)} are not the three axes of {what}; write xyz or another sequence, "
                "or rtinmatrix 1 above a matrix"
            )
        rotation = np.eye(3)
        for angle, axis in zip(angles, axes, strict=True):
            rotation = rotation @ _about(axis, angle)
        return rotation, np.array(self.words.numbers(3, f"the translation of {what}"))

    def _orthogonal(self, matrix: Array, what: str) -> Array:
        """The nearest orthogonal matrix, for files that round theirs to a few digits."""
        if np.abs(matrix).max() < 2:
            left, _, right = np.linalg.svd(matrix)
            if np.abs(left @ right - matrix).max() < 1e-3:
                return np.asarray(left @ right)
        raise self.words.error(f"{what} is not a rotation; give it orthonormal columns")

    def _three(self, segment: Segment, key: str) -> None:
        self.words.numbers(3, f"{key} of {shown(segment.name)}")
        self.ignored["meshes"] = 0

    def _meshrt(self, segment: Segment, key: str) -> None:
        self._turned(f"{key} of {shown(segment.name)}")

    def _one(self, segment: Segment, key: str) -> None:
        self.words.word(f"the value of {key}")
        if key in ("meshfile", "ply"):
            self.ignored["meshes"] = 0


def _speeds(segment: Segment) -> int:
    turns = 3 if segment.rotations == "q" else len(segment.rotations)
    return len(segment.translations) + turns


def _about(axis: str, angle: float) -> Array:
    """Rotation matrix about one axis, right-handed, carried to fixed."""
    cross = np.cross(np.eye(3), AXES[axis])
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross)
