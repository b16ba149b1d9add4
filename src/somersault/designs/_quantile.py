"""A quantile of a quantity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import special

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.designs._objective import Averaged, Objective


@dataclass(frozen=True)
class Quantile(Averaged, kind="quantile"):
    """What |quantity| stays below in a share `q` of the runs, which is to be small; or with
    `largest` what the quantity is above in a share 1 − q.

    Parameters
    ----------
    q : float
        Between 0 and 1.

    Examples
    --------
    >>> import numpy as np
    >>> import somersault as so
    >>> worst = so.designs.Quantile("landing_error", q=0.5)
    >>> worst.figures(np.array([[0.1, 0.2, 0.6]]), np.zeros((1, 3), bool))
    array([0.2])
    """

    q: float = 0.9

    def checked(self) -> Objective:
        if not 0 < number("objective.q", self.q) < 1:
            raise SomersaultError(f"objective.q must be between 0 and 1, and is {self.q:g}")
        return super().checked()

    def figures(self, values: Array, failed: Array) -> Array:
        return np.quantile(self.counted(values, failed), self.q, axis=-1)

    def interval(self, values: Array, failed: Array) -> tuple[float, float]:
        """Between two of the ordered values, whichever distribution they have: the number of those
        below the quantile is binomial."""
        ordered = np.sort(self.counted(values, failed))
        n = len(ordered)
        below = special.bdtr(np.arange(n + 1), n, self.q)
        low = int(np.searchsorted(below, 0.025))
        high = int(np.searchsorted(below, 0.975)) + 1
        return float(ordered[max(low - 1, 0)]), float(ordered[min(high - 1, n - 1)])

    @property
    def words(self) -> str:
        return f"{100 * self.q:g} % quantile of {self.quantity}"
