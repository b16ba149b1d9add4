"""A quantile of a quantity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import special

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.designs._clusters import effective
from somersault.designs._objective import CONFIDENCE, Averaged, Objective


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
        below the quantile is binomial, of so many as are independent (Woodruff 1952,
        doi:10.1080/01621459.1952.10483443)."""
        counted = np.atleast_2d(self.counted(values, failed))
        ordered = np.sort(counted, axis=None)
        n = round(effective(counted <= np.quantile(counted, self.q)))
        below = special.bdtr(np.arange(n + 1), n, self.q)
        rest = (1 - CONFIDENCE) / 2
        low = max(int(np.searchsorted(below, rest)) - 1, 0)
        high = min(int(np.searchsorted(below, 1 - rest)), n - 1)
        runs = len(ordered)  # some of them stand for each that is independent
        return float(ordered[low * runs // n]), float(ordered[-(-(high + 1) * runs // n) - 1])

    @property
    def words(self) -> str:
        return f"{100 * self.q:g} % quantile of {self.quantity}"
