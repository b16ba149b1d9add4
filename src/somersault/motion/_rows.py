"""Rows of numbers that someone gives for a motion: times, angles, keyframes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault._core.numbers import MOST, as_floats
from somersault.motion._path import check_rows


def finite(what: str, values: Sequence[float] | Array) -> Array:
    """A row of finite numbers; SomersaultError naming `what`, and which, for anything else."""
    row = as_floats(values)
    if row is None or row.ndim != 1:
        raise SomersaultError(f"{what} must be a row of numbers; give a list of them")
    wrong = np.flatnonzero(~(np.abs(row) <= MOST))
    if wrong.size:
        raise SomersaultError(
            f"{what} must be finite and below 1e9, and number {wrong[0] + 1} is "
            f"{row[wrong[0]]:g}; correct it or leave it out"
        )
    return row


def keyframe_table(name: str, rows: Sequence[tuple[float, float]]) -> Array:
    """Times and angles of one joint, (K, 2)."""
    table = as_floats(rows)
    if table is None or table.ndim != 2 or table.shape[1] != 2:
        raise SomersaultError(f"joint {name}: keyframes are a list of (time, angle) pairs")
    times, angles = (
        finite(f"joint {name}: {what}", column)
        for what, column in zip(("times", "angles"), table.T, strict=True)
    )
    try:
        check_rows(times, angles, "angles")
    except SomersaultError as mistake:
        raise SomersaultError(f"joint {name}: its motion {mistake}; put them in order") from None
    return table
