"""One orbit integrated numerically: an independent check of the closed forms."""

from __future__ import annotations

import math

import numpy as np

from somersault._core.array import Array

_STEP = 0.1875  # errors of e^(−π²/step), which is rounding; exact in binary
_END = 40.0  # integrands fall as e^−|x| beyond their plateau


def period_and_somersault(inertias: Array, omega: Array) -> tuple[float, float]:
    """Period of ω, s, and the somersault about h in that time, rad, through ω (3,), rad/s.

    Sums dt and Φ̇ dt, Φ̇ of A.22, over a quarter of the orbit in elementary functions. The
    variable is x = log tan(am u): there both integrands are analytic in the strip
    |Im x| < π/2 however near the separatrix or axis 3 the orbit comes, so the trapezoidal
    rule converges exponentially. The motion must be neither steady nor on the separatrix.
    """
    squared = float(np.sum((inertias * omega) ** 2))
    twice = float(np.sum(inertias * omega**2))
    minor, b, major = (int(p) for p in np.argsort(inertias, kind="stable"))
    a, c = (major, minor) if twice * inertias[b] > squared else (minor, major)
    ia, ib, ic = inertias[[a, b, c]]
    # squares of the cosines of h where the orbit crosses the a-c and the b-c plane
    from_c = abs(squared - twice * ic) / squared
    reach_a = ia * from_c / abs(ia - ic)
    reach_b = ib * from_c / abs(ib - ic)
    rest = 1 - reach_b  # what is left of c_c² at b
    x = np.arange(-_END, _END - 0.5 * math.log(rest), _STEP)
    tan2 = np.exp(2 * x)
    cosines2 = np.empty((len(x), 3))
    cosines2[:, a] = reach_a / (1 + tan2)
    cosines2[:, b] = reach_b * tan2 / (1 + tan2)
    cosines2[:, c] = (1 - reach_a + rest * tan2) / (1 + tan2)
    # φ̇ of φ = am u, by Euler's equation for c_b = √reach_b sin φ
    h = math.sqrt(squared)
    speed = h * abs(1 / ic - 1 / ia) * np.sqrt(reach_a / reach_b * cosines2[:, c])
    dt = np.exp(x) / (1 + tan2) / speed * _STEP
    across = cosines2[:, :2]
    rate = h * (across / inertias[:2]).sum(-1) / across.sum(-1)
    return 4 * float(dt.sum()), 4 * float(rate @ dt)
