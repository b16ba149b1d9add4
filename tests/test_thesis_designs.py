"""Design studies of the report against closed forms, and what they say of each other."""

from __future__ import annotations

import numpy as np
import pytest

from somersault.thesis.ch7 import _legs


@pytest.mark.slow
def test_legs_of_one_length_miss_by_what_the_momentum_is_off() -> None:
    """The somersault goes with the momentum, so that its mean error is √(2/π) σ Φ; the landing
    error is half of that."""
    found = _legs.chosen(False)
    expected = 0.5 * np.sqrt(2 / np.pi) * 0.05 * 4.6
    low, high = found.interval
    assert low < expected < high
    assert found.figure == pytest.approx(expected, rel=0.05)
