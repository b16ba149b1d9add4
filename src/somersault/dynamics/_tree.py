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

from somersault.dynamics._vector import Mat, Scalar, Vec
from somersault.model._types import GROUND, Body, Joint, Model

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
    the base body's own origin, (3,) in its axes."""

    links: tuple[Link, ...]
    free: bool
    base_com: Vec
    mass: Scalar


Symbols = Mapping[str, Any]


def tree(model: Model, symbols: Symbols | None = None) -> Tree:
    """The links of a model; numbers named in `symbols` ("mass.BODY", "inertia.BODY.12",
    "com.BODY.3") are the symbols given."""
    symbols = symbols or {}
    links: list[Link] = []
    last: list[tuple[int, np.ndarray, np.ndarray]] = []  # link, its axes and origin, per body
    speed = coordinate = 0
    masses: list[Scalar] = []
    base_com: Vec = [0.0, 0.0, 0.0]
    for index, body in enumerate(model.bodies):
        mass, com, inertia = _mass_properties(body, symbols)
        masses.append(mass)
        if body.parent == GROUND:
            parent, axes, origin = -1, np.eye(3), np.zeros(3)
        else:
            parent, axes, origin = last[body.parent]
        rotation, position = np.array(body.rotation), np.array(body.position)
        if model.free and index == 0:
            base_com = com
            links.append(Link(-1, None, [0.0] * 3, None, 0, 1.0, mass, [0.0] * 3, inertia))
            # A symbolic centre of mass of the base is carried by the links that hang from it.
            last.append((0, np.eye(3), np.zeros(3)))
            continue
        for number, joint in enumerate(body.joints):
            new_axes, axis, sign = _aligned(joint)
            anchor = np.array(joint.anchor) if joint.kind != "slide" or number == 0 else here
            to_parent = axes.T @ rotation @ new_axes
            place: Vec = [
                float(x) for x in _clean(axes.T @ (position + rotation @ anchor - origin))
            ]
            if parent == 0 and model.free and number == 0:
                place = [place[k] - base_com[k] for k in range(3)]
            final = number == len(body.joints) - 1
            links.append(
                Link(
                    parent,
                    _constant(to_parent),
                    place,
                    joint,
                    axis,
                    sign,
                    mass if final else 0.0,
                    _seen(new_axes, [com[k] - float(anchor[k]) for k in range(3)])
                    if final
                    else [0.0] * 3,
                    _seen_matrix(new_axes, inertia) if final else [[0.0] * 3 for _ in range(3)],
                    slice(speed, speed + joint.speeds),
                    slice(coordinate, coordinate + joint.coordinates),
                )
            )
            speed += joint.speeds
            coordinate += joint.coordinates
            parent, axes, origin, here = len(links) - 1, new_axes, anchor, anchor
            rotation, position = np.eye(3), np.zeros(3)
        last.append((parent, axes, origin))
    return Tree(tuple(links), model.free, base_com, sum(masses[1:], masses[0]))


def parameter_names(model: Model) -> list[str]:
    """Every number of a model's bodies that can be kept symbolic."""
    names = []
    for body in model.bodies:
        names.append(f"mass.{body.name}")
        names += [f"com.{body.name}.{k}" for k in (1, 2, 3)]
        names += [f"inertia.{body.name}.{k}" for k in ("11", "12", "13", "22", "23", "33")]
    return names


def parameter_value(model: Model, name: str) -> float:
    """The number that a model has for one of `parameter_names`."""
    kind, _, rest = name.partition(".")
    body_name, _, part = (rest, "", "") if kind == "mass" else rest.rpartition(".")
    body = next(body for body in model.bodies if body.name == body_name)
    if kind == "mass":
        return body.mass
    if kind == "com":
        return body.com[int(part) - 1]
    return body.inertia[int(part[0]) - 1][int(part[1]) - 1]


def _mass_properties(body: Body, symbols: Symbols) -> tuple[Scalar, Vec, Mat]:
    mass = symbols.get(f"mass.{body.name}", body.mass)
    com = [symbols.get(f"com.{body.name}.{k + 1}", body.com[k]) for k in range(3)]
    numbers = _clean(np.array(body.inertia))
    inertia = [
        [
            symbols.get(f"inertia.{body.name}.{min(i, j) + 1}{max(i, j) + 1}", float(numbers[i, j]))
            for j in range(3)
        ]
        for i in range(3)
    ]
    return mass, com, inertia


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
    if np.array_equal(axes, np.eye(3)):
        return v
    if all(isinstance(x, float) for x in v):
        return [float(x) for x in _clean(axes.T @ np.array(v))]
    return [sum(float(axes[k, i]) * v[k] for k in range(3)) for i in range(3)]


def _seen_matrix(axes: np.ndarray, a: Mat) -> Mat:
    columns = [list(x) for x in zip(*[_seen(axes, row) for row in a], strict=True)]
    seen = [_seen(axes, column) for column in columns]
    return [[seen[min(i, j)][max(i, j)] for j in range(3)] for i in range(3)]
