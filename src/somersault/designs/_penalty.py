"""What a search makes small where there are limits."""

from __future__ import annotations

import numpy as np

from somersault._core.array import Array
from somersault.designs._trial import NOT_MADE, Outcome

_WITHIN = 0.4  # of the candidates: about so many are to keep to the limits
_RATE = 0.5  # of the weight's logarithm, a generation


class Penalty:
    """The cost of candidates with what they are beyond their limits, by a weight that adapts.

    It rises while few candidates keep to the limits and falls while most do, so that the search
    comes to where a limit just binds from both sides, and with an eye on the cost all the way.
    """

    def __init__(self) -> None:
        self._weight: float | None = None

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
        if self._weight is None:
            over = beyond[(beyond > 0) & (beyond < NOT_MADE)]
            if not over.size:
                return costs + beyond
            low, high = np.quantile(costs, [0.25, 0.75])
            self._weight = float((high - low or 1.0) / np.median(over))
        self._weight *= float(np.exp(_RATE * (_WITHIN - np.mean(beyond <= 0))))
        return costs + self._weight * beyond
