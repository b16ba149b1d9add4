"""The share of runs that are good."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from somersault._core.array import Array
from somersault._core.intervals import of_share
from somersault.designs._bounds import bounds_in_words, check_bounds, outside
from somersault.designs._clusters import effective
from somersault.designs._objective import CONFIDENCE, Objective


@dataclass(frozen=True)
class Share(Objective, kind="share"):
    """The share of runs whose quantity is within `least` and `most`; one that failed is not.

    Parameters
    ----------
    quantity : str
    most, least : float, optional
        Bounds of what is good. With `most` alone |quantity| is at most that, with `least` alone the
        quantity at least that, and with both it is from `least` to `most`.

    Examples
    --------
    >>> import numpy as np
    >>> import somersault as so
    >>> landed = so.designs.Share("landing_error", most=0.1)
    >>> landed.figures(np.array([[0.05, 0.2]]), np.zeros((1, 2), bool))
    array([0.5])
    """

    most: float | None = None
    least: float | None = None

    def checked(self) -> Objective:
        check_bounds("objective", self.most, self.least)
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
        return (outside(values, self.most, self.least) <= 0) & ~failed

    def badness(self, values: Array) -> Array:
        return outside(values, self.most, self.least)

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
        return f"share with {self.quantity} {bounds_in_words(self.most, self.least)}"
