"""Acrobats of biorbd's files fly with scripted limbs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from test_flight_mujoco import apart, by_momentum, quintic

import somersault as so

DATA = Path(__file__).parent / "data"
SIDE = """
segment {side}Arm
    parent Pelvis
    rtinmatrix 0
    rt 0 0 0 xyz {x} 0 0.4
    rotations {turns}
    mass 3.6
    com 0 0 -0.3
    inertia 0.11 0 0  0 0.11 0  0 0 0.004
endsegment
"""
ACROBAT = (
    """version 4
segment Pelvis
    translations xyz
    rotations xyz
    mass 44
    com 0 0 0.1
    inertia 4.1 0 0  0 3.9 0  0 0 0.5
endsegment
segment Legs
    parent Pelvis
    rtinmatrix 0
    rt 0 0 0 xyz 0 0 -0.1
    rotations xy
    mass 22
    com 0 0 -0.4
    inertia 1.5 0 0  0 1.5 0  0 0 0.15
endsegment
"""
    + SIDE.format(side="Left", x=-0.18, turns="yz")
    + SIDE.format(side="Right", x=0.18, turns="yz")
)


@pytest.fixture
def acrobat(tmp_path: Path) -> so.Model:
    file = tmp_path / "acrobat.bioMod"
    file.write_text(ACROBAT)
    return so.load(file)


def check(model: so.Model) -> None:
    """Attitude from the momentum alone, with MuJoCo's mass matrix."""
    times, size = np.array([0.1, 0.5, 0.9]), 0.4
    moves = {
        joint.name: (times, joint.reference + size * np.array([0.0, 1.0, -0.5]) * (-1) ** k)
        for k, joint in enumerate(model.joints)
    }
    joints = {n: so.JointTakeoff("prescribed", times=t, angles=a) for n, (t, a) in moves.items()}
    begun = so.Takeoff(tilt=0.05, angular_velocity=(6.0, 0.4, 0.3), joints=joints)
    flight = so.fly(model, begun, 1.2, accuracy=1e-11)
    assert flight.momentum_drift < 1e-12
    assert np.abs(flight.external_moment).max() < 1e-9
    attitude, omega = by_momentum(
        model, flight, {n: quintic(*move) for n, move in moves.items()}, 1.2
    )
    assert apart(attitude, flight.landing.quaternion) < 1e-7
    np.testing.assert_allclose(flight.landing.angular_velocity, omega, rtol=0, atol=1e-6)


def test_an_acrobat_with_scripted_limbs(acrobat: so.Model) -> None:
    assert len(acrobat.joints) == 6
    check(acrobat)


def test_a_root_in_two_parts() -> None:
    check(so.load(DATA / "two_part_root.bioMod"))
