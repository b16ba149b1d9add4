"""Bodies that cannot move against their parents become one body with them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import list_of, truth
from somersault.model._bodies import GROUND, Body
from somersault.model._vectors import as_matrix, as_vector
from somersault.model.shapes import Shape


@dataclass(frozen=True, slots=True)
class _Place:
    """Where a body of the file ended: in which kept body, and how its frame lies in it."""

    index: int
    position: Array
    rotation: Array


@dataclass(slots=True)
class _Lump:
    """Masses and shapes gathered in the axes of one kept body."""

    masses: list[float] = field(default_factory=list)
    coms: list[Array] = field(default_factory=list)
    inertias: list[Array] = field(default_factory=list)
    shapes: list[Shape] = field(default_factory=list)
    sources: list[str] = field(default_factory=list)

    def weigh(self, body: Body, position: Array, rotation: Array) -> None:
        self.masses.append(body.mass)
        self.coms.append(position + rotation @ np.array(body.com))
        self.inertias.append(rotation @ np.array(body.inertia) @ rotation.T)
        if body.mass != 0:
            self.sources += [s for s in body.inertia_from.split(", ") if s not in self.sources]

    def joined(self, body: Body) -> Body:
        """`body` with the mass, com, inertia (parallel axes) and shapes of the whole lump."""
        masses, coms = np.array(self.masses), np.array(self.coms)
        mass = float(masses.sum())
        com = masses @ coms / mass if mass > 0 else coms[0]
        inertia = np.zeros((3, 3))
        for m, c, own in zip(self.masses, self.coms, self.inertias, strict=True):
            arm = c - com
            inertia += own + m * (arm @ arm * np.eye(3) - np.outer(arm, arm))
        inertia = (inertia + inertia.T) / 2  # rounding must not look like a mistake in the file
        return replace(
            body,
            mass=mass,
            com=as_vector(com),
            inertia=as_matrix(inertia),
            shapes=tuple(self.shapes),
            inertia_from=", ".join(sorted(self.sources)) or body.inertia_from,
        )


@np.errstate(over="ignore", invalid="ignore")  # numbers out of range are refused by `Model`
def merge_welded(bodies: list[Body], free: bool) -> tuple[Body, ...]:
    """The same mechanism with every body without joints merged into its parent.

    Bodies without joints whose parent is `GROUND` never move and are dropped; what hangs on them
    hangs on `GROUND` instead. Frames are composed, masses and inertias joined about the common
    centre of mass, shapes carried along; the bodies that remain keep their names, axes and order.

    Parameters
    ----------
    bodies : list of Body
        In order, parents first.
    free : bool
        Whether body 0 is a free base, and stays although it has no joints.

    Returns
    -------
    tuple of Body
    """
    bodies = list_of("bodies", bodies, Body)
    truth("free", free)
    kept: list[Body] = []
    lumps: list[_Lump] = []
    places: list[_Place] = []
    ground = _Place(GROUND, np.zeros(3), np.eye(3))
    for number, body in enumerate(bodies):
        above = ground if body.parent == GROUND else places[body.parent]
        position = above.position + above.rotation @ np.array(body.position)
        rotation = above.rotation @ np.array(body.rotation)
        if body.joints or (free and number == 0):
            places.append(_Place(len(kept), np.zeros(3), np.eye(3)))
            kept.append(_hung(body, above.index, position, rotation))
            lumps.append(_Lump(shapes=list(body.shapes)))
            lumps[-1].weigh(body, np.zeros(3), np.eye(3))
        else:
            places.append(_Place(above.index, position, rotation))
            if above.index != GROUND:
                lumps[above.index].weigh(body, position, rotation)
                lumps[above.index].shapes += [s.placed(position, rotation) for s in body.shapes]
    return tuple(
        lump.joined(body) if len(lump.masses) > 1 else body
        for body, lump in zip(kept, lumps, strict=True)
    )


def _hung(body: Body, parent: int, position: Array, rotation: Array) -> Body:
    return replace(body, parent=parent, position=as_vector(position), rotation=as_matrix(rotation))
