"""Exact quantiles of more numbers than are held at once, by reading them some times over.

Every float has a whole number that orders as it does. A pass over all numbers counts them by the
leading bits of those; the few that share the bits of an order statistic are gathered in another
pass, or counted by their next bits if they are many.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from somersault._core.array import Array

_BITS = 16  # a pass
_WHOLE = 64
_FEW = 2**20  # numbers that are gathered and sorted


def quantiles(blocks: Callable[[], Iterable[Array]], levels: Sequence[float]) -> Array:
    """Quantiles (levels,) of all numbers in some blocks but NaN, interpolated; NaN of none.

    `blocks` gives the same blocks anew whenever it is called.
    """
    counts = _counts(blocks, 0, 0)
    total = int(counts.sum())
    if not total:
        return np.full(len(levels), np.nan)
    at = (total - 1) * np.asarray(levels, float)
    low = np.floor(at).astype(int)
    ranks = np.unique(np.concatenate([low, np.minimum(low + 1, total - 1)]))
    known = dict(zip(ranks.tolist(), _ordered(blocks, counts, ranks), strict=True))
    return np.array(
        [
            np.quantile([known[k], known[min(k + 1, total - 1)]], part)
            for k, part in zip(low.tolist(), (at - low).tolist(), strict=True)
        ]
    )


def _ordered(
    blocks: Callable[[], Iterable[Array]], counts: Array, ranks: Array, bits: int = 0, lead: int = 0
) -> list[float]:
    """The numbers at ranks among those whose keys begin with the `bits` bits of `lead`, which are
    counted by their next ones."""
    numbers: list[float] = []
    before = np.cumsum(counts) - counts
    places = np.searchsorted(before + counts, ranks, side="right")
    for place in np.unique(places).tolist():
        inside = ranks[places == place] - before[place]
        longer, own = bits + _BITS, (lead << _BITS) + place
        if counts[place] <= _FEW or longer == _WHOLE:
            numbers += _gathered(blocks, longer, own, inside)
        else:
            numbers += _ordered(blocks, _counts(blocks, longer, own), inside, longer, own)
    return numbers


def _gathered(
    blocks: Callable[[], Iterable[Array]], bits: int, lead: int, ranks: Array
) -> list[float]:
    if bits == _WHOLE:  # all of them are one number
        return [_number(lead)] * len(ranks)
    kept = [keys[keys >> np.uint64(_WHOLE - bits) == lead] for keys in map(_keys, blocks())]
    return [_number(key) for key in np.sort(np.concatenate(kept))[ranks].tolist()]


def _counts(blocks: Callable[[], Iterable[Array]], bits: int, lead: int) -> Array:
    """How many keys that begin with the `bits` bits of `lead` have each of the next ones."""
    counts = np.zeros(1 << _BITS, int)
    for keys in map(_keys, blocks()):
        if bits:
            keys = keys[keys >> np.uint64(_WHOLE - bits) == lead]
        ahead = (keys >> np.uint64(_WHOLE - bits - _BITS)) & np.uint64((1 << _BITS) - 1)
        counts += np.bincount(ahead.astype(int), minlength=1 << _BITS)
    return counts


_SIGN = np.uint64(1 << 63)


def _keys(values: Array) -> Array:
    """Whole numbers that order as these floats do, without the NaN among them."""
    kept = values[~np.isnan(values)] + 0.0  # no negative zeros
    raw = kept.view(np.uint64)
    return np.where(raw & _SIGN, ~raw, raw | _SIGN)


def _number(key: int) -> float:
    raw = np.uint64(key)
    return float((raw ^ _SIGN if raw & _SIGN else ~raw).view(np.float64))
