"""What a design must keep to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import instance, text, truth
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number

_MOST_BEYOND = 1e3


@dataclass(frozen=True)
class Limit:
    """A bound on a quantity that is reported, as a joint's greatest torque.

    Parameters
    ----------
    quantity : str
        What is reported of each run, as "greatest_left_elbow_torque"; a * stands for anything, so
        that "*elbow_torque" means both extremes of both.
    most : float
        What |quantity| may be at most.
    share : float
        Of the runs, in how many at least; those that failed are left out.
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
    most: float
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
            Unless its numbers are positive, and the share at most 1.
        """
        instance("a limit", self, Limit)
        text("limit.quantity", self.quantity)
        if number("limit.most", self.most) <= 0:
            raise SomersaultError(f"limit.most must be positive, and is {self.most:g}")
        truth("limit.unperturbed", self.unperturbed)
        if not 0 < number("limit.share", self.share) <= 1:
            raise SomersaultError(f"limit.share must be above 0 and at most 1, not {self.share:g}")
        return self

    def beyond(self, values: Array, failed: Array) -> Array:
        """By how much of the limit candidates are beyond it, 0 where they keep to it.

        Parameters
        ----------
        values, failed : ndarray, (P, N)

        Returns
        -------
        ndarray, (P,)
        """
        sizes = np.where(failed, np.inf if self.unperturbed else 0.0, np.abs(values))
        least = np.quantile(sizes, self.share, axis=-1, method="inverted_cdf")
        return np.clip(least / self.most - 1, 0.0, _MOST_BEYOND)
