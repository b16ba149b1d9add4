"""Bounds on a quantity, or on its size."""

from __future__ import annotations

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number


def check_bounds(where: str, most: float | None, least: float | None) -> None:
    """SomersaultError, naming `where` they are, for bounds that nothing or everything is within."""
    for name, bound in (("most", most), ("least", least)):
        if bound is not None:
            number(f"{where}.{name}", bound)
    if most is None and least is None:
        raise SomersaultError(f"{where} has no bounds; give most, least, or both")
    if least is None and most is not None and most <= 0:
        raise SomersaultError(
            f"{where}.most must be positive, as it is for a size, and is {most:g}; for a range "
            "give least as well"
        )
    if most is not None and least is not None and not least < most:
        raise SomersaultError(f"{where}.least is {least:g}, and must be below most, {most:g}")


def outside(values: Array, most: float | None, least: float | None) -> Array:
    """By how much values are outside their bounds, negative for those within.

    `most` alone bounds the size, `least` alone the quantity from below; both are a range.
    """
    if least is None:
        return np.abs(values) - most
    below = least - values
    return below if most is None else np.maximum(below, values - most)


def scale(most: float | None, least: float | None) -> float:
    """The size of the bounds; 1 where they are 0."""
    return max(abs(bound) for bound in (most, least) if bound is not None) or 1.0


def bounds_in_words(most: float | None, least: float | None) -> str:
    """As "within 0.1", "at least 2", "from -1 to 2"."""
    if least is None:
        return f"within {most:g}"
    return f"at least {least:g}" if most is None else f"from {least:g} to {most:g}"
