"""About which of a body's axes it somersaults, tilts and twists."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from itertools import permutations
from typing import Any

import numpy as np

from somersault._core.checks import shown
from somersault._core.errors import SomersaultError

Axes = tuple[int, int, int]

AXES: Axes = (2, 1, 3)
_ORDERS = tuple(permutations((1, 2, 3)))
_RIGHT_HANDED = ((2, 1, 3), (1, 3, 2), (3, 2, 1))  # as tilt, somersault, twist: 1, 2, 3 in turn


def as_axes(axes: Any) -> Axes:
    """Axes of somersault, tilt and twist, checked.

    Parameters
    ----------
    axes : sequence of int
        Three body axes.

    Returns
    -------
    tuple of int

    Raises
    ------
    SomersaultError
        Unless they are 1, 2 and 3 in some order.

    Examples
    --------
    >>> from somersault.attitude import as_axes
    >>> as_axes([2, 1, 3])
    (2, 1, 3)
    """
    if isinstance(axes, tuple) and axes in _ORDERS and all(type(k) is int for k in axes):
        return axes  # quickly, as they nearly always are
    row = isinstance(axes, Sequence) or (isinstance(axes, np.ndarray) and axes.ndim == 1)
    given = tuple(axes) if row else ()
    if not all(isinstance(k, int | np.integer) and not isinstance(k, bool) for k in given) or (
        given not in _ORDERS
    ):
        raise SomersaultError(
            f"axes {shown(axes)} are not those of somersault, tilt and twist; give 1, 2 and 3 in "
            "some order, like (2, 1, 3)"
        )
    a, b, c = (int(k) for k in given)
    return a, b, c


def side(axes: Axes) -> int:
    """On which side of the body the axis of somersault points.

    Parameters
    ----------
    axes : tuple of int
        Axes of somersault, tilt and twist.

    Returns
    -------
    int
        1 where the axis of somersault is at the left of the axes of tilt (front) and twist (head),
        −1 where it is at the right.

    Examples
    --------
    >>> from somersault.attitude import side
    >>> side((2, 1, 3)), side((1, 2, 3))
    (1, -1)
    """
    return 1 if as_axes(axes) in _RIGHT_HANDED else -1


def in_sequence(vector: Sequence[Any], axes: Axes) -> list[Any]:
    """A vector's three components along front, left and head, where 2-1-3 has its axes 1, 2, 3.

    Attitudes renamed so (the vector part of a quaternion) have Θ and Ψ of the sequence about
    `axes`, and `side` times its Φ.

    Parameters
    ----------
    vector : sequence of three
        Components in the body's own axes: numbers, arrays or symbols.
    axes : tuple of int
        Axes of somersault, tilt and twist.

    Returns
    -------
    list of three

    Examples
    --------
    >>> from somersault.attitude import in_sequence
    >>> in_sequence([1.0, 2.0, 3.0], (3, 1, 2))
    [1.0, -3.0, 2.0]
    """
    a, b, c = as_axes(axes)
    _require_three(vector)
    return [vector[b - 1], side(axes) * vector[a - 1], vector[c - 1]]


def from_sequence(vector: Sequence[Any], axes: Axes) -> list[Any]:
    """The inverse of `in_sequence`: a vector's three components in the body's own axes.

    Parameters
    ----------
    vector : sequence of three
        Components along front, left and head: numbers, arrays or symbols.
    axes : tuple of int
        Axes of somersault, tilt and twist.

    Returns
    -------
    list of three

    Examples
    --------
    >>> from somersault.attitude import from_sequence
    >>> from_sequence([1.0, -3.0, 2.0], (3, 1, 2))
    [1.0, 2.0, 3.0]
    """
    a, b, c = as_axes(axes)
    _require_three(vector)
    along = {b: vector[0], a: side(axes) * vector[1], c: vector[2]}
    return [along[axis] for axis in (1, 2, 3)]


def _require_three(vector: Sequence[Any]) -> None:
    try:
        count = len(vector)
    except TypeError:
        count = 0
    if count != 3 or isinstance(vector, str | bytes | Mapping | Set):
        raise SomersaultError(f"a vector has three components, and this is {shown(vector)}")
