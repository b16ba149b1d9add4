"""Runs that hang together: several cases, or points of a grid, from each of N starts."""

from __future__ import annotations

from somersault._core.array import Array


def effective(true: Array) -> float:
    """How many independent runs would say as much of the share of what is true.

    Between the number of starts, where all runs from a start are alike, and that of runs: the share
    is a mean over starts, and by its variance such a number is defined (Korn and Graubard 1998,
    Survey Methodology 24, 193).

    Parameters
    ----------
    true : ndarray of bool, (cases, N)

    Returns
    -------
    float
    """
    cases, starts = true.shape
    variance = float(true.mean(0).var())
    if cases == 1 or variance == 0:  # nothing says that more of them count
        return float(starts)
    share = float(true.mean())
    return min(share * (1 - share) / variance, float(cases)) * starts
