"""Resonances and long lives in the report: how notches are told, and that the claims hold."""

from __future__ import annotations

import numpy as np
import pytest

from somersault.thesis.ch4 import _columns, _long_lives
from somersault.thesis.ch4._two_to_one import two_to_one
from somersault.thesis.ch5 import _doll_burst


def test_notches_leave_the_edges_aside() -> None:
    stiffness = np.arange(0.1, 0.5, 0.004)
    turns = np.full((len(stiffness), 1), 50.0)
    for low, high in ((0.0, 0.13), (0.203, 0.21), (0.215, 0.217), (0.299, 0.301), (0.45, 0.5)):
        turns[(stiffness > low) & (stiffness < high)] = 3.0
    found = _columns.Column("furrer", 1.0, (0.098, 0.5), stiffness, turns, 50).notches(0)
    assert found == [pytest.approx((0.204, 0.216), abs=1e-9), pytest.approx((0.3, 0.3), abs=1e-9)]
    assert _columns.Column("furrer", 1.0, (0.098, 0.5), stiffness, turns + 50, 50).notches(0) == []


def test_two_to_one_is_exact_and_on_the_chart() -> None:
    exact = two_to_one("furrer", 1.7)
    slow, symmetric, _ = sorted(m.root.imag for m in exact.spin.modes if m.energy)
    assert symmetric == pytest.approx(2 * slow, abs=1e-9)
    named = {name: at for name, _, at in _columns.unflown("furrer", 1.7).resonances()}
    assert named["2 × tilt 1 = somersault 1"] == pytest.approx(exact.stiffness, abs=1e-5)
    low, high = exact.band(0.01)
    assert (low + high) / 2 == pytest.approx(exact.stiffness)


@pytest.mark.slow
def test_drifts_shrink_with_the_tolerance() -> None:
    """So what drifts is the integration: the energy that is computed is the motion's own."""
    coarse, fine = (
        _long_lives.drifts(kind, _long_lives.lives(kind, 0.003, (0.15,), accuracy))
        for kind, accuracy in ((_long_lives.WHEEL, 1e-5), (_long_lives.WHEEL, 1e-9))
    )
    assert 1e-8 < coarse[0] < 1e-4
    assert max(fine) < 1e-9


@pytest.mark.slow
def test_the_dolls_resonance_is_as_its_modes_say() -> None:
    found = _doll_burst.doll_burst()
    assert all(claim.holds for claim in found.claims)
    assert len(found.claims) == 4
