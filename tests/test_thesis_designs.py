"""Design studies of the report against closed forms, and what they say of each other."""

from __future__ import annotations

import numpy as np
import pytest

import somersault as so
from somersault.thesis.ch7 import _layout_design, _legs


@pytest.mark.slow
def test_legs_of_one_length_miss_by_what_the_momentum_is_off() -> None:
    """The somersault goes with the momentum, so that its mean error is √(2/π) σ Φ; the landing
    error is half of that."""
    found = _legs.chosen(False)
    expected = 0.5 * np.sqrt(2 / np.pi) * 0.05 * 4.6
    low, high = found.interval
    assert low < expected < high
    assert found.figure == pytest.approx(expected, rel=0.05)


@pytest.mark.parametrize("joint", list(_layout_design.PARTS))
def test_a_part_that_is_hinged_leaves_the_body_as_heavy_and_as_slow_to_turn(joint: str) -> None:
    whole, parted = so.load("furrer"), _layout_design.hinged(joint)
    assert parted.mass == pytest.approx(whole.mass)
    for angle in (0.0, 1.3):
        one, other = (
            so.spin(model, pose={"shoulder": angle}).principal_inertias for model in (whole, parted)
        )
        np.testing.assert_allclose(other, one, rtol=1e-12)
    for body in parted.bodies:  # none is lighter than nothing, or turns as no body can
        a, b, c = np.linalg.eigvalsh(np.array(body.inertia))
        assert 0 < a <= b <= c <= a + b
