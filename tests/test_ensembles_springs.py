"""Springs and dampers without dimension, varied: each flight has them of its own spin."""

from __future__ import annotations

import numpy as np
import pytest

import somersault as so

REPORT = ["somersault", "tilt", "twist", "left_shoulder"]


def takeoff(K: float, B: float, angle: float, **spun: object) -> so.Takeoff:
    arms = {"shoulder": so.JointTakeoff.sprung(angle, K=K, B=B, hold=True)}
    return so.Takeoff(tilt=0.02, joints=arms, **spun)  # type: ignore[arg-type]


@pytest.mark.parametrize("spun", [{"spin": 8.0}, {"angular_momentum": (0.0, 90.0, 0.0)}])
def test_each_flight_has_the_spring_of_its_own_spin_and_pose(spun: dict[str, object]) -> None:
    vary = {
        "K": so.Vary(sets="joints.shoulder.K", values=[0.8, 1.4]),
        "B": so.Vary(sets="joints.shoulder.B", samples=[0.0, 0.1]),
        "arms": so.Vary(sets="joints.shoulder.angle", values=[1.2, 1.5]),
    }
    start = takeoff(1.0, 0.05, 1.4, **spun)
    flown = so.ensemble("furrer", start, 1.5, vary, size=2, report=REPORT, accuracy=1e-9).dataset
    assert flown.K.attrs["units"] == "1"
    for K in flown.K.values:
        for angle in flown.arms.values:
            for sample, B in enumerate((0.0, 0.1)):
                alone = so.fly("furrer", takeoff(K, B, angle, **spun), 1.5).landing
                run = flown.sel(K=K, arms=angle).isel(sample=sample)
                for name in REPORT[:3]:
                    assert float(run[name]) == pytest.approx(getattr(alone, name), abs=1e-7)
                landed = alone.joints["left_shoulder"]
                assert float(run.left_shoulder) == pytest.approx(landed, abs=1e-7)


def test_a_spring_without_dimension_is_a_multiple_of_the_spin_squared() -> None:
    """K = k/(Ω² I): against the inertia that the spin reports, at two rates."""
    vary = {"spun": so.Vary(sets="takeoff.spin", values=[6.0, 9.0])}
    one = so.ensemble("furrer", takeoff(1.2, 0.1, 1.4, spin=8.0), 1.0, vary, report=REPORT)
    inertia = so.spin("furrer", pose={"shoulder": 1.4}).outboard_inertias["left_shoulder"]
    for rate in (6.0, 9.0):
        arm = so.JointTakeoff.sprung(
            1.4, stiffness=1.2 * rate**2 * inertia, damping=0.1 * rate * inertia, hold=True
        )
        alone = so.fly("furrer", so.Takeoff(tilt=0.02, spin=rate, joints={"shoulder": arm}), 1.0)
        run = one.dataset.sel(spun=rate)
        assert float(run.twist) == pytest.approx(alone.landing.twist, abs=1e-5)
        assert np.isfinite(run.twist)


def test_a_damper_without_dimension_that_is_negative_cannot_take_off() -> None:
    vary = {"B": so.Vary(sets="joints.shoulder.B", samples=[0.1, -0.1])}
    with pytest.warns(so.SomersaultWarning, match="1 of 2 flights could not begin"):
        flown = so.ensemble("furrer", takeoff(1.0, 0.1, 1.4, spin=8.0), 0.5, vary, size=2)
    assert flown.dataset.ended.values.tolist() == [0, 4]


def test_a_flight_with_a_damper_without_dimension_does_not_keep_its_energy() -> None:
    assert so.fly("furrer", takeoff(1.0, 0.1, 1.4, spin=8.0), 0.5).energy_drift is None
    kept = so.fly("furrer", takeoff(1.0, 0.0, 1.4, spin=8.0), 0.5)
    assert kept.energy_drift is not None
    assert kept.energy_drift < 1e-11
