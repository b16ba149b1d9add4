"""Confidence intervals."""

from __future__ import annotations

import numpy as np
from scipy import special

from somersault._core.array import Array


def of_share(hits: Array, count: Array, confidence: float) -> tuple[Array, Array]:
    """Both ends of the Clopper–Pearson interval of so many hits in so many, which need not be whole
    numbers where they stand for runs that hang together."""
    rest = (1 - confidence) / 2
    low = np.where(hits > 0, special.betaincinv(hits, count - hits + 1, rest), 0.0)
    high = np.where(hits < count, special.betaincinv(hits + 1, count - hits, 1 - rest), 1.0)
    return low, high
