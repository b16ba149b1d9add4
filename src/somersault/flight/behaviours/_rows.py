"""Rows of times and values, of one flight or of many."""

from __future__ import annotations

import numpy as np

from somersault._core.array import Array
from somersault.flight.behaviours._declared import side_by_side
from somersault.model import Joint
from somersault.motion import increasing
from somersault.simulation import Name, Numbers


def sampled(joint: Joint, what: str, size: int, values: Numbers, count: int) -> tuple[Array, Array]:
    """A joint's times and values (N, size): a row a flight, or one for all that are alike."""
    names: list[Name] = [(name, joint.name, k + 1) for name in ("times", what) for k in range(size)]
    alike = not any(isinstance(values[name], np.ndarray) for name in names)
    both = side_by_side(values, names, 1 if alike else count)
    return both[:, :size], both[:, size:]


def in_order(joint: Joint, size: int, values: Numbers, count: int) -> Array:
    """Whether a joint's times increase, (count,)."""
    names: list[Name] = [("times", joint.name, k + 1) for k in range(size)]
    return increasing(side_by_side(values, names, count))
