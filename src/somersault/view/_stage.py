"""One view of some histories: who is seen, from where, on which ground, frame by frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from somersault._core.array import Array
from somersault.view import style as look
from somersault.view._actor import Actor
from somersault.view._canvas import Canvas, Ground, Surface
from somersault.view._eye import Eye
from somersault.view._meshes import arrow

GHOST = 0.32  # opacity
_REACH = 1.04  # of a radius: room about what is seen
VECTORS = {name: look.LIGHT[name] for name in ("momentum", "spin")}


@dataclass(eq=False)
class Stage:
    """Histories in one place, drawn by one eye.

    Parameters
    ----------
    actors : sequence of Actor
        The first is followed; they are at the same moments.
    ghosts : sequence of Actor
        Seen through.
    width, height : int
        Pixels.
    camera : (float, float)
        Azimuth and elevation, degrees.
    follow : bool
        Whether the eye goes with the first one's centre of mass, or stands where it sees all.
    vectors : sequence of {"momentum", "spin"}
        Arrows from the first one's centre of mass.
    ground : bool
        Whether there is a ground with shadows.
    """

    actors: Sequence[Actor]
    ghosts: Sequence[Actor]
    width: int
    height: int
    camera: tuple[float, float]
    follow: bool = True
    vectors: Sequence[str] = ()
    ground: bool = True

    def __post_init__(self) -> None:
        self._canvas = Canvas(self.width, self.height)
        shape = arrow().triangles
        self._arrow = shape.vertices, shape.normals
        self._arrow_faces = shape.faces

    @property
    def _all(self) -> list[Actor]:
        return [*self.actors, *self.ghosts]

    @cached_property
    def _follows(self) -> bool:
        return self.follow and self.actors[0].history.model.free

    @cached_property
    def _middle(self) -> Array:
        """What an eye that stands still looks at: the middle of the box that all of it fills."""
        corners = [actor.outline[0].reshape(-1, 3) for actor in self._all]
        least = np.min([c.min(0) for c in corners], 0)
        return (least + np.max([c.max(0) for c in corners], 0)) / 2

    @cached_property
    def radius(self) -> float:
        """How much about what the eye looks at is ever filled, m; of what it follows, and not of
        ghosts that fly away."""
        shown = self.actors[:1] if self._follows else self._all
        reach = max(
            float(np.linalg.norm(
                corners - (centres[:, None] if self._follows else self._middle), axis=-1).max())
            for corners, centres in (actor.outline for actor in shown)
        )  # fmt: skip
        return _REACH * (reach or 1.0)

    @cached_property
    def _level(self) -> float:
        low = min(float(actor.outline[0][..., 2].min()) for actor in self._all)
        return low - 0.02 * self.radius

    def _plane(self, target: Array) -> Ground | None:
        """The ground, seen about the place that the eye looks at."""
        if not self.ground or self.camera[1] <= 0:
            return None
        spacing = 10.0 ** np.floor(np.log10(self.radius))  # 1, 2 or 5 of a power of ten
        spacing *= next(k for k in (5, 2, 1) if k * spacing <= self.radius)
        return Ground(self._level, spacing / 2, 3.2 * self.radius, (target[0], target[1]))

    def eye(self, k: int) -> Eye:
        """The eye at a moment."""
        return Eye(self._target(k), *self.camera, self.radius, self.width, self.height)

    def _target(self, k: int) -> Array:
        """What the eye looks at."""
        target: Array = self.actors[0].centres[k] if self._follows else self._middle
        return target

    def draw(self, moments: Sequence[int]) -> Array:
        """A picture (height, width, 4) of bytes, valid until the next: all that is there at the
        given moment; at several of them, as a stroboscope shows it."""
        canvas, eye = self._canvas, self.eye(moments[0])
        plane = self._plane(self._target(moments[0]))
        canvas.begin(eye, plane)
        solids = [self._posed(actor, k) for k in moments for actor in self.actors]
        solids += [item for k in moments for item in self._arrows(k)]
        if plane is not None:
            for surface, points, _ in solids:
                canvas.shadow(eye, surface, points, plane.level)
        for surface, points, normals in solids:
            canvas.draw(eye, surface, points, normals)
        for k in moments:
            for actor in self.ghosts:
                canvas.draw(eye, *self._posed(actor, k), ghost=True)
        canvas.finish(GHOST)
        return canvas.image

    def _posed(self, actor: Actor, k: int) -> tuple[Surface, Array, Array]:
        return actor.figure.surface, *actor.corners(k)

    def _arrows(self, k: int) -> list[tuple[Surface, Array, Array]]:
        made = []
        for name in self.vectors:
            along = self.actors[0].vectors[name][k] / (self.actors[0].longest[name] or np.inf)
            size = float(np.linalg.norm(along))
            if size < 1e-3:
                continue
            axis = along / size
            side = np.cross(np.eye(3)[np.argmin(np.abs(axis))], axis)
            side /= np.linalg.norm(side)
            turn = np.stack([side, np.cross(axis, side), axis])
            points, normals = self._arrow
            stretched = points * [self.radius, self.radius, 0.95 * size * self.radius]
            paint = np.tile([*look.rgb(VECTORS[name]), 1.0], (len(self._arrow_faces), 1))
            place = self.actors[0].centres[k]
            surface = Surface(self._arrow_faces, paint)
            made.append((surface, stretched @ turn + place, normals @ turn))
        return made
