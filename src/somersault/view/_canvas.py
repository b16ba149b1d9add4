"""A picture that triangles are drawn on, with their shadows on the ground."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from somersault._core.array import Array
from somersault.view._eye import Eye
from somersault.view._ground import BACKDROP, NUMBERS, numbers_of
from somersault.view._raster import functions

LAMP = (0.60, -0.42, 0.75)  # where light comes from, seen from the eye's azimuth: front, left, up
_SHADE = 44  # cover of a shadow, of 255


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangles to be drawn, in one place for all frames of a film.

    `faces` (m, 3), and `paints` (m, 4): red, green and blue from 0 to 1, and 1 where what is turned
    away from the eye is hidden by the rest, as of any closed surface.
    """

    faces: Array
    paints: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "faces", np.ascontiguousarray(self.faces, np.int32))
        object.__setattr__(self, "paints", np.ascontiguousarray(self.paints, np.float32))


@dataclass(frozen=True)
class Ground:
    """A level plane with a grid: its height, the spacing of its lines, and how far and about which
    point it is seen, m."""

    level: float
    spacing: float
    reach: float
    middle: tuple[float, float]


@dataclass(eq=False)
class Canvas:
    """A picture of `width` × `height` pixels; 2 × 2 samples each."""

    width: int
    height: int
    frame: Array = field(init=False)

    def __post_init__(self) -> None:
        self._wide = -8 * (-self.width // 8)  # whole vectors
        rows, row = 2 * self.height, 2 * self._wide + 8
        self.frame = np.empty((self.height, self._wide), np.uint32)
        self._solid, self._ghost = (np.zeros((rows, row), np.uint32) for _ in range(2))
        self._near = np.zeros((rows, row), np.float32)
        self._box = [self._wide, 0, self.height, 0]
        self._backdrop: tuple[object, Array] | None = None

    @property
    def image(self) -> Array:
        """Red, green, blue and 255, (height, width, 4) bytes."""
        return self.frame.view(np.uint8).reshape(self.height, self._wide, 4)[:, : self.width]

    def begin(self, eye: Eye, ground: Ground | None) -> None:
        """Paint backdrop and ground; as it was, if nothing moved."""
        plane = (0.0, 1.0, 0.0, 0.0, 1.0, 0.0) if ground is None else (
            ground.level, ground.spacing, *ground.middle, ground.reach, 1.0)  # fmt: skip
        right, up, back = eye.rows
        middle = (eye.width / 2, eye.height / 2)
        given = numbers_of(eye.position, -eye.focal * back, right, up, middle, plane)
        assert len(given) == NUMBERS
        if self._backdrop is None or self._backdrop[0] != given:
            numbers = np.array(given, np.float32)
            functions()["ground"](
                self._wide, self.height, self._wide, numbers.ctypes.data, self.frame.ctypes.data
            )
            self._backdrop = given, self.frame.copy()
        else:
            self.frame[:] = self._backdrop[1]

    def shadow(self, eye: Eye, surface: Surface, points: Array, level: float) -> None:
        """The shadow of a surface, its corners at `points` (n, 3), on the ground."""
        lamp = lamp_direction(eye)
        fallen = points - (points[:, 2:] - level) / lamp[2] * lamp
        places = self._places(eye, fallen)
        paints = surface.paints.copy()
        paints[:, 0] = _SHADE
        self._draw("flat", Surface(surface.faces, paints), places, places, np.zeros(9, np.float32),
                   self._solid)  # fmt: skip

    def draw(
        self, eye: Eye, surface: Surface, points: Array, normals: Array, ghost: bool = False
    ) -> None:
        """A surface with its corners at `points` (n, 3) and unit `normals` there (n, 3).

        Ghosts, through which the rest is seen, come last.
        """
        lamp, back = lamp_direction(eye), eye.rows[2]
        half = (lamp + back) / np.linalg.norm(lamp + back)
        light = np.concatenate([lamp, half, [0.0, 0.0, 1.0]]).astype(np.float32)
        room = self._ghost if ghost else self._solid
        normals = np.ascontiguousarray(normals, np.float32)
        self._draw("solid", surface, self._places(eye, points), normals, light, room)

    def finish(self, opacity: float = 0.0) -> None:
        """Put what was drawn on the frame, ghosts with an opacity."""
        left, right, top, bottom = self._box
        if left < right and top < bottom:
            share = np.array([opacity], np.float32)
            rows = [self._solid, self._ghost, self._near, share, self.frame]
            functions()["resolve"](
                left, right, top, bottom, self._solid.shape[1], self._wide,
                *(array.ctypes.data for array in rows),
            )  # fmt: skip
        self._box = [self._wide, 0, self.height, 0]

    def _places(self, eye: Eye, points: Array) -> Array:
        """Samples from the left and the top, and nearness; and the box of what is drawn grows."""
        places = np.ascontiguousarray(eye.project(points), np.float32)
        shown = places[places[:, 2] > 0, :2]
        if len(shown):
            size = [self._wide, self.height]
            least = np.clip(np.floor(shown.min(0)) - 1, 0, size).astype(int)
            most = np.clip(np.ceil(shown.max(0)) + 1, 0, size).astype(int)
            box = self._box
            box[0] = min(box[0], int(least[0]) // 8 * 8)
            box[1] = max(box[1], -8 * (-int(most[0]) // 8))
            box[2], box[3] = min(box[2], int(least[1])), max(box[3], int(most[1]))
        places[:, :2] *= 2
        return places

    def _draw(
        self, name: str, surface: Surface, places: Array, normals: Array, light: Array, room: Array
    ) -> None:
        arrays = [surface.faces, places, normals, surface.paints, light, self._near, room]
        functions()[name](
            len(surface.faces), 2 * self._wide, 2 * self.height, room.shape[1],
            *(array.ctypes.data for array in arrays),
        )  # fmt: skip


def lamp_direction(eye: Eye) -> Array:
    """Where light comes from: over the viewer's shoulder, wherever the viewer stands."""
    a = np.radians(eye.azimuth)
    turn = np.array([[np.cos(a), -np.sin(a), 0.0], [np.sin(a), np.cos(a), 0.0], [0.0, 0.0, 1.0]])
    return turn @ np.array(LAMP) / np.linalg.norm(LAMP)


def blank(width: int, height: int) -> Array:
    """An empty picture (height, width, 4), of the colour of the backdrop."""
    picture = np.full((height, width, 4), 255, np.uint8)
    picture[..., :3] = np.round(BACKDROP)
    return picture
