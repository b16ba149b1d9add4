"""Between which values of a quantity a spin is stable."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import shown, whole_number
from somersault._core.errors import SomersaultError
from somersault._core.numbers import floats
from somersault.model import Model
from somersault.stability._chart import largest_growth, require_open
from somersault.stability._grid import Grid, Values, grid, row
from somersault.stability._principal import Axis

_MOST_SAMPLES = 1_000_000
_HALVINGS = 32  # of an edge's bracket


def stable_ranges(
    model: str | Model,
    along: tuple[str, float, float],
    *,
    pose: Values | None = None,
    stiffness: Values | None = None,
    damping: Values | None = None,
    fixed: Values | None = None,
    axis: Axis | str | int | None = None,
    lock: str | Iterable[str] = (),
    subsystem: str | None = None,
    samples: int = 1201,
) -> list[tuple[float, float]]:
    """Where between two values of a quantity the spin is stable, each edge to about 1e-9.

    Looks at evenly spaced values, so an island narrower than their spacing can be missed, then
    halves each edge's bracket.

    Parameters
    ----------
    model : str or Model
        A shipped model's name, a model file, or a model.
    along : tuple of str, float and float
        The name of a quantity, as in `growth_rates`, its least and its greatest value.
    pose, stiffness, damping, fixed
        What stays fixed, one number each, as for `chart`.
    axis, lock, subsystem
        As for `growth_rates`.
    samples : int
        How many values to look at.

    Returns
    -------
    list of tuple of float
        The ends of each stable range.

    Raises
    ------
    SomersaultError
        As for `growth_rates`.

    Examples
    --------
    >>> from somersault.stability import stable_ranges
    >>> for low, high in stable_ranges("furrer", ("stiffness.shoulder", -2, 4),
    ...                                pose={"shoulder": 1.3}):
    ...     print(f"{low:.4f} to {high:.4f}")
    0.8919 to 1.3606
    """
    cases = grid(model, fixed, pose, stiffness, damping, axis, lock, subsystem)
    name, low, high = _ends(along)
    require_open(cases, name)
    if cases.shape({}):
        raise SomersaultError(
            "stable ranges are those of one case, and these are arrays; use stable_ranges_by_case"
        )
    return _ranges(cases, name, low, high, samples)[0]


def stable_ranges_by_case(
    model: str | Model,
    along: tuple[str, float, float],
    *,
    pose: Values | None = None,
    stiffness: Values | None = None,
    damping: Values | None = None,
    fixed: Values | None = None,
    axis: Axis | str | int | None = None,
    lock: str | Iterable[str] = (),
    subsystem: str | None = None,
    samples: int = 1201,
) -> list[list[tuple[float, float]]]:
    """`stable_ranges` of many cases at once: of many poses, say.

    Parameters
    ----------
    model, along, axis, lock, subsystem, samples
        As for `stable_ranges`.
    pose, stiffness, damping, fixed
        The cases: arrays (N,), or numbers where all cases have the same.

    Returns
    -------
    list of list of tuple of float
        The ends of the stable ranges of each case.

    Raises
    ------
    SomersaultError
        As for `growth_rates`.

    Examples
    --------
    >>> from somersault.stability import stable_ranges_by_case
    >>> by_pose = stable_ranges_by_case("furrer", ("stiffness.shoulder", -2, 4),
    ...                                 pose={"shoulder": [0.1, 1.3]})
    >>> [len(ranges) for ranges in by_pose]
    [0, 1]
    """
    cases = grid(model, fixed, pose, stiffness, damping, axis, lock, subsystem)
    name, low, high = _ends(along)
    require_open(cases, name)
    if len(cases.shape({})) != 1:
        raise SomersaultError("cases are rows of numbers, (N,); use stable_ranges for one case")
    return _ranges(cases, name, low, high, samples)


def _ends(along: Any) -> tuple[str, float, float]:
    if not isinstance(along, tuple | list) or len(along) != 3:
        raise SomersaultError(
            "what stable ranges are along is a name, a lower and a higher value, "
            f"('stiffness.shoulder', -2, 4), not {shown(along)}"
        )
    name, (low, high) = row("what stable ranges are along", (along[0], along[1:]))
    if not low < high:
        raise SomersaultError(f"stable ranges of {name} need a lower and a higher value")
    return name, float(low), float(high)


def _ranges(
    cases: Grid, name: str, low: float, high: float, samples: int
) -> list[list[tuple[float, float]]]:
    """Ranges of one quantity in which each case is stable: by looking, and then by halving."""
    whole_number("samples", samples, 2, _MOST_SAMPLES)
    held = {key: floats(key, value) for key, value in cases.fixed.items()}
    values = np.linspace(low, high, samples)

    def stable(at: Array, case: Array | None) -> Array:
        of_case = {key: v if v.ndim == 0 else v[case] for key, v in held.items()}
        return largest_growth(cases, {**of_case, name: at}) <= 0

    (count,) = cases.shape({}) or (1,)
    inside = np.broadcast_to(stable(values, np.arange(count)[:, None]), (count, samples))
    case, column = np.nonzero(inside[:, 1:] != inside[:, :-1])
    left, right = values[column], values[column + 1]
    starts_inside = inside[case, column]
    for _ in range(_HALVINGS if len(case) else 0):
        middle = (left + right) / 2
        same = stable(middle, case) == starts_inside
        left, right = np.where(same, middle, left), np.where(same, right, middle)
    edges = (left + right) / 2
    by_case = []
    for k in range(count):
        first, last = ([low] if inside[k, 0] else []), ([high] if inside[k, -1] else [])
        ends = [*first, *edges[case == k].tolist(), *last]
        by_case.append(list(zip(ends[::2], ends[1::2], strict=True)))
    return by_case
