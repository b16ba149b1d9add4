"""Which coordinates the linear equations are written in, and in which order."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from somersault._core.array import Array
from somersault.model import Model
from somersault.model._mirror import mirror_pairs
from somersault.stability._gyric import Attitude, blocks, together
from somersault.stability._spin import cycle

_TURNS = ("somersault", "tilt", "twist")  # about a model's `axes`


@dataclass(frozen=True)
class Coordinates:
    """Names, and the columns that take them to turns about axes 1, 2, 3 and joint speeds."""

    names: tuple[str, ...]
    columns: Array
    attitude: Attitude

    def transformed(self, matrix: Array) -> Array:
        """Bᵀ A B of a matrix (…, 3 + speeds, 3 + speeds)."""
        return self.columns.T @ matrix @ self.columns

    def ordered(self, coupled: Array) -> list[int]:
        """Decoupled subsystems one after the other, the one of tilt and twist first."""
        return [i for group in blocks(together(coupled, self.attitude)) for i in group]


def coordinates(model: Model, axis: int, locked: set[int]) -> Coordinates:
    """Attitude turns and the joints that are not locked; mirrored ones in pairs.

    The order is the thesis's: the two turns across the axis of spin, tilt first and twist last,
    antisymmetric joint motions, the turn about the axis, symmetric ones, and what has no mirror
    image.
    """
    count = len(model.speeds)
    before, about, after = cycle(axis)
    turns = {i: np.eye(3 + count)[:, i] for i in range(3)}
    called = {axis - 1: name for axis, name in zip(model.axes, _TURNS, strict=True)}
    across = sorted((before, after), key=lambda i: ("tilt", "somersault", "twist").index(called[i]))
    antisymmetric: list[tuple[str, Array]] = []
    symmetric: list[tuple[str, Array]] = []
    left = [i for i in range(count) if i not in locked]
    for pair in mirror_pairs(model):
        if pair.left not in left or pair.right not in left:
            continue
        if pair.left == pair.right:
            group = symmetric if pair.sign > 0 else antisymmetric
            group.append((pair.name, _unit(count, pair.left)))
        else:
            one, two = _unit(count, pair.left), pair.sign * _unit(count, pair.right)
            antisymmetric.append((f"antisymmetric {pair.name}", one - two))
            symmetric.append((f"symmetric {pair.name}", one + two))
        left = [i for i in left if i not in (pair.left, pair.right)]
    alone = [(model.speeds[i], _unit(count, i)) for i in left]
    ahead = [(called[i], turns[i]) for i in across]
    listed = [*ahead, *antisymmetric, (called[about], turns[about]), *symmetric, *alone]
    names = [name for name, _ in listed]
    places = Attitude(*(names.index(called[i]) for i in (before, about, after)))
    return Coordinates(tuple(names), np.column_stack([c for _, c in listed]), places)


def _unit(count: int, speed: int) -> Array:
    return np.eye(3 + count)[:, 3 + speed]
