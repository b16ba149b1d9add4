"""Prescribed joint paths: smooth moves between held values.

Each move is the quintic 10 s³ − 15 s⁴ + 6 s⁵ of its own time, so that rate and acceleration are
zero at both ends and continuous throughout; before the first time and after the last the joint
is held.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import casadi as ca
import numpy as np

from somersault._array import Array
from somersault._errors import SomersaultError

_SHORTEST = 1e-6  # s


def path(t: Any, times: Sequence[Any], values: Sequence[Any]) -> tuple[Any, Any, Any]:
    """Value, rate and acceleration at time t of the moves through (times, values), symbolic."""
    value, rate, acceleration = values[0], 0.0, 0.0
    for k in range(len(times) - 1):
        span = times[k + 1] - times[k]
        step = values[k + 1] - values[k]
        s = ca.fmin(ca.fmax((t - times[k]) / span, 0.0), 1.0)
        rest = 1 - s
        value = value + step * s * s * s * (10 + s * (6 * s - 15))
        rate = rate + step / span * 30 * (s * rest) ** 2
        acceleration = acceleration + step / (span * span) * 60 * s * rest * (rest - s)
    return value, rate, acceleration


def extremes(times: Array, values: Array) -> tuple[float, float]:
    """Lowest and highest value along the path: a quintic move does not overshoot its ends."""
    check(times, values)
    return float(np.min(values)), float(np.max(values))


def check(times: Array, values: Array) -> None:
    """SomersaultError unless times and values are a path."""
    if times.ndim != 1 or times.shape != values.shape or not times.size:
        raise SomersaultError("needs as many times as angles, at least one of each")
    if not (np.all(np.isfinite(times)) and np.all(np.isfinite(values))):
        raise SomersaultError("has times or angles that are not finite")
    if np.any(np.diff(times) < _SHORTEST):
        raise SomersaultError("has times that do not increase, by a microsecond at least")
