"""Numbers from users and files: finite, of the right count, or one sentence."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError

MOST = 1e9  # in SI units: beyond it nothing flies, and sums of squares lose their sense


def number(what: str, value: Any) -> float:
    """A finite float; SomersaultError naming `what` for anything else."""
    if isinstance(value, bool) or not isinstance(value, int | float | np.number):
        raise SomersaultError(f"{what} must be a number, and is {value!r}")
    try:
        result = float(value)
    except OverflowError:
        result = math.inf
    if not abs(result) <= MOST:
        raise SomersaultError(f"{what} must be a finite number below 1e9, and is {result:g}")
    return result


def numbers(what: str, value: Any, size: int | None = None, most: float = MOST) -> Array:
    """A row of finite floats, of `size` if that is given, none beyond `most`."""
    try:
        result = np.asarray(value, float)
    except (TypeError, ValueError, OverflowError):
        result = np.array(np.nan)
    wanted = "a row of" if size is None else str(size)
    if result.ndim != 1 or (size is not None and result.shape != (size,)):
        raise SomersaultError(f"{what} must be {wanted} numbers, and is {value!r}")
    if not np.all(np.isfinite(result) & (np.abs(result) <= most)):
        raise SomersaultError(f"{what} must be finite numbers below 1e9, and is {value!r}")
    return result
