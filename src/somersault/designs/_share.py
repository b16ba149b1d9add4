"""The share of runs that are good."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from somersault._core.array import Array
from somersault._core.intervals import of_share
from somersault._core.numbers import number
from somersault.designs._clusters import effective
from somersault.designs._objective import CONFIDENCE, Objective


@dataclass(frozen=True)
class Share(Objective, kind="share"):
    """The share of runs whose quantity is within `least` and `most`; one that failed is not.

    Parameters
    ----------
    quantity : str
    most, least : float
        Bounds of what is good: |quantity| is at most `most`, and the quantity at least `least`.

    Examples
    --------
    >>> import numpy as np
    >>> import somersault as so
    >>> landed = so.designs.Share("landing_error", most=0.1)
    >>> landed.figures(np.array([[0.05, 0.2]]), np.zeros((1, 2), bool))
    array([0.5])
    """

    most: float = np.inf
    least: float = -np.inf

    def checked(self) -> Objective:
        for name in ("most", "least"):
            bound = getattr(self, name)
            if not (isinstance(bound, float) and np.isinf(bound)):
                number(f"objective.{name}", bound)
        return super().checked()

    def good(self, values: Array, failed: Array) -> Array:
        """Which runs are good.

        Parameters
        ----------
        values, failed : ndarray

        Returns
        -------
        ndarray of bool
        """
        return (np.abs(values) <= self.most) & (values >= self.least) & ~failed

    def figures(self, values: Array, failed: Array) -> Array:
        return self.good(values, failed).mean(-1)

    @property
    def rises(self) -> bool:
        return True

    def interval(self, values: Array, failed: Array) -> tuple[float, float]:
        good = np.atleast_2d(self.good(values, failed))
        count = np.asarray(effective(good))
        low, high = of_share(good.mean() * count, count, CONFIDENCE)
        return float(low), float(high)

    @property
    def words(self) -> str:
        bounds = [] if np.isinf(self.most) else [f"within {self.most:g}"]
        bounds += [] if np.isinf(self.least) else [f"at least {self.least:g}"]
        return f"share with {self.quantity} {' and '.join(bounds)}"
