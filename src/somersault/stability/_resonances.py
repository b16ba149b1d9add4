"""Frequencies of a spin's modes in ratios of whole numbers, and what can come of them.

Among motions of the same angular momentum an undamped spin is an equilibrium of a Hamiltonian
system, H = Σ σ ω J + cubic terms + …, where σ is the sign of a mode's energy and J ≥ 0 its size.
Where Σ n ω ≈ 0 over some modes, for whole numbers n, terms of order Σ|n| exchange energy between
them without end, and the sizes J of the modes change together, in the ratios of n σ:

- if these have both signs, one mode grows at the cost of another and is bounded by it;
- if they have one sign, all of them grow together, and the energy stays what it is because some
  have positive and some negative energy: explosive. Of order three this makes every spin at
  exact resonance unstable that is stable in the linear equations (Cherry 1928; Markeev 1978). Of
  order four it depends on how the frequencies change with size; of higher order it is slow.

A definite energy allows no explosive one, and keeps a spin stable for ever anyway.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import combinations_with_replacement, product
from math import gcd
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array

if TYPE_CHECKING:
    from somersault.stability._modes import Mode

MOST_ORDER = 8


@dataclass(frozen=True, eq=False)
class Resonance:
    """Modes whose frequencies ω are nearly in a ratio of whole numbers: Σ counts · ω ≈ 0.

    Attributes
    ----------
    modes : tuple of Mode
        Those that take part.
    counts : tuple of int
        A whole number for each.
    order : int
        Of the lowest terms in the energy that act at this resonance: 3 are cubic terms.
    detuning : float
        Σ counts · ω, in units of the spin rate Ω.
    explosive : bool
        Whether all modes can grow together, because their energies have different signs.
    """

    modes: tuple[Mode, ...]
    counts: tuple[int, ...]
    order: int
    detuning: float
    explosive: bool

    @property
    def words(self) -> str:
        """As an equation of frequencies: "2 × 0.268 = 0.537 Ω"."""
        sides = (
            " + ".join(
                f"{abs(n)} × {mode.root.imag:.4g}" if abs(n) > 1 else f"{mode.root.imag:.4g}"
                for mode, n in zip(self.modes, self.counts, strict=True)
                if n * side > 0
            )
            for side in (1, -1)
        )
        left, right = sides
        return f"{left} {'=' if abs(self.detuning) < 1e-12 else '≈'} {right} Ω"


@dataclass(frozen=True)
class Combination:
    """Whole numbers for each of some modes, (k,), and the order of the terms they stand for."""

    counts: tuple[int, ...]
    order: int

    def explosive(self, signs: Array) -> Array:
        """Whether modes with energies of these signs (k, …) all grow together."""
        way = np.tensordot(np.diag(self.counts), np.sign(signs), 1)
        way = way[np.array(self.counts) != 0]
        return np.all(way > 0, 0) | np.all(way < 0, 0)

    def detuning(self, frequencies: Array) -> Array:
        """Σ counts · ω of frequencies (k, …)."""
        return np.tensordot(np.array(self.counts, float), frequencies, 1)


def combinations(odd: Sequence[bool], order: int) -> tuple[Combination, ...]:
    """All that modes may have up to an order, lowest first; `odd` are those that a mirror reverses.

    Only those that can be zero, with counts of both signs, and none that is a multiple of another.
    Terms with an odd number of odd motions do not exist in a body that is its own mirror image, and
    those of second order have gone into the modes themselves; then twice the combination is the
    lowest.
    """
    return _combinations(tuple(odd), order)


@cache
def _combinations(odd: tuple[bool, ...], order: int) -> tuple[Combination, ...]:
    found = []
    for size in range(2, order + 1):
        for places in combinations_with_replacement(range(len(odd)), size):
            taking = sorted(set(places))
            for signs in product((1, -1), repeat=len(taking) - 1):
                counts = [0] * len(odd)
                for place, sign in zip(taking, (1, *signs), strict=True):
                    counts[place] = sign * places.count(place)
                reversed_ = sum(n for n, is_odd in zip(counts, odd, strict=True) if is_odd) % 2
                lowest = 2 * size if size == 2 or reversed_ else size
                if lowest <= order and min(counts) < 0 and gcd(*counts) == 1:
                    found.append(Combination(tuple(counts), lowest))
    return tuple(sorted(found, key=lambda each: each.order))


def near(
    modes: Sequence[Mode], odd: Sequence[bool], order: int, within: float
) -> tuple[Resonance, ...]:
    """The resonances of oscillating modes up to an order, those with the least order and detuning
    first."""
    frequencies = np.array([mode.root.imag for mode in modes])
    signs = np.array([mode.energy for mode in modes])
    found = []
    for each in combinations(odd, order):
        off = float(each.detuning(frequencies))
        if abs(off) <= within:
            taking = [k for k, n in enumerate(each.counts) if n]
            found.append(
                Resonance(
                    tuple(modes[k] for k in taking), tuple(each.counts[k] for k in taking),
                    each.order, off, bool(each.explosive(signs)),
                )
            )  # fmt: skip
    return tuple(sorted(found, key=lambda each: (each.order, abs(each.detuning))))
