"""What a model is made of: rigid bodies and the joints between them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Literal

from somersault.model._vectors import IDENTITY, ZERO, Matrix, Vector
from somersault.model.shapes import Shape

GROUND = -1
LIMIT_SLACK = 1e-9  # rad or m beyond a joint's limits that count as within


@dataclass(frozen=True, slots=True)
class Follow:
    """What a joint follows: another joint, by a gear. URDF calls it mimic.

    Parameters
    ----------
    leader : str
        The joint that is followed.
    factor, offset : float
        This joint's coordinate is `factor` times the leader's, plus `offset` (rad, m).
    """

    leader: str
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class Joint:
    """One joint between a body and its parent; a body may have several, applied in order.

    A hinge turns about `axis` through `anchor` by angle − `reference`; a slide moves along `axis`;
    a ball turns freely about `anchor`, and its coordinate is a unit quaternion (scalar first, child
    to parent).

    Parameters
    ----------
    name : str
    kind : {"hinge", "slide", "ball"}
    axis, anchor : tuple of float
        In the axes of the body that it moves; the axis of length 1, the anchor in m.
    reference : float
        The coordinate with which the file draws it, rad (m for a slide).
    limits : tuple of float, optional
        The ends of the coordinate's range.
    stiffness : float
        N m/rad (N/m for a slide).
    rest : float
        The coordinate at which the spring is slack.
    damping : float
        N m s/rad.
    armature : float
        kg m²: the inertia of a geared rotor, as in MJCF.
    follows : Follow, optional
        The joint that it is geared to.
    """

    name: str
    kind: Literal["hinge", "slide", "ball"]
    axis: Vector = (1.0, 0.0, 0.0)
    anchor: Vector = ZERO
    reference: float = 0.0
    limits: tuple[float, float] | None = None
    stiffness: float = 0.0
    rest: float = 0.0
    damping: float = 0.0
    armature: float = 0.0
    follows: Follow | None = None

    @property
    def speeds(self) -> int:
        """Degrees of freedom: 3 for a ball, else 1."""
        return 3 if self.kind == "ball" else 1

    @property
    def coordinates(self) -> int:
        """Numbers that give its position: 4 (a quaternion) for a ball, else 1."""
        return 4 if self.kind == "ball" else 1

    @property
    def home(self) -> tuple[float, ...]:
        """Its coordinates where nothing else is said of it: as the file draws the model, or at the
        nearer end of its range where it is drawn outside."""
        if self.kind == "ball":
            return (1.0, 0.0, 0.0, 0.0)
        low, high = self.limits or (-math.inf, math.inf)
        return (min(max(self.reference, low), high),)

    @property
    def drawn_outside(self) -> bool:
        """Whether the file draws it outside its range."""
        return self.kind != "ball" and abs(self.home[0] - self.reference) > LIMIT_SLACK


@dataclass(frozen=True, slots=True)
class Body:
    """One rigid body.

    Parameters
    ----------
    name : str
    parent : int
        Place of its parent among the bodies, or `GROUND`.
    mass : float
        kg.
    com, inertia : tuple of float, tuple of rows
        Centre of mass (m) and inertia about it (kg m²), in the body's own axes.
    position, rotation : tuple of float, tuple of rows
        Place its frame in its parent's when every joint of it stands at its reference; columns of
        the rotation are this body's axes.
    joints : tuple of Joint
        By which it moves against its parent, in order.
    shapes : tuple of Shape
        What there is to see of it, in its own axes. They decide nothing, so bodies that differ in
        them alone are equal.
    inertia_from : str
        What its mass and inertia were read from: "file", "shapes" (at a density), both, as
        "file, shapes", or "nothing".
    """

    name: str
    parent: int
    mass: float
    com: Vector
    inertia: Matrix
    position: Vector = ZERO
    rotation: Matrix = IDENTITY
    joints: tuple[Joint, ...] = ()
    shapes: tuple[Shape, ...] = field(default=(), compare=False, repr=False)
    inertia_from: str = field(default="file", compare=False, repr=False)


def coordinate_names(joints: Iterable[Joint]) -> tuple[str, ...]:
    """Names of the coordinates of joints in order; a ball has four (w, x, y, z)."""
    return tuple(_names(joints, ("w", "x", "y", "z")))


def speed_names(joints: Iterable[Joint]) -> tuple[str, ...]:
    """Names of the speeds of joints in order; a ball has three, along its body's axes."""
    return tuple(_names(joints, ("1", "2", "3")))


def _names(joints: Iterable[Joint], parts: tuple[str, ...]) -> Iterator[str]:
    for joint in joints:
        if joint.kind == "ball":
            yield from (f"{joint.name}.{part}" for part in parts)
        else:
            yield joint.name
