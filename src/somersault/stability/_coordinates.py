"""Which coordinates the linear equations are written in, and in which order."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import instance, shown
from somersault._core.errors import SomersaultError
from somersault.model import Model, mirror_pairs, spread
from somersault.stability._gyric import Attitude, blocks, together
from somersault.stability._principal import cycle

_TURNS = ("somersault", "tilt", "twist")  # about a model's `axes`
_FIRST = ("tilt", "somersault", "twist")  # the thesis's order of the turns across the spin


@dataclass(frozen=True)
class Coordinates:
    """Names, and the columns that take them to turns about axes 1, 2, 3 and joint speeds.

    `parity` (n,) says what a mirror across the axis of spin makes of a motion, if the body is its
    own image: 1 leaves it, −1 reverses it, 0 where that is not known.
    """

    names: tuple[str, ...]
    columns: Array
    attitude: Attitude
    parity: Array

    def transformed(self, matrix: Array) -> Array:
        """Bᵀ A B of a matrix (…, 3 + speeds, 3 + speeds)."""
        return self.columns.T @ matrix @ self.columns

    def of_joints(self, values: Array) -> Array:
        """Bᵀ diag(0, values) B of numbers at the joint speeds, (…, speeds): springs or dampers."""
        rows, size = self.columns[3:], self.columns.shape[1]
        squares = (rows[:, :, None] * rows[:, None, :]).reshape(len(rows), size**2)
        return (values @ squares).reshape(*values.shape[:-1], size, size)

    def ordered(self, coupled: Array) -> list[int]:
        """Decoupled subsystems one after the other, the one of tilt and twist first."""
        return [i for group in blocks(together(coupled, self.attitude)) for i in group]


@lru_cache(maxsize=64)
def coordinates(model: Model, axis: int, locked: frozenset[int] = frozenset()) -> Coordinates:
    """Attitude turns and the joints that are not locked; mirrored ones in pairs.

    The order is the thesis's: the two turns across the axis of spin, tilt first and twist last,
    antisymmetric joint motions, the turn about the axis, symmetric ones, and what has no mirror
    image. A planar model does not turn across the axis.
    """
    before, about, after = cycle(axis)
    moves = motions(model, locked)
    columns = np.eye(3 + len(model.speeds))
    turns = {k: columns[:, k] for k in range(3)}
    if moves:
        columns[3:, [3 + k for k in moves]] = np.array([*moves.values()]).T
    moves = {k: columns[:, 3 + k] for k in moves}
    called = {axis - 1: name for axis, name in zip(model.axes, _TURNS, strict=True)}
    across = [i for i in (before, after) if i in model.base_ways]
    across.sort(key=lambda i: _FIRST.index(called[i]))
    antisymmetric: list[tuple[str, Array]] = []
    symmetric: list[tuple[str, Array]] = []
    for pair in mirror_pairs(model):
        if pair.left not in moves or pair.right not in moves:
            continue
        one, two = moves.pop(pair.left), moves.pop(pair.right, None)
        if two is None:
            group = symmetric if pair.sign > 0 else antisymmetric
            group.append((pair.name, one))
        else:
            antisymmetric.append((f"antisymmetric {pair.name}", one - pair.sign * two))
            symmetric.append((f"symmetric {pair.name}", one + pair.sign * two))
    alone = [(model.speeds[k], column) for k, column in moves.items()]
    ahead = [(called[i], turns[i]) for i in across]
    listed = [*ahead, *antisymmetric, (called[about], turns[about]), *symmetric, *alone]
    names = [name for name, _ in listed]
    places = Attitude(
        *(names.index(called[i]) if i in model.base_ways else None for i in (before, about, after))
    )
    counts = (len(ahead) + len(antisymmetric), 1 + len(symmetric), len(alone))
    parity = np.repeat([-1, 1, 0], counts)
    return Coordinates(tuple(names), np.column_stack([c for _, c in listed]), places, parity)


def motions(model: Model, locked: frozenset[int]) -> dict[int, Array]:
    """How all joint speeds move with each that is free, (speeds,), by its place.

    A joint that follows another moves with its leader, and is locked with it.
    """
    columns = np.eye(len(model.speeds))
    bound = set(locked)
    for joint in model.joints:
        if joint.follows is not None:
            (follower,) = _places(model, joint.name)
            (leader,) = _places(model, joint.follows.leader)
            columns[follower, leader] = joint.follows.factor
            bound |= {follower, leader} if follower in locked else {follower}
    return {k: columns[:, k] for k in range(len(columns)) if k not in bound}


def _places(model: Model, joint: str) -> range:
    at = model.speed_slice(joint)
    return range(at.start, at.stop)


def locked_speeds(model: Model, lock: str | Iterable[str]) -> frozenset[int]:
    """Places of the locked joints' speeds.

    Parameters
    ----------
    model : Model
        The model.
    lock : str or iterable of str
        Names of joints or of left–right pairs; "all" locks every joint.

    Returns
    -------
    frozenset of int
        Places in `model.speeds`.

    Raises
    ------
    SomersaultError
        For a name that is no joint.

    Examples
    --------
    >>> import somersault as so
    >>> from somersault.stability import locked_speeds
    >>> locked_speeds(so.load("furrer"), "shoulder")
    frozenset({0, 1})
    """
    instance("model", model, Model)
    if isinstance(lock, str):
        lock = [lock]
    try:
        names = [str(name) for name in lock]
    except TypeError:
        raise SomersaultError(f"lock takes joint names, and is {shown(lock)}") from None
    if "all" in names:
        names = [joint.name for joint in model.joints]
    places: set[int] = set()
    for name in spread(model, dict.fromkeys(names, 0.0), mirrored=False):
        places |= set(_places(model, name))
    return frozenset(places)


def columns_of(model: Model, axis: int, names: Iterable[str]) -> Array:
    """How the joint speeds move with each of some coordinates, (speeds, names)."""
    whole = coordinates(model, axis)
    alone = dict(zip(model.speeds, np.eye(len(model.speeds)), strict=True))
    known = {**alone, **dict(zip(whole.names, whole.columns[3:].T, strict=True))}
    return np.array([known[name] for name in names]).reshape(-1, len(model.speeds)).T
