"""What the words of a segment of a `.bioMod` file mean.

Meanings follow biorbd's own reader (pyomeca/biorbd, src/ModelReader.cpp).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from somersault._core.array import Array
from somersault.model._vectors import IDENTITY, ZERO, Matrix, Vector, as_matrix, as_vector
from somersault.model.read._biomod_look import Look
from somersault.model.read._biomod_words import Words, shown

AXES: dict[str, Vector] = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
GROUND_PARENT = ""

NOTHING: Matrix = (ZERO, ZERO, ZERO)

_BASES = {"root", "base", "none", "ground", "world"}  # seen in files; biorbd knows only root
_EXACT = 1e-9  # a matrix so near to a rotation is one
DUST = 1e-8  # kg, kg m2: biorbd's own default mass, there only to keep its matrices regular


@dataclass(slots=True)
class Segment:
    """One segment as the file gives it; see `Body` for the meaning of the numbers.

    `hung` says whether the file names its parent.
    """

    name: str
    matrix: bool
    parent: str
    hung: bool = False
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
    look: Look = field(default_factory=Look)


class Properties:
    """Readers of the properties of segments, by their words in small letters.

    `segments` are those above the one that is read; `ignored` counts what has no part in flight.
    """

    def __init__(
        self, words: Words, segments: Mapping[str, Segment], ignored: Counter[str]
    ) -> None:
        self.words = words
        self._segments = segments
        self._ignored = ignored
        self.readers: dict[str, Callable[[Segment, str], None]] = {
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
            "mesh": self._mesh,
            "patch": self._mesh,
            "meshcolor": self._mesh,
            "meshscale": self._mesh,
            "meshrt": self._meshrt,
            "meshfile": self._meshfile,
            "ply": self._meshfile,
            "forceplate": self._one,
            "externalforceindex": self._one,
        }

    def known(self, parent: str) -> str | None:
        """The segment of that name, or the ground; None if there is none."""
        if parent in self._segments:
            return parent
        return GROUND_PARENT if parent.lower() in _BASES else None

    def _parent(self, segment: Segment, key: str) -> None:
        name = self.words.word("the name of the parent")
        parent = self.known(name)
        if parent is None:
            raise self.words.error(
                f"the parent {shown(name)} of {shown(segment.name)} is not a segment above it; "
                "correct the name or put the parent first"
            )
        segment.parent, segment.hung = parent, True

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
                self.words.strange.add(
                    "ranges the wrong way round, and so swapped",
                    self.words.at(f"{low:g} {high:g} of {segment.name}"),
                )
            segment.limits.append((min(low, high), max(low, high)))

    def _rate_limits(self, segment: Segment, key: str) -> None:
        self.words.numbers(2 * speeds(segment), f"{key} of {shown(segment.name)}")

    def _dampings(self, segment: Segment, key: str) -> None:
        segment.dampings = self.words.numbers(speeds(segment), f"{key} of {shown(segment.name)}")
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
        segment.mass = 0.0 if mass <= DUST else mass

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
        if np.any(inertia != inertia.T):
            self.words.strange.add(
                "inertias that are not symmetric, of which the lower half counts, as in biorbd",
                segment.name,
            )
        segment.inertia = as_matrix(np.tril(inertia) + np.tril(inertia, -1).T)

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
            off = np.abs(left @ right - matrix).max()
            if off < 1e-3:
                if off > _EXACT:
                    self.words.strange.add(
                        "matrices of few digits, made rotations (biorbd takes them as they are)",
                        f"{what} (by {off:.1g})",
                    )
                return np.asarray(left @ right)
        raise self.words.error(f"{what} is not a rotation; give it orthonormal columns")

    def _mesh(self, segment: Segment, key: str) -> None:
        numbers = self.words.numbers(3, f"{key} of {shown(segment.name)}")
        look = segment.look
        if key == "mesh":
            look.points.append(numbers)
        elif key == "patch":
            look.patches.append(numbers)
        elif key == "meshcolor":
            look.paint(numbers)
        else:
            look.move(np.diag(numbers), np.zeros(3))

    def _meshrt(self, segment: Segment, key: str) -> None:
        segment.look.move(*self._turned(f"{key} of {shown(segment.name)}"))

    def _meshfile(self, segment: Segment, key: str) -> None:
        segment.look.take(self.words.word(f"the value of {key}"))

    def _one(self, segment: Segment, key: str) -> None:
        self.words.word(f"the value of {key}")


def speeds(segment: Segment) -> int:
    """Its degrees of freedom."""
    turns = 3 if segment.rotations == "q" else len(segment.rotations)
    return len(segment.translations) + turns


def _about(axis: str, angle: float) -> Array:
    """Rotation matrix about one axis, right-handed, carried to fixed."""
    cross = np.cross(np.eye(3), AXES[axis])
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross)
