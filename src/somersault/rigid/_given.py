"""Times and attitudes from users, checked."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.checks import shown
from somersault._core.errors import SomersaultError
from somersault._core.numbers import floats


def fixed(values: Array) -> Array:
    """A copy that cannot be changed."""
    copy = np.array(values, float)
    copy.flags.writeable = False
    return copy


def checked_times(t: ArrayLike) -> Array:
    """Finite times, or SomersaultError."""
    times = floats("times", t)
    if not np.all(np.isfinite(times)):
        raise SomersaultError("Times must be finite numbers in seconds; remove the others first.")
    return times


def unit_quaternion(given: ArrayLike) -> Array:
    """A quaternion (4,) of length one, or SomersaultError."""
    numbers = floats("attitude", given)
    size = float(np.linalg.norm(numbers)) if numbers.shape == (4,) else math.nan
    if not (math.isfinite(size) and size > 0):
        raise SomersaultError(
            f"The attitude must be a quaternion [w, x, y, z] of finite numbers, not {shown(given)}."
        )
    return numbers / size
