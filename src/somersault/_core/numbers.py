"""Numbers from users and files: finite, of the right count, or one sentence."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import shown
from somersault._core.errors import SomersaultError

MOST = 1e9  # in SI units: beyond it nothing flies, and sums of squares lose their sense


def number(what: str, value: Any) -> float:
    """A finite float; SomersaultError naming `what` for anything else."""
    if isinstance(value, bool) or not isinstance(value, int | float | np.number):
        raise SomersaultError(f"{what} must be a number, and is {shown(value)}")
    try:
        result = float(value)
    except OverflowError:
        result = math.inf
    if not abs(result) <= MOST:
        raise SomersaultError(f"{what} must be a finite number below 1e9, and is {result:g}")
    return result


def as_floats(value: Any) -> Array | None:
    """An array of floats, None for what holds anything but real numbers."""
    try:
        array = np.asarray(value)
        if array.dtype.kind in "cmMSUV" or (
            array.dtype.kind == "O" and any(one is None for one in array.flat)  # nan to NumPy
        ):
            return None
        return array.astype(float, copy=False)
    except Exception:  # whatever a user's own class does when it is asked for numbers
        return None


def numbers(what: str, value: Any, size: int | None = None, most: float = MOST) -> Array:
    """A row of finite floats, of `size` if that is given, none beyond `most`."""
    result = as_floats(value)
    if result is None:
        result = np.array(np.nan)
    wanted = "a row of" if size is None else str(size)
    if result.ndim != 1 or (size is not None and result.shape != (size,)):
        raise SomersaultError(f"{what} must be {wanted} numbers, and is {shown(value)}")
    if not np.all(np.isfinite(result) & (np.abs(result) <= most)):
        raise SomersaultError(f"{what} must be finite numbers below 1e9, and is {shown(value)}")
    return result


def floats(what: str, value: Any, *ends: int) -> Array:
    """Floats of any shape, (…, *ends); SomersaultError naming `what`. They need not be finite."""
    result = as_floats(value)
    if result is None:
        raise SomersaultError(f"{what} must be numbers, and is {shown(value)}")
    if ends and result.shape[-len(ends) :] != ends:
        shape = ", ".join(map(str, ends))
        raise SomersaultError(f"{what} has shape {result.shape}, and must end in ({shape})")
    return result


def together(**values: Any) -> list[Array]:
    """Floats that broadcast against each other; SomersaultError with names and shapes if they do
    not."""
    arrays = {name: floats(name, value) for name, value in values.items()}
    require_together({name: array.shape for name, array in arrays.items()})
    return [*np.broadcast_arrays(*arrays.values())]


def require_together(shapes: dict[str, tuple[int, ...]]) -> tuple[int, ...]:
    """The shape to which values broadcast; SomersaultError, naming them, if they do not."""
    try:
        return np.broadcast_shapes(*shapes.values())
    except ValueError:
        listed = ", ".join(f"{name} {shape}" for name, shape in shapes.items() if shape)
        raise SomersaultError(
            f"these values do not go together: {listed}; give arrays of equal length, or of shapes "
            "that broadcast"
        ) from None
