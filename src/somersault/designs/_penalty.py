"""What a search makes small where there are limits."""

from __future__ import annotations

import numpy as np

from somersault._core.array import Array
from somersault.designs._trial import NOT_MADE, Outcome

_WITHIN = 0.4  # of the candidates: about so many are to keep to the limits
_RISES, _FALLS = 1.0, 0.25  # the weight's logarithm, a generation, for what is off that
_LEAST = 0.01  # of the first weight


class Penalty:
    """The cost of candidates with what they are beyond their limits, by a weight that adapts.

    It rises while few candidates keep to the limits and falls while most do, so that the search
    comes to where a limit just binds from both sides, and with an eye on the cost all the way.
    """

    def __init__(self) -> None:
        self._weight = self._first = 0.0

    def of(self, outcome: Outcome) -> Array:
        """What is to be small, (P,), of the next generation of candidates.

        Parameters
        ----------
        outcome : Outcome

        Returns
        -------
        ndarray, (P,)
        """
        costs, beyond = outcome.costs, outcome.beyond
        over = beyond[(beyond > 0) & (beyond < NOT_MADE)]
        if not over.size:
            return costs + beyond  # nothing is told of the weight
        if not self._first:
            low, high = np.quantile(costs, [0.25, 0.75])
            self._first = self._weight = float((high - low or 1.0) / np.median(over))
        off = _WITHIN - float(np.mean(beyond <= 0))
        self._weight *= float(np.exp((_RISES if off > 0 else _FALLS) * off))
        self._weight = max(self._weight, _LEAST * self._first)
        return costs + self._weight * beyond
