"""Somersault, tilt and twist of a tumbling body whose angular momentum lies along inertial 2 (A.4).

A.22 to A.33 take axis 3 as the figure axis, whose precession about h is the somersault. That
integral has 1 − c3² in its denominator, which vanishes as h nears axis 3. So here the figure
axis is the one of `a` and `c` that stays more than 45° away from h, which makes every formula
well conditioned, and the somersault follows by the angle at h between the two axes.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from somersault import attitude
from somersault._core.array import Array
from somersault.rigid._jacobi import Elliptic, complete_third_kind, elliptic, third_kind
from somersault.rigid._orbit import Orbit

_RELABEL = np.array(  # the turn that makes body axis f, f + 1, f + 2 into 3, 1, 2
    [[0.5, -0.5, -0.5, -0.5], [0.5, 0.5, 0.5, 0.5], [1.0, 0.0, 0.0, 0.0]]
)
Pair = Callable[[Array], tuple[Array, Array]]


@dataclass(frozen=True, eq=False)
class Precession:
    """Attitude along an orbit, in inertial axes of which 2 is along the angular momentum."""

    inertias: Array
    momentum: float
    orbit: Orbit

    @cached_property
    def figure(self) -> int:
        """The axis, as a place, whose precession is integrated: |c_f|² ≤ ½ all along."""
        a, _, c = self.orbit.axes
        return c if self.orbit.reach[c] <= self.orbit.reach[a] else a

    @cached_property
    def _coefficients(self) -> tuple[float, float, float]:
        """α, β and n of φ̇ = α + β/(1 + n sn²): A.25 as L2/L4 and L1/L3 − L2/L4, n = L4/L3."""
        f = self.figure
        a, _, c = self.orbit.axes
        other = c if f == a else a
        k_squared = 1.0 if f == a else (1 - self.orbit.kc) * (1 + self.orbit.kc)
        alpha = self.momentum / self.inertias[f]
        beta = alpha * self.orbit.excess[f] / self.orbit.reach[other]
        n = self.orbit.reach[f] * k_squared / self.orbit.reach[other]
        return float(alpha), float(beta), float(n)

    def cosines(self, at: Elliptic) -> Array:
        """Direction cosines of h (…, 3) on the half orbit that is counted from −K to K."""
        return self.inertias * self.orbit.omega(at) / self.momentum

    def figure_angles(self, t: Array) -> tuple[Array, Array, Array]:
        """2-1-3 angles (…) of the body with its axes relabelled so that the figure axis is 3."""
        f, at = self.figure, self.orbit.elliptic(t)
        alpha, beta, n = self._coefficients
        begin = third_kind(self.orbit.elliptic(np.zeros(())), n, self.orbit.kc)
        slow = (third_kind(at, n, self.orbit.kc) - begin) / self.orbit.rate
        turned = (alpha + beta) * t - beta * slow
        c = self.cosines(at) * self.orbit.flips(at)
        tilt = -np.arctan2(c[..., f], np.hypot(c[..., f - 2], c[..., f - 1]))
        return turned, tilt, self._turning(at, _longitude(f), f == self.orbit.axes[2])

    def quaternion(self, t: Array) -> Array:
        """Body to those inertial axes (…, 4), continuous in t (…), with φ = 0 at t = 0."""
        turned = attitude.quaternion_from_angles(*self.figure_angles(t))
        return attitude.quaternion_product(turned, _RELABEL[self.figure])

    def angles(self, t: Array) -> Array:
        """(Φ, Θ, Ψ) (…, 3), continuous in t (…), with the somersault of `quaternion`."""
        at = self.orbit.elliptic(t)
        turned, _, _ = self.figure_angles(t)
        c = self.cosines(at) * self.orbit.flips(at)
        tilt = -np.arctan2(c[..., 2], np.hypot(c[..., 0], c[..., 1]))
        twist = self._turning(at, _longitude(2), self.orbit.axes[2] == 2)
        return np.stack([turned + self._between(at), tilt, twist], -1)

    def _between(self, at: Elliptic) -> Array:
        """Angle about h from the figure axis to axis 3."""
        f, c = self.figure, self.orbit.axes[2]
        if f == 2:
            return np.zeros(np.shape(at.v))
        return self._turning(at, _azimuth(f), c in (f, 2))

    def _turning(self, at: Elliptic, pair: Pair, winds: bool) -> Array:
        """The angle atan2(y, x) of a pair of functions of the cosines, counted through turns.

        Either the pair goes round once an orbit, half a turn on each half of it, or it
        stays on the side of the origin that the axis c is on.
        """
        c = self.cosines(at)
        if winds:
            y0, x0 = pair(self.cosines(elliptic(np.zeros(()), self.orbit.kc)))
            sense = self._sense(pair)
        else:
            y0, x0 = pair(np.eye(3)[self.orbit.axes[2]] * np.sign(self.orbit.greatest))
            c, sense = c * self.orbit.flips(at), 0.0
        y, x = pair(c)
        angle = np.arctan2(y * x0 - x * y0, x * x0 + y * y0)
        return np.arctan2(y0, x0) + angle + np.pi * sense * at.turns

    def _sense(self, pair: Pair) -> float:
        """+1 or −1: the way round of a pair that winds."""
        y0, x0 = pair(self.cosines(elliptic(np.zeros(()), self.orbit.kc)))
        y, x = pair(self.cosines(elliptic(np.full((), 0.5), self.orbit.kc)))
        return float(np.sign(y * x0 - x * y0))

    @cached_property
    def mean_rates(self) -> tuple[float, float]:
        """Mean Φ̇ and Ψ̇, rad/s, over an orbit; on the separatrix over all time."""
        alpha, beta, n = self._coefficients
        kc, quarter = self.orbit.kc, self.orbit.quarter
        if math.isinf(quarter):
            return alpha + beta / (1 + n), 0.0
        f, c = self.figure, self.orbit.axes[2]
        circling = math.pi * self.orbit.rate / (2 * quarter)
        somersault = alpha + beta * (1 - complete_third_kind(n, kc) / quarter)
        if f != 2 and c in (f, 2):
            somersault += self._sense(_azimuth(f)) * circling
        return somersault, self._sense(_longitude(2)) * circling if c == 2 else 0.0


def _longitude(f: int) -> Pair:
    """(y, x) of the twist about body axis f: A.21 with its signs, f = 2 for axis 3."""
    return lambda c: (c[..., f - 2], c[..., f - 1])


def _azimuth(f: int) -> Pair:
    """(y, x) of the angle about h from body axis f to axis 3."""
    g = 1 - f  # the remaining place: e_1 × e_3 = −e_2 and e_2 × e_3 = e_1
    sign = -1.0 if f == 0 else 1.0
    return lambda c: (sign * c[..., g], -c[..., f] * c[..., 2])
