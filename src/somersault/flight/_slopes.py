"""Derivatives of what is known in closed form, by differences of high order, to 1e-9 or refused.

A number is changed by steps of many sizes at once. Of each size there are differences of order six
and eight; the size whose results agree best, with each other and with those of the next smaller
steps, is taken, and the disagreement bounds the error.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from somersault._core.array import Array

_EIGHTH = np.array([4 / 5, -1 / 5, 4 / 105, -1 / 280])  # weights of f(k h) − f(−k h), over h
_SIXTH = np.array([3 / 4, -3 / 20, 1 / 60, 0.0])
_SIZES = 0.25 ** np.arange(2, 10)  # of a number of order 1
_GOOD = 1e-9


def slopes(of: Callable[[Array, Array], list[Array]], count: int) -> tuple[list[Array], Array]:
    """Derivatives along some directions, and which of them are good.

    Parameters
    ----------
    of
        Arrays (M, …), or (1, …) of what does not change, where each of M has gone along its
        direction, an integer (M,), so far (M,).
    count
        How many directions there are.

    Returns
    -------
    derivatives : list of ndarray, (count, …)
    good : ndarray of bool, (count,)
        Whether errors are below 1e-9, absolutely or relatively.
    """
    by = np.concatenate([np.arange(1, 5), -np.arange(1, 5)])
    steps = np.ravel(_SIZES[:, None] * by)
    changed = of(np.repeat(np.arange(count), len(steps)), np.tile(steps, count))
    good, derivatives = np.ones(count, bool), []
    for values in changed:
        if len(values) == 1 < count * len(steps):
            derivatives.append(np.zeros((count, *values.shape[1:])))
            continue
        ahead, behind = np.moveaxis(values.reshape(count, len(_SIZES), 2, 4, -1), 2, 0)
        across = (ahead - behind) / _SIZES[:, None, None]
        six, eight = (np.einsum("clka,k->cla", across, w) for w in (_SIXTH, _EIGHTH))
        errors = np.abs(eight - six)
        errors[:, :-1] = np.maximum(errors[:, :-1], np.abs(np.diff(eight, axis=1)))
        errors = np.where(np.isfinite(errors), errors, np.inf)
        best = errors.argmin(1)[:, None]
        chosen, error = (np.take_along_axis(x, best, 1)[:, 0] for x in (eight, errors))
        good &= np.all(error <= _GOOD * np.maximum(1.0, np.abs(chosen)), 1)
        derivatives.append(chosen.reshape(count, *values.shape[1:]))
    return derivatives, good
