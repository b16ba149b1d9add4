"""A model as a chain of one-joint links, the form in which its equations are written.

Each joint of a body becomes a link of its own, massless but for the body's last; each link's
frame stands on its joint's axis with that axis along a coordinate axis, so that turning is
cheap and many entries are zero. A free base is link 0, framed at its own centre of mass.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from somersault.dynamics._parameters import body_parameter
from somersault.dynamics.vectors import Mat, Scalar, Vec, mul, total
from somersault.model import GROUND, Body, Joint, Model

_CLEAN = 1e-14  # entries below this fraction of the largest are rounding, and stand for zero


@dataclass(frozen=True)
class Link:
    """One joint and what it carries. Lengths and inertias are floats, or symbols where asked.

    `rotation` and `position` place the frame in the parent link's at zero displacement;
    `axis` and `sign` say that the joint moves about (along) sign · e_axis; `com` and
    `inertia` (about `com`) are in the link's axes.
    """

    parent: int
    rotation: Mat | None
    position: Vec
    joint: Joint | None
    axis: int
    sign: float
    mass: Scalar
    com: Vec
    inertia: Mat
    speeds: slice = field(default_factory=lambda: slice(0, 0))
    coordinates: slice = field(default_factory=lambda: slice(0, 0))


@dataclass(frozen=True)
class Tree:
    """The links, parents first; with a free base, link 0 is it and stands `base_com` from
    the base body's own origin, (3,) in its axes, and moves in the `ways` of `Model.base_ways`."""

    links: tuple[Link, ...]
    ways: tuple[int, ...]
    base_com: Vec
    mass: Scalar

    @property
    def free(self) -> bool:
        """Whether link 0 is a free base."""
        return bool(self.ways)

    def kept(self, turn: Vec) -> Vec:
        """What of a turn, or of an angular velocity, the base can make.

        Parameters
        ----------
        turn : vector
            In the base's axes.

        Returns
        -------
        vector
            With zero about the axes about which the base does not turn.
        """
        return [x if k in self.ways else 0.0 for k, x in enumerate(turn)]


Symbols = Mapping[str, Any]


def link_tree(model: Model, symbols: Symbols | None = None) -> Tree:
    """The links of a model.

    Parameters
    ----------
    model : Model
    symbols : mapping of str to symbol, optional
        Stand for numbers of the model, by the names of `parameter_values`.

    Returns
    -------
    Tree
    """
    symbols = symbols or {}
    links: list[Link] = []
    stands: list[_Stand] = []
    masses: list[Scalar] = []
    base_com: Vec = [0.0, 0.0, 0.0]
    for index, body in enumerate(model.bodies):
        properties = _mass_properties(body, symbols)
        masses.append(properties.mass)
        if model.free and index == 0:
            base_com = properties.com
            links.append(
                Link(-1, None, _zero(), None, 0, 1.0, properties.mass, _zero(), properties.inertia)
            )
            stands.append(_Stand(0, np.eye(3), list(base_com)))
            continue
        on = _Stand(-1, np.eye(3), _zero()) if body.parent == GROUND else stands[body.parent]
        place = _place_of(body, symbols)
        rotation = np.array(body.rotation)
        for number, joint in enumerate(body.joints):
            last = number == len(body.joints) - 1
            carried = properties if last else _NOTHING
            link, on = _jointed(on, place, rotation, joint, number == 0, carried, links)
            links.append(link)
            rotation, place = np.eye(3), _zero()
        stands.append(on)
    return Tree(tuple(links), model.base_ways, base_com, sum(masses[1:], masses[0]))


@dataclass(frozen=True)
class _Stand:
    """How a body stands in its link: the link, its axes and its frame's origin in the body."""

    link: int
    axes: np.ndarray
    origin: Vec


def _zero() -> Vec:
    return [0.0, 0.0, 0.0]


def _jointed(
    on: _Stand,
    place: Vec,
    rotation: np.ndarray,
    joint: Joint,
    first: bool,
    carried: _Properties,
    links: list[Link],
) -> tuple[Link, _Stand]:
    """The link of one joint that stands on another, and how the body then stands in it.

    `place` and `rotation` put the body's frame, before the joint moves, in that of the body
    that `on` is of; for all but its `first` joint that is the body itself.
    """
    axes, axis, sign = _aligned(joint)
    # Where a slide stands along its line is free; it takes the frame of the joint before it.
    anchor: Vec = list(on.origin) if joint.kind == "slide" and not first else list(joint.anchor)
    turned = rotation @ np.array(anchor, float)
    offset = [place[k] + float(turned[k]) - on.origin[k] for k in range(3)]
    speed = links[-1].speeds.stop if links else 0
    coordinate = links[-1].coordinates.stop if links else 0
    link = Link(
        on.link,
        _constant(on.axes.T @ rotation @ axes),
        _seen(on.axes, offset),
        joint,
        axis,
        sign,
        carried.mass,
        _seen(axes, [carried.com[k] - anchor[k] for k in range(3)]),
        _seen_matrix(axes, carried.inertia),
        slice(speed, speed + joint.speeds),
        slice(coordinate, coordinate + joint.coordinates),
    )
    return link, _Stand(len(links), axes, anchor)


@dataclass(frozen=True)
class _Properties:
    mass: Scalar
    com: Vec
    inertia: Mat


_NOTHING = _Properties(0.0, [0.0] * 3, [[0.0] * 3 for _ in range(3)])


def _mass_properties(body: Body, symbols: Symbols) -> _Properties:
    def given(kind: str, part: str, number: float) -> Scalar:
        return symbols.get(body_parameter(body.name, kind, part), number)

    numbers = _clean(np.array(body.inertia))
    parts = [[f"{min(i, j) + 1}{max(i, j) + 1}" for j in range(3)] for i in range(3)]
    inertia = [
        [given("inertia", parts[i][j], float(numbers[i, j])) for j in range(3)] for i in range(3)
    ]
    mass = given("mass", "", body.mass)
    open_inertia = any(
        body_parameter(body.name, "inertia", part) in symbols for row in parts for part in row
    )
    if body_parameter(body.name, "mass") in symbols and body.mass > 0 and not open_inertia:
        inertia = [[mul(x / body.mass, mass) for x in row] for row in inertia]
    com = [given("com", str(k + 1), body.com[k]) for k in range(3)]
    return _Properties(mass, com, inertia)


def _place_of(body: Body, symbols: Symbols) -> Vec:
    names = [body_parameter(body.name, "position", str(k + 1)) for k in range(3)]
    return [symbols.get(name, body.position[k]) for k, name in enumerate(names)]


def _aligned(joint: Joint) -> tuple[np.ndarray, int, float]:
    """Axes for a joint's link (columns, in body axes), and which of them, which way, it moves."""
    direction = np.array(joint.axis)
    if joint.kind == "ball":
        return np.eye(3), 0, 1.0
    largest = int(np.argmax(np.abs(direction)))
    if 1 - abs(direction[largest]) < _CLEAN:
        return np.eye(3), largest, float(np.sign(direction[largest]))
    other = np.eye(3)[int(np.argmin(np.abs(direction)))]
    first = np.cross(other, direction)
    first /= np.linalg.norm(first)
    return np.column_stack([first, np.cross(direction, first), direction]), 2, 1.0


def _clean(values: np.ndarray) -> np.ndarray:
    size = np.abs(values).max(initial=0.0)
    return np.where(np.abs(values) < _CLEAN * size, 0.0, values)


def _constant(rotation: np.ndarray) -> Mat | None:
    """A constant rotation as rows of floats; None for the identity."""
    rotation = _clean(rotation)
    return None if np.array_equal(rotation, np.eye(3)) else rotation.tolist()


def _seen(axes: np.ndarray, v: Vec) -> Vec:
    """A body's vector in its link's axes."""
    if all(isinstance(x, float) for x in v):
        return [float(x) for x in _clean(axes.T @ np.array(v))]
    if np.array_equal(axes, np.eye(3)):
        return v
    return [total([mul(float(axes[k, i]), v[k]) for k in range(3)]) for i in range(3)]


def _seen_matrix(axes: np.ndarray, a: Mat) -> Mat:
    columns = [list(x) for x in zip(*[_seen(axes, row) for row in a], strict=True)]
    seen = [_seen(axes, column) for column in columns]
    return [[seen[min(i, j)][max(i, j)] for j in range(3)] for i in range(3)]
