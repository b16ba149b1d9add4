"""Functions of one coordinate in `.osim` files: lines, and curves.

Lines move a joint exactly. A curve is whatever is not a line: splines, mostly, that move the
shank along the condyles or the scapula along the ribs.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import factorial
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault.model.read._osim_words import Words
from somersault.model.read._xml import Element

_STRAIGHT = 1e-12  # of a table's extent: how far points on a line may be from it
_FINE = 2001  # points at which a curve is looked at over a coordinate's range


@dataclass(frozen=True, slots=True)
class Line:
    """slope · q + offset."""

    slope: float
    offset: float = 0.0

    def __call__(self, q: float) -> float:
        return self.slope * q + self.offset

    def of(self, inner: Line) -> Line:
        """This line of another one's value."""
        return Line(self.slope * inner.slope, self.slope * inner.offset + self.offset)

    def over(self, range: tuple[float, float]) -> tuple[float, float]:
        """The least and the greatest value over a range of q."""
        ends = self(range[0]), self(range[1])
        return min(ends), max(ends)

    @property
    def inverse(self) -> Line:
        """q from the value."""
        return Line(1 / self.slope, -self.offset / self.slope)


@dataclass(frozen=True, slots=True)
class Curve:
    """Any other function; `values` takes an array of q (K,) and returns theirs."""

    values: Callable[[Array], Array]

    def __call__(self, q: float) -> float:
        return float(self.values(np.array([q]))[0])

    def over(self, range: tuple[float, float]) -> tuple[float, float]:
        """The least and the greatest value over a range of q."""
        values = self.values(np.linspace(*range, _FINE))
        return float(values.min()), float(values.max())


Function = Line | Curve


def function(words: Words, element: Element) -> Function:
    """The function that an element of a `.osim` file describes."""
    if element.tag not in _KINDS:
        raise words.error(
            f"is a function that is not supported; use one of {', '.join(_KINDS)}",
            element,
        )
    return _KINDS[element.tag](words, element)


def _constant(words: Words, element: Element) -> Function:
    return Line(0.0, words.number(element, "value", 0.0))


def _linear(words: Words, element: Element) -> Function:
    return _power_series(words.numbers(element, "coefficients", (1.0, 0.0)), words, element)


def _polynomial(words: Words, element: Element) -> Function:
    return _power_series(words.numbers(element, "coefficients"), words, element)


def _power_series(coefficients: list[float], words: Words, element: Element) -> Function:
    """Highest power first, as both kinds have them."""
    if element.tag == "LinearFunction" and len(coefficients) > 2:
        raise words.error("has more coefficients than its one coordinate; give two", element)
    if not any(coefficients[:-2]):
        slope, offset = [0.0, 0.0, *coefficients][-2:]
        return Line(slope, offset)
    return Curve(lambda q: np.polyval(coefficients, q))


def _scaled(words: Words, element: Element) -> Function:
    inner = element.first("function")
    if inner is None or len(inner.children) != 1:
        raise words.error("has no function to multiply; give it one", element)
    of, scale = function(words, inner.children[0]), words.number(element, "scale", 1.0)
    if isinstance(of, Line):
        return Line(scale * of.slope, scale * of.offset)
    return Curve(lambda q: scale * of.values(q))


def _points(words: Words, element: Element) -> tuple[Array, Array]:
    x, y = (np.array(words.numbers(element, name)) for name in ("x", "y"))
    if len(x) != len(y) or len(x) < 2 or np.any(np.diff(x) <= 0):
        raise words.error("needs two or more points with increasing x, and a y for each", element)
    return x, y


def _straight(x: Array, y: Array) -> Line | None:
    """The line through all points, if there is one."""
    slope = (y[-1] - y[0]) / (x[-1] - x[0])
    line = Line(float(slope), float(y[0] - slope * x[0]))
    if abs(line.offset) < _STRAIGHT * np.abs(y).max():
        line = Line(line.slope)  # rounding
    off = np.abs(y - (line.slope * x + line.offset)).max()
    return line if off <= _STRAIGHT * max(np.abs(y).max(), np.ptp(y)) else None


def _pieces(words: Words, element: Element) -> Function:
    x, y = _points(words, element)
    return _straight(x, y) or Curve(_spline(x, y, 1, None, outside=1))


def _simm_spline(words: Words, element: Element) -> Function:
    """A cubic spline whose third derivative at either end is that of the cubic through the four
    points there (Forsythe, Malcolm and Moler 1977, ch. 4), and which goes straight on beyond."""
    x, y = _points(words, element)
    if straight := _straight(x, y):
        return straight
    ends = [6 * _divided(x[part], y[part]) if len(x) > 3 else 0.0 for part in _FOURS]
    return Curve(_spline(x, y, 3, ([(3, ends[0])], [(3, ends[1])]), outside=1))


_FOURS = (slice(4), slice(-4, None))


def _divided(x: Array, y: Array) -> float:
    """The divided difference over all points."""
    for order in range(1, len(x)):
        y = np.diff(y) / (x[order:] - x[:-order])
    return float(y[0])


def _gcv_spline(words: Words, element: Element) -> Function:
    """An interpolating natural spline (Woltring 1986), beyond its ends a polynomial of less than
    half its degree."""
    x, y = _points(words, element)
    half = int(words.number(element, "half_order", 3.0))
    if words.number(element, "error_variance", 0.0) != 0:
        raise words.error("smooths its points; give it the error_variance 0", element)
    if half not in (1, 2, 3, 4) or len(x) < 2 * half:
        raise words.error("needs a half_order of 1 to 4, and twice as many points", element)
    if straight := _straight(x, y) if half > 1 else None:
        return straight
    degree = 2 * half - 1
    natural = [(order, 0.0) for order in range(half, degree)]
    ends = (natural, natural) if natural else None
    return Curve(_spline(x, y, degree, ends, outside=half - 1))


def _spline(x: Array, y: Array, degree: int, ends: Any, outside: int) -> Any:
    """A spline that goes on beyond its ends by its derivatives up to that order."""
    from scipy.interpolate import make_interp_spline

    spline = make_interp_spline(x, y, degree, bc_type=ends)
    taylor = [
        (end, [float(spline(end, nu)) / factorial(nu) for nu in range(1, outside + 1)])
        for end in (x[0], x[-1])
    ]

    def values(q: Array) -> Array:
        result = spline(np.clip(q, x[0], x[-1]))
        for (end, terms), beyond in zip(taylor, (np.minimum, np.maximum), strict=True):
            past = beyond(q - end, 0)
            result = result + sum(term * past**k for k, term in enumerate(terms, 1))
        return np.asarray(result)

    return values


_KINDS: dict[str, Callable[[Words, Element], Function]] = {
    "Constant": _constant,
    "LinearFunction": _linear,
    "PolynomialFunction": _polynomial,
    "MultiplierFunction": _scaled,
    "PiecewiseLinearFunction": _pieces,
    "SimmSpline": _simm_spline,
    "NaturalCubicSpline": _simm_spline,
    "natCubicSpline": _simm_spline,
    "GCVSpline": _gcv_spline,
}
