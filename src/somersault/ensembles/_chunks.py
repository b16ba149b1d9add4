"""How runs are cut into chunks: blocks of the dimensions, each of runs that follow one another."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Chunks:
    """Blocks of `shape` over dimensions `dims`, numbered along them, the last running fastest."""

    dims: Mapping[str, int]
    shape: tuple[int, ...]

    @property
    def grid(self) -> tuple[int, ...]:
        """Chunks along each dimension."""
        return tuple(-(-n // c) for n, c in zip(self.dims.values(), self.shape, strict=True))

    def __len__(self) -> int:
        return math.prod(self.grid)

    def place(self, k: int) -> tuple[int, ...]:
        """Where chunk k is in the grid of chunks."""
        return tuple(int(i) for i in np.unravel_index(k, self.grid))

    def region(self, k: int) -> tuple[slice, ...]:
        """What chunk k covers."""
        return tuple(
            slice(i * c, min((i + 1) * c, n))
            for i, c, n in zip(self.place(k), self.shape, self.dims.values(), strict=True)
        )

    def runs(self, k: int) -> tuple[int, int]:
        """The first run of chunk k, and the one after its last."""
        region, shape = self.region(k), tuple(self.dims.values())
        first = np.ravel_multi_index([r.start for r in region], shape)
        last = np.ravel_multi_index([r.stop - 1 for r in region], shape)
        return int(first), int(last) + 1

    def size(self, k: int) -> int:
        """How many runs chunk k has."""
        first, last = self.runs(k)
        return last - first


def chunked(dims: Mapping[str, int], most: int) -> Chunks:
    """Chunks of at most `most` runs, nearly alike."""
    shape: list[int] = []
    inside = 1
    for length in reversed(list(dims.values())):
        parts = -(-length // max(most // inside, 1))
        shape.insert(0, -(-length // parts))
        # Ahead of a dimension that is cut, chunks are one thick.
        inside = inside * length if parts == 1 else most
    return Chunks(dims, tuple(shape))
