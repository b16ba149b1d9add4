"""The mean of a quantity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from somersault._core.array import Array
from somersault.designs._objective import Averaged

_OF_NORMAL = 1.959964  # standard deviations that hold 95 %


@dataclass(frozen=True)
class Mean(Averaged, kind="mean"):
    """The mean of |quantity|, which is to be small, or with `largest` of the quantity.

    Examples
    --------
    >>> import numpy as np
    >>> import somersault as so
    >>> error = so.designs.Mean("landing_error", counts_as=1.0)
    >>> error.figures(np.array([[0.1, np.nan]]), np.array([[False, True]]))
    array([0.55])
    """

    def figures(self, values: Array, failed: Array) -> Array:
        return self.counted(values, failed).mean(-1)

    def interval(self, values: Array, failed: Array) -> tuple[float, float]:
        starts = np.atleast_2d(self.counted(values, failed)).mean(0)
        mean = float(starts.mean())
        half = _OF_NORMAL * float(starts.std(ddof=1)) / np.sqrt(len(starts))
        low = mean - half
        return low if self.largest else max(low, 0.0), mean + half

    @property
    def words(self) -> str:
        return f"mean {self.quantity}"
