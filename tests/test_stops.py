"""Elastic stops at the limits of joints that move freely."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import somersault as so

LIMITS = (-0.5, 3.3)  # of furrer's left shoulder


def flown(stiffness: float, damping: float = 0.0, **joint: float) -> so.Flight:
    arm = so.JointTakeoff(
        "free", angle=1.0, rate=6.0, stop_stiffness=stiffness, stop_damping=damping, **joint
    )
    return so.fly("furrer", so.Takeoff(spin=0.1, joints={"shoulder": arm}), 1.0, samples=2001)


def test_a_stop_gives_back_what_it_takes() -> None:
    """Kinetic energy is kept outside, and inside the stop what is missing is ½ k d²."""
    flight = flown(2000.0)
    left = flight.dataset["joint_angle"].sel(joint="left_shoulder").values
    beyond = np.maximum(left - LIMITS[1], 0) + np.maximum(LIMITS[0] - left, 0)
    assert 0.01 < beyond.max() < 0.2
    whole = flight.kinetic_energy + 2 * 0.5 * 2000.0 * beyond**2  # both arms, mirrored
    np.testing.assert_allclose(whole, whole[0], rtol=1e-7)
    assert flight.momentum_drift < 1e-9
    assert flight.energy_drift is None


def test_without_a_stop_a_joint_goes_through() -> None:
    assert flown(0.0).dataset["joint_angle"].max() > 6.0


def test_a_damped_stop_takes_energy_and_never_pulls() -> None:
    flight = flown(2000.0, 30.0)
    assert flight.kinetic_energy[-1] < 0.9 * flight.kinetic_energy[0]
    left = flight.dataset["joint_angle"].sel(joint="left_shoulder").values
    torque = flight.joint_torques.sel(joint_speed="left_shoulder").values
    assert np.all(torque[left > LIMITS[1]] <= 1e-9)
    np.testing.assert_allclose(torque[(left < LIMITS[1]) & (left > LIMITS[0])], 0, atol=1e-6)


@pytest.mark.parametrize(
    ("joint", "naming"),
    [
        (lambda: so.JointTakeoff("locked", stop_stiffness=5.0), "locked"),
        (lambda: so.JointTakeoff("free", stop_stiffness=-5.0), "stop_stiffness"),
        (lambda: so.JointTakeoff("free", stop_damping=5.0), "stop_stiffness"),
        (lambda: so.JointTakeoff("free", stop_stiffness=np.nan), "stop_stiffness"),
    ],
)
@pytest.mark.filterwarnings("ignore::somersault.SomersaultWarning")
def test_what_is_no_stop(joint: Callable[[], so.JointTakeoff], naming: str) -> None:
    with pytest.raises(so.SomersaultError, match=naming) as caught:
        so.fly("furrer", so.Takeoff(spin=3.0, joints={"left_shoulder": joint()}))
    assert "\n" not in str(caught.value)
