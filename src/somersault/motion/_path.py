"""Prescribed joint paths: polynomials of degree five between knots.

Smooth moves between held values are the quintic 10 s³ − 15 s⁴ + 6 s⁵ of each move's own time,
so that rate and acceleration are zero at both ends and continuous throughout. Before the first
knot and after the last a path is held, whatever it is made of.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError

DEGREE = 5
TAPE_DEGREE = 12
_SHORTEST = 1e-6  # s
_EARLY = 1e-9  # s that count as none


@dataclass(frozen=True, eq=False)
class Path:
    """Polynomials of degree five between knots, for one flight or many.

    `knots` (…, K), s; `coefficients` (…, K + 1, 6): before the first knot, between knots, after
    the last; rising powers of the time since the knot before (the first knot, for the first).
    `known` is from when until when it may be followed, s: a recording ends.
    """

    knots: Array
    coefficients: Array
    known: tuple[float, float] = (-np.inf, np.inf)

    def image(self, sign: float, offset: float) -> Path:
        """The path sign · this + offset."""
        coefficients = sign * self.coefficients
        coefficients[..., 0] += offset
        return Path(self.knots, coefficients, self.known)

    def check_known(self, joint: str, duration: float) -> None:
        """SomersaultError unless it may be followed from 0 for so long."""
        first, last = self.known
        if first > _EARLY or last < duration - _EARLY:
            raise SomersaultError(
                f"joint {joint}: its motion is recorded from {first:g} to {last:g} s and the "
                f"flight lasts from 0 to {duration:g} s; fly within the recording"
            )

    def at(self, times: Array) -> tuple[Array, Array]:
        """Origins (N, K) and coefficients (N, K, 6) that hold at times (N, K), and after them."""
        if self.knots.ndim == 1:
            place = np.searchsorted(self.knots, times, side="right")
        else:
            place = np.zeros(np.broadcast_shapes(times.shape, (len(self.knots), 1)), int)
            for knots in self.knots.T:
                place += knots[:, None] <= times
        rows = np.arange(len(self.knots))[:, None] if self.knots.ndim > 1 else 0
        knots, coefficients = np.atleast_2d(self.knots), self.coefficients
        coefficients = coefficients if coefficients.ndim > 2 else coefficients[None]
        return knots[rows, np.maximum(place - 1, 0)], coefficients[rows, place]


def moves(times: Array, values: Array) -> Path:
    """Smooth moves through held values (…, K) at times (…, K)."""
    held = np.zeros((*values.shape[:-1], values.shape[-1] + 1, DEGREE + 1))
    held[..., 0, 0] = values[..., 0]
    held[..., 1:, 0] = values
    span, by = np.diff(times), np.diff(values)
    with np.errstate(divide="ignore", invalid="ignore"):  # of paths that are refused later
        for power, factor in ((3, 10.0), (4, -15.0), (5, 6.0)):
            held[..., 1:-1, power] = factor * by / span**power
    return Path(times, held)


def value(path: Path, time: float) -> tuple[float, float]:
    """Value and rate of one path at a time."""
    origin, coefficients = path.at(np.array([[time]]))
    angle, rate, _ = polynomial(time - float(origin[0, 0]), coefficients[0, 0].tolist())
    return angle, rate


def polynomial(s: Any, coefficients: Sequence[Any]) -> tuple[Any, Any, Any]:
    """Value, rate and acceleration of a polynomial in s, by Horner's rule, symbolic or not."""
    value = rate = half = 0.0
    for c in reversed(coefficients):
        half, rate, value = half * s + rate, rate * s + value, value * s + c
    return value, rate, 2 * half


def increasing(times: Array) -> Array:
    """Whether times (…, K) increase, by a microsecond at least, (…)."""
    return np.all(np.diff(times) >= _SHORTEST, -1)


def check(times: Array, values: Array) -> None:
    """SomersaultError unless times and values are a path."""
    if times.ndim != 1 or times.shape != values.shape or not times.size:
        raise SomersaultError("needs as many times as angles, at least one of each")
    if not (np.all(np.isfinite(times)) and np.all(np.isfinite(values))):
        raise SomersaultError("has times or angles that are not finite")
    if not increasing(times):
        raise SomersaultError("has times that do not increase, by a microsecond at least")
