"""Prescribed joint paths: polynomials of degree five between knots.

Smooth moves between held values are the quintic 10 s³ − 15 s⁴ + 6 s⁵ of each move's own time,
so that rate and acceleration are zero at both ends and continuous throughout. Before the first
knot and after the last a path is held, whatever it is made of. Torques go along paths too,
straight or held between samples.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import factorial
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError

DEGREE = 5
TAPE_DEGREE = 12
_SHORTEST = 1e-6  # s
_EARLY = 1e-9  # s that count as none
_ROUNDING = 1e-12


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

    def __repr__(self) -> str:
        return f"Path({self.knots.shape[-1]} knots)"

    def image(self, sign: float, offset: float) -> Path:
        """The path sign · this + offset, as of a mirrored joint.

        Parameters
        ----------
        sign, offset : float

        Returns
        -------
        Path
        """
        coefficients = sign * self.coefficients
        coefficients[..., 0] += offset
        return Path(self.knots, coefficients, self.known)

    def scaled(self, factor: float) -> Path:
        """The same path in another time, stretched about time 0.

        Parameters
        ----------
        factor : float
            Times are multiplied by it.

        Returns
        -------
        Path
        """
        with np.errstate(all="ignore"):  # what overflows is refused later
            powers = factor ** np.arange(DEGREE + 1)
            known = (factor * self.known[0], factor * self.known[1])
            return Path(self.knots * factor, self.coefficients / powers, known)

    def delayed(self, seconds: float) -> Path:
        """The same path at a later time.

        Parameters
        ----------
        seconds : float

        Returns
        -------
        Path
        """
        known = (self.known[0] + seconds, self.known[1] + seconds)
        return Path(self.knots + seconds, self.coefficients, known)

    def reversed(self, end: float) -> Path:
        """The same path backwards in time: at t it is where it was at `end` − t.

        Parameters
        ----------
        end : float
            s.

        Returns
        -------
        Path
        """
        spans = np.diff(self.knots, axis=-1)
        nothing = np.zeros((*spans.shape[:-1], 1))
        # Each piece's time runs on from its other end; before the first knot and after the last
        # it has none, and runs from the same one.
        shift = np.concatenate([nothing, spans, nothing], -1)[..., None]
        powers = []
        rest = np.moveaxis(self.coefficients, -1, 0)
        for k in range(DEGREE + 1):
            value = np.zeros(rest.shape[1:])
            for c in reversed(rest):
                value = value * shift[..., 0] + c
            powers.append(value * (-1.0) ** k / factorial(k))
            rest = np.stack([j * c for j, c in enumerate(rest)][1:] or [np.zeros(rest.shape[1:])])
        coefficients = np.stack(powers, -1)[..., ::-1, :]
        known = (end - self.known[1], end - self.known[0])
        return Path(end - self.knots[..., ::-1], coefficients, known)

    def check_known(self, joint: str, duration: float) -> None:
        """Check that the path may be followed from time 0 for a duration.

        Parameters
        ----------
        joint : str
            The joint that a message names.
        duration : float
            s.

        Raises
        ------
        SomersaultError
            Where the recording starts later or ends earlier.
        """
        first, last = self.known
        if first > _EARLY or last < duration - _EARLY:
            raise SomersaultError(
                f"joint {joint}: its motion is recorded from {first:g} to {last:g} s and the "
                f"flight lasts from 0 to {duration:g} s; fly within the recording"
            )

    def at(self, times: Array) -> tuple[Array, Array]:
        """The polynomials that hold at some times, and just after them.

        Parameters
        ----------
        times : ndarray, shape (N, K)
            s.

        Returns
        -------
        origins : ndarray, shape (N, K)
            The times from which the polynomials count, s.
        coefficients : ndarray, shape (N, K, 6)
            Of rising powers.
        """
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
    """Smooth moves through values at which the path is at rest.

    Parameters
    ----------
    times : ndarray, shape (..., K)
        s.
    values : ndarray, shape (..., K)

    Returns
    -------
    Path
        10 s³ − 15 s⁴ + 6 s⁵ between two values, s being the share of the time between them.
    """
    path = held(times, values)
    span, by = np.diff(times), np.diff(values)
    with np.errstate(divide="ignore", invalid="ignore"):  # of paths that are refused later
        for power, factor in ((3, 10.0), (4, -15.0), (5, 6.0)):
            path.coefficients[..., 1:-1, power] = factor * by / span**power
    return path


def as_moves(path: Path) -> tuple[Array, Array] | None:
    """The keyframes of a path of smooth moves.

    Parameters
    ----------
    path : Path

    Returns
    -------
    times, values : ndarray, shape (K,)
        s, and rad or m. None, in place of the two, for a path that is something else.
    """
    values = path.coefficients[..., 1:, 0]
    rebuilt = moves(path.knots, values).coefficients
    spans = np.pad(np.diff(path.knots), 1)[:, None] ** np.arange(DEGREE + 1)  # 0⁰ is 1
    size = np.abs(path.coefficients[..., 0]).max(initial=1e-300)
    alike = np.all(np.abs(rebuilt - path.coefficients) * spans <= _ROUNDING * size)
    alike &= not np.any(path.coefficients[[0, -1], 1:])  # held before and after
    return (path.knots, values) if alike else None


def straight(times: Array, values: Array) -> Path:
    """Straight lines through values; level before the first and after the last.

    Parameters
    ----------
    times : ndarray, shape (..., K)
        s.
    values : ndarray, shape (..., K)

    Returns
    -------
    Path
    """
    path = held(times, values)
    with np.errstate(divide="ignore", invalid="ignore"):  # of paths that are refused later
        path.coefficients[..., 1:-1, 1] = np.diff(values) / np.diff(times)
    return path


def held(times: Array, values: Array) -> Path:
    """Values that are held until the next one.

    Parameters
    ----------
    times : ndarray, shape (..., K)
        s.
    values : ndarray, shape (..., K)
        Each from its time on; the first one before that too.

    Returns
    -------
    Path
    """
    level = np.zeros((*values.shape[:-1], values.shape[-1] + 1, DEGREE + 1))
    level[..., 0, 0] = values[..., 0]
    level[..., 1:, 0] = values
    return Path(times, level)


def value(path: Path, time: float) -> tuple[float, float]:
    """Value and rate of one path at a time.

    Parameters
    ----------
    path : Path
        Of one flight.
    time : float
        s.

    Returns
    -------
    value, rate : float
    """
    origin, coefficients = path.at(np.array([[time]]))
    angle, rate, _ = polynomial(time - float(origin[0, 0]), coefficients[0, 0].tolist())
    return angle, rate


def polynomial(s: Any, coefficients: Sequence[Any]) -> tuple[Any, Any, Any]:
    """Value, rate and acceleration of a polynomial, by Horner's rule.

    Parameters
    ----------
    s : number, array or symbol
    coefficients : sequence
        Of rising powers of s; numbers, arrays or symbols.

    Returns
    -------
    value, rate, acceleration
        Of the kind that s and the coefficients are.
    """
    value = rate = half = 0.0
    for c in reversed(coefficients):
        half, rate, value = half * s + rate, rate * s + value, value * s + c
    return value, rate, 2 * half


def increasing(times: Array) -> Array:
    """Whether times increase, by a microsecond at least.

    Parameters
    ----------
    times : ndarray, shape (..., K)
        s.

    Returns
    -------
    ndarray of bool, shape (...)
    """
    return np.all(np.diff(times) >= _SHORTEST, -1)


def check_rows(times: Array, values: Array, what: str) -> None:
    """Check that times and values can be a path.

    Parameters
    ----------
    times, values : ndarray, shape (K,)
    what : str
        What the values are, for a message.

    Raises
    ------
    SomersaultError
        For rows of different lengths, numbers that are not finite, and times that do not increase.
    """
    if times.ndim != 1 or times.shape != values.shape or not times.size:
        raise SomersaultError(f"needs as many times as {what}, at least one of each")
    if not (np.all(np.isfinite(times)) and np.all(np.isfinite(values))):
        raise SomersaultError(f"has times or {what} that are not finite")
    if not increasing(times):
        raise SomersaultError("has times that do not increase, by a microsecond at least")
