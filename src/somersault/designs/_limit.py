"""What a design must keep to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import instance, text, truth
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.designs._bounds import check_bounds, outside, scale

_MOST_BEYOND = 1e3


@dataclass(frozen=True)
class Limit:
    """Bounds on a quantity that is reported, as a joint's greatest torque.

    Parameters
    ----------
    quantity : str
        What is reported of each run, as "greatest_left_elbow_torque"; a * stands for anything, so
        that "*elbow_torque" means both extremes of both.
    most, least : float, optional
        The bounds. With `most` alone |quantity| is at most that, with `least` alone the quantity at
        least that, and with both it is from `least` to `most`: "*_left_hip" from -0.3 to 2.5 is
        the range of a joint whose extremes are reported.
    share : float
        Of the runs, in how many at least; one that failed counts as within, and the objective has
        it against it.
    unperturbed : bool
        Whether it is for the one run in which nothing is scattered, and not for the scattered ones;
        it must not fail.

    Examples
    --------
    >>> import numpy as np
    >>> import somersault as so
    >>> strength = so.designs.Limit("torque", most=100.0)
    >>> strength.beyond(np.array([[50.0, 120.0]]), np.zeros((1, 2), bool))
    array([0.2])
    """

    quantity: str
    most: float | None = None
    least: float | None = None
    share: float = 1.0
    unperturbed: bool = False

    def checked(self) -> Limit:
        """The same, if it makes sense.

        Returns
        -------
        Limit

        Raises
        ------
        SomersaultError
            Without bounds, for bounds that nothing is within, and for a share that is none.
        """
        instance("a limit", self, Limit)
        text("limit.quantity", self.quantity)
        check_bounds("limit", self.most, self.least)
        truth("limit.unperturbed", self.unperturbed)
        if not 0 < number("limit.share", self.share) <= 1:
            raise SomersaultError(f"limit.share must be above 0 and at most 1, not {self.share:g}")
        return self

    def beyond(self, values: Array, failed: Array) -> Array:
        """By how much of the larger bound candidates are beyond, 0 where they keep to it.

        Parameters
        ----------
        values, failed : ndarray, (P, N)

        Returns
        -------
        ndarray, (P,)
        """
        off = outside(values, self.most, self.least) / scale(self.most, self.least)
        off = np.clip(np.nan_to_num(off, nan=_MOST_BEYOND), 0.0, _MOST_BEYOND)
        off = np.where(failed, _MOST_BEYOND if self.unperturbed else 0.0, off)
        return np.quantile(off, self.share, axis=-1, method="inverted_cdf")
