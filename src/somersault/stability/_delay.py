"""Feedback after a delay: the roots of p(s) = q(s) e^(−s τ), and the delays that are stable.

As the delay grows roots cross the imaginary axis at frequencies that do not depend on it, where
|p(iω)| = |q(iω)|, and in a sense that does not either (K. L. Cooke and P. van den Driessche, On
zeroes of some transcendental equations, Funkcialaj Ekvacioj 29, 1986). So the stable delays follow
from the roots of polynomials, without any approximation of the delay.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import whole_number
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number

_NODES = 24  # of the spectral method, before roots are polished
_POLISHES = 20
_ROUNDING = 1e-9
_SHORTEST = 1e-9  # delay, in units of 1/Ω
_MOST_ROOTS = 100
_MOST_CROSSINGS = 10_000


@dataclass(frozen=True, eq=False)
class DelayedFeedback:
    """ẏ = A y + b u with u(t) = c·y(t − τ) + d u(t − τ), for any delay τ; time in units of 1/Ω.

    `stability.feedback` makes one of a steady spin. Where 0 is a root of both p and q, whatever the
    delay, something may stand anywhere and is not sensed: arms that are a little to one side, with
    a law of their rate alone. Such roots are left out.

    Attributes
    ----------
    matrix : numpy.ndarray, shape (n, n)
        A.
    drive, sensed : numpy.ndarray, shape (n,)
        b and c.
    direct : float
        d.
    """

    matrix: Array
    drive: Array
    sensed: Array
    direct: float = 0.0

    @cached_property
    def polynomials(self) -> tuple[Array, Array]:
        """p and q, by falling powers, of one length, without roots 0 that they share."""
        p = np.poly(self.matrix)
        q = np.poly(self.matrix - np.outer(self.drive, self.sensed)) + (self.direct - 1) * p
        while len(p) > 1 and max(abs(p[-1]), abs(q[-1])) < _ROUNDING * np.abs([p, q]).max():
            p, q = p[:-1], q[:-1]
        return p, q

    def roots(self, delay: float, count: int = 10) -> Array:
        """The roots that decay most slowly, or grow fastest.

        Parameters
        ----------
        delay : float
            τ in units of 1/Ω; of a somersault it is τ / 2π.
        count : int
            How many, at most.

        Returns
        -------
        numpy.ndarray, shape (count,), complex
            In units of Ω, by falling real part.

        Raises
        ------
        SomersaultError
            For a delay or a count that is none, and with a delay for feedback of what it commands
            itself, which has infinitely many roots with about the same real part.

        Examples
        --------
        >>> import numpy as np
        >>> from somersault.stability import DelayedFeedback
        >>> one = np.ones((1, 1))
        >>> DelayedFeedback(0 * one, one[0], -np.pi / 2 * one[0]).roots(1.0, 2).imag.round(6)
        array([ 1.570796, -1.570796])
        """
        delay, count = _delay(delay), whole_number("count", count, 1, _MOST_ROOTS)
        p, q = self.polynomials
        if 0 < delay < _SHORTEST:
            raise SomersaultError(f"a delay of {delay:g} cannot be told from none; give 0")
        if delay == 0:
            return _sorted(np.roots(np.trim_zeros(p - q, "f")))[:count]
        if abs(self.direct) > _ROUNDING:
            raise SomersaultError(
                "this feedback senses what it commands itself; ask for its stable_delays, or sense "
                "something else"
            )
        with np.errstate(over="ignore", invalid="ignore"):  # roots far out, which are left out
            found = _polished(p, q, delay, np.linalg.eigvals(self._spectral(delay)))
        return _sorted(found)[:count]

    def growth_rate(self, delay: float) -> float:
        """The greatest real part of all roots.

        Parameters
        ----------
        delay : float
            As for `roots`.

        Returns
        -------
        float
            In units of Ω.

        Examples
        --------
        >>> import numpy as np
        >>> from somersault.stability import DelayedFeedback
        >>> one = np.ones((1, 1))
        >>> round(DelayedFeedback(0 * one, one[0], -2 * one[0]).growth_rate(1.0), 6)
        0.172816
        """
        return float(self.roots(delay, 1)[0].real)

    def stable_delays(self, most: float = 2 * np.pi) -> tuple[tuple[float, float], ...]:
        """The ranges of delays for which every motion decays.

        Parameters
        ----------
        most : float
            The longest delay that is looked at, in units of 1/Ω; by default a somersault.

        Returns
        -------
        tuple of (float, float)
            Exact, but for rounding.

        Raises
        ------
        SomersaultError
            For a longest delay that is none.

        Examples
        --------
        >>> import numpy as np
        >>> from somersault.stability import DelayedFeedback
        >>> one = np.ones((1, 1))
        >>> loop = DelayedFeedback(0 * one, one[0], -one[0])
        >>> [(float(a), round(float(b), 6)) for a, b in loop.stable_delays()]
        [(0.0, 1.570796)]
        """
        most = _delay(most)
        p, q = self.polynomials
        if abs(self.direct) >= 1 - _ROUNDING or _vanishes(p, q):
            return ()  # short waves grow; or a root that no delay moves is on the axis
        unstable = int(np.sum(np.roots(np.trim_zeros(p - q, "f")).real > -_ROUNDING))
        ranges, begun = [], 0.0
        for delay, change in self._crossings(most):
            if unstable == 0 and delay > begun:
                ranges.append((begun, delay))
            unstable, begun = unstable + change, delay
        if unstable == 0 and most > begun:
            ranges.append((begun, most))
        return tuple(ranges)

    def _crossings(self, most: float) -> list[tuple[float, int]]:
        """Delays up to `most` at which two roots cross the imaginary axis, and by how many there
        are then more to its right."""
        p, q = self.polynomials
        found = []
        for omega, sense in _frequencies(p, q):
            angle = -float(np.angle(np.polyval(p, 1j * omega) / np.polyval(q, 1j * omega)))
            first = (angle % (2 * np.pi)) / omega
            count = max(int((most - first) * omega / (2 * np.pi) + 1), 0)
            if count > _MOST_CROSSINGS:
                raise SomersaultError(f"a delay of {most:g} is too long to look at; shorten it")
            found += [(first + 2 * np.pi * k / omega, 2 * sense) for k in range(count)]
        return sorted(found)

    def _spectral(self, delay: float) -> Array:
        """The matrix whose eigenvalues are near the roots: the past as its values at Chebyshev
        points (D. Breda, S. Maset, R. Vermiglio, Pseudospectral differencing methods for
        characteristic roots of delay differential equations, SIAM J. Sci. Comput. 27, 2005)."""
        n = len(self.matrix)
        k = np.arange(_NODES + 1)
        points = np.cos(np.pi * k / _NODES)  # 1 is now, −1 is a delay ago
        weight = np.where((k == 0) | (k == _NODES), 2.0, 1.0) * (-1.0) ** k
        apart = points[:, None] - points + np.eye(_NODES + 1)
        slopes = np.outer(weight, 1 / weight) / apart
        slopes -= np.diag(slopes.sum(1))
        whole = np.kron(slopes * 2 / delay, np.eye(n))
        whole[:n] = 0.0
        whole[:n, :n] = self.matrix
        whole[:n, -n:] = np.outer(self.drive, self.sensed)
        return whole


def _delay(value: float) -> float:
    if number("delay", value) < 0:
        raise SomersaultError(f"a delay of {value:g} is before anything was sensed; give 0 or more")
    return float(value)


def _vanishes(p: Array, q: Array) -> bool:
    """Whether 0 is a root, whatever the delay."""
    size = np.abs(p).max() + np.abs(q).max()
    return bool(abs(p[-1] - q[-1]) < _ROUNDING * size)


def _frequencies(p: Array, q: Array) -> list[tuple[float, int]]:
    """Each ω > 0 with |p(iω)| = |q(iω)|, and +1 where roots cross to the right there, else −1."""
    difference = _squared(p) - _squared(q)  # a polynomial of ω²
    roots = np.roots(np.trim_zeros(difference, "f"))
    real = roots[np.abs(roots.imag) < 1e-7 * np.maximum(np.abs(roots), 1.0)].real
    slope = np.polyder(difference)
    return [
        (float(np.sqrt(x)), 1 if np.polyval(slope, x) > 0 else -1) for x in np.sort(real) if x > 0
    ]


def _squared(polynomial: Sequence[float] | Array) -> Array:
    """|f(iω)|² as a polynomial of ω², by falling powers."""
    rising = np.asarray(polynomial)[::-1]
    k = np.arange(len(rising))
    even = np.where(k % 2 == 0, rising * (-1.0) ** (k // 2), 0.0)
    odd = np.where(k % 2 == 1, rising * (-1.0) ** (k // 2), 0.0)
    return (np.convolve(even, even) + np.convolve(odd, odd))[::2][::-1]


def _polished(p: Array, q: Array, delay: float, guesses: Array) -> Array:
    """Guesses improved by Newton's method, without those that come to nothing."""
    s = guesses[guesses.real > -_NODES / (2 * delay)]  # further left they are no roots' guesses
    dp, dq = np.polyder(p), np.polyder(q)
    for _ in range(_POLISHES):
        late = np.exp(-s * delay)
        value = np.polyval(p, s) - np.polyval(q, s) * late
        slope = np.polyval(dp, s) - (np.polyval(dq, s) - delay * np.polyval(q, s)) * late
        with np.errstate(divide="ignore", invalid="ignore"):
            change = np.where(value == 0, 0.0, value / slope)
        s = s - np.where(np.isfinite(change), change, 0.0)
    near = np.abs(change) < 1e-8 * (1 + np.abs(s))
    return _apart(s[near])


def _apart(roots: Array) -> Array:
    """Roots without those that were found twice."""
    kept: list[complex] = []
    for root in roots:
        if all(abs(root - other) > 1e-7 * (1 + abs(root)) for other in kept):
            kept.append(root)
    return np.array(kept, complex)


def _sorted(roots: Array) -> Array:
    order = np.lexsort((-roots.imag, -roots.real.round(9)))
    return np.asarray(roots, complex)[order]
