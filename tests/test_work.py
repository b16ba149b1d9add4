"""Work at the joints, against energies that are reckoned otherwise."""

from __future__ import annotations

import numpy as np
import pytest

import somersault as so
from somersault.flight import joint_power, joint_work


def gain(flight):
    return flight.kinetic_energy[-1] - flight.kinetic_energy[0]


@pytest.mark.parametrize("make", [so.inertia_change, so.arm_tilt, so.hula, so.cat_turn])
def test_energy_gained_is_the_muscles_work(make):
    flight = make().fly(accuracy=1e-12, samples=4001)
    done = float(joint_work(flight)[-1].sum())
    assert done == pytest.approx(gain(flight), abs=1e-8 * flight.kinetic_energy.max())


def sprung(damping=0.0):
    joints = {
        "left_shoulder": so.JointTakeoff("sprung", angle=1.0, stiffness=60.0, damping=damping,
                                         rest=1.4),
        "right_shoulder": so.JointTakeoff("sprung", angle=-1.2, stiffness=60.0, damping=damping,
                                          rest=-1.4),
    }  # fmt: skip
    takeoff = so.Takeoff(spin=8.64, tilt=0.02, joints=joints)
    return so.fly("furrer", takeoff, 1.0, accuracy=1e-12, samples=4001)


def test_a_springs_work_is_the_energy_that_it_gives_up_at_each_moment():
    flight = sprung()
    work = joint_work(flight)
    for joint, rest in (("left_shoulder", 1.4), ("right_shoulder", -1.4)):
        held = 0.5 * 60.0 * (flight.dataset["joint_angle"].sel(joint=joint).values - rest) ** 2
        own = work.sel(joint_speed=joint).values
        np.testing.assert_allclose(own, held[0] - held, atol=1e-8 * held.max())
    assert np.ptp(work.values) > 1


def test_a_damper_takes_power_and_its_work_is_what_is_lost():
    calm, damped = sprung(), sprung(damping=2.0)
    assert float(joint_work(damped)[-1].sum()) < float(joint_work(calm)[-1].sum())
    drag = -2.0 * damped.dataset["joint_rate"].values ** 2
    spring = 60.0 * (np.array([1.4, -1.4]) - damped.dataset["joint_angle"].values)
    power = drag + spring * damped.dataset["joint_rate"].values
    np.testing.assert_allclose(joint_power(damped).values, power, atol=1e-6)
    assert float(joint_work(damped)[-1].sum()) == pytest.approx(gain(damped), rel=1e-8)


def test_results_are_labelled():
    flight = so.inertia_change().fly()
    for found, unit in ((joint_power(flight), "W"), (joint_work(flight), "J")):
        assert found.dims == ("time", "joint_speed")
        assert found.attrs["units"] == unit
        assert list(found["joint_speed"].values) == list(flight.system.model.speeds)
    assert np.all(joint_work(flight)[0] == 0)
