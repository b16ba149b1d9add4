"""Normal deviates in symbols, the same on every machine.

The generator is MRG32k3a (P. L'Ecuyer, Good parameters and implementations for combined multiple
recursive random number generators, Operations Research 47, 1999), whose arithmetic is exact in
doubles; its uniform numbers become normal ones by Box and Muller.
"""

from __future__ import annotations

from typing import Any

import casadi as ca
import numpy as np

from somersault._core.array import Array

STATE = 6
"""Numbers of the generator's state."""

_M1, _M2 = 4294967087.0, 4294944443.0
_A12, _A13, _A21, _A23 = 1403580.0, 810728.0, 527612.0, 1370589.0


class Noise:
    """A generator in symbols.

    Parameters
    ----------
    state : list
        `STATE` symbols.

    Attributes
    ----------
    state : list
        After what was drawn.
    """

    def __init__(self, state: list[Any]) -> None:
        self.state = list(state)
        self._spare: Any = None

    def normal(self) -> Any:
        """A standard normal deviate.

        Returns
        -------
        casadi.SX
        """
        if self._spare is not None:
            spare, self._spare = self._spare, None
            return spare
        radius = ca.sqrt(-2 * ca.log(self._uniform()))
        angle = 2 * np.pi * self._uniform()
        self._spare = radius * ca.sin(angle)
        return radius * ca.cos(angle)

    def _uniform(self) -> Any:
        """Above 0 and below 1."""
        a, b, c, d, e, f = self.state
        first = _remainder(_A12 * b - _A13 * a, _M1)
        second = _remainder(_A21 * f - _A23 * d, _M2)
        self.state = [b, c, first, e, f, second]
        apart = first - second
        return (apart + _M1 * (apart <= 0)) / (_M1 + 1)


def seeds(numbers: Array) -> Array:
    """States of a generator that are as different as can be, one for each number.

    Parameters
    ----------
    numbers : ndarray, (N,)

    Returns
    -------
    ndarray, (N, 6)
    """
    bits = np.ascontiguousarray(numbers, float).view(np.uint64)
    result = np.empty((len(bits), STATE))
    for k in range(STATE):  # splitmix64, whose increments are the golden ratio's
        z = bits + np.uint64((0x9E3779B97F4A7C15 * (k + 1)) % 2**64)
        z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        z ^= z >> np.uint64(31)
        most = np.uint64(_M1 if k < STATE // 2 else _M2)
        result[:, k] = 1 + z % (most - np.uint64(1))
    return result


def _remainder(number: Any, modulus: float) -> Any:
    """Of a whole number below 2⁵³; the quotient may be off by one where it is nearly whole."""
    left = number - modulus * ca.floor(number / modulus)
    left = left + modulus * (left < 0)
    return left - modulus * (left >= modulus)
