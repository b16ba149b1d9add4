"""Gauss–Legendre collocation: where a polynomial meets the equations within an interval."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from somersault._core.array import Array


@dataclass(frozen=True)
class Tableau:
    """Weights of collocation on the interval from 0 to 1.

    Parameters
    ----------
    stages : array (s,)
        Where the equations are met.
    inner : array (s, s)
        The integral from 0 to stage i of the polynomial that is 1 at stage j and 0 at the others.
    weights : array (s,)
        The same integral from 0 to 1.
    """

    stages: Array
    inner: Array
    weights: Array

    @property
    def order(self) -> int:
        """Errors fall with this power of the interval's length."""
        return 2 * len(self.stages)


def gauss_legendre(count: int) -> Tableau:
    """Collocation at the `count` roots of the Legendre polynomial (Hairer, Lubich and Wanner 2006,
    Geometric Numerical Integration, section II.1.3)."""
    roots, _ = np.polynomial.legendre.leggauss(count)
    stages = (1 + roots) / 2
    powers = np.arange(count)
    lagrange = np.linalg.inv(stages[:, None] ** powers)  # coefficients by column
    integral = lagrange / (powers + 1)[:, None]
    inner = stages[:, None] ** (powers + 1) @ integral
    return Tableau(stages, inner, integral.sum(0))
