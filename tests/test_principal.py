"""Principal axes along a flight, against rigid bodies and flights that go on."""

from __future__ import annotations

import numpy as np
import pytest
from test_axes_flight import ORDERS, redrawn, retold

import somersault as so
from somersault import attitude, rigid
from somersault import stability as st
from somersault.flight import principal_attitude, principal_axes_along, rigid_continuation

# Furrer's principal axes are then his own.
ARMS_DOWN = {"shoulder": so.JointTakeoff("locked", angle=0.0)}


def test_axes_diagonalise_the_inertia_at_every_sample():
    flight = so.hula().fly(samples=31)
    about = principal_axes_along(flight)
    inertia = so.Equations(flight.system.model).inertia(flight.dataset["joint_angle"].values)
    back = about.axes * about.inertias[:, None, :] @ np.swapaxes(about.axes, 1, 2)
    np.testing.assert_allclose(back, inertia, atol=1e-9)
    assert np.linalg.det(about.axes) == pytest.approx(1.0)


def test_they_are_the_bodys_own_axes_in_a_symmetric_pose():
    flight = so.fly("furrer", so.Takeoff(spin=8.0), 0.1)
    about = principal_axes_along(flight)
    np.testing.assert_allclose(about.axes, np.broadcast_to(np.eye(3), about.axes.shape), atol=1e-9)
    np.testing.assert_allclose(about.inertias[0], st.principal_inertias("furrer"))


def test_attitude_of_a_rigid_body_whose_axes_are_principal_is_the_bodys():
    takeoff = so.Takeoff(tilt=0.3, twist=0.4, angular_momentum=(0.0, 90.0, 0.0), joints=ARMS_DOWN)
    flight = so.fly("furrer", takeoff, 1.0)
    tilt, twist = principal_attitude(flight)
    np.testing.assert_allclose(tilt, flight.dataset["tilt"], atol=1e-9)
    np.testing.assert_allclose(np.exp(1j * twist), np.exp(1j * flight.dataset["twist"].values))


@pytest.mark.parametrize("h", [(0.0, 60.0, 0.0), (10.0, 40.0, -30.0)])
def test_with_its_joints_held_the_body_flies_on_as_the_rigid_continuation(h):
    lean = so.arm_tilt(twists=None, duration=0.3)
    moves = so.Takeoff(angular_momentum=h, joints=lean.takeoff.joints)
    flight = so.fly("gymnast", moves, 0.3, accuracy=1e-12)
    longer = so.fly("gymnast", moves, 1.5, accuracy=1e-12, samples=np.linspace(0.3, 1.5, 13))
    motion = rigid_continuation(flight)
    turn = attitude.matrix_from_quaternion(longer.states[:, :4]) @ principal_axes_along(longer).axes
    exact = attitude.matrix_from_quaternion(motion.quaternion(longer.times - 0.3))
    np.testing.assert_allclose(exact, turn, atol=1e-9)
    # And its momentum traces the curve of its energy on the sphere.
    tilt, twist = principal_attitude(longer)
    cosines = rigid.momentum_direction(tilt, twist)
    energy = np.sum(cosines**2 / motion.inertias, 1) / 2 * np.dot(h, h)
    assert energy == pytest.approx(motion.energy, rel=1e-9)


@pytest.mark.parametrize("axes", ORDERS)
def test_a_body_drawn_otherwise_has_the_same_tilt_and_twist(axes):
    joints = {
        "left_shoulder": so.JointTakeoff("prescribed", times=(0.0, 0.3), angles=(0.2, 1.5)),
        "right_shoulder": so.JointTakeoff("locked", angle=-0.2),
    }
    takeoff = so.Takeoff(tilt=0.1, twist=0.3, spin=7.0, joints=joints)
    model = so.load("furrer")
    ours = so.fly(model, takeoff, 1.0)
    theirs = so.fly(redrawn(model, axes), retold(takeoff, axes), 1.0)
    for one, other in zip(*map(principal_attitude, (ours, theirs)), strict=True):
        np.testing.assert_allclose(other, one, atol=1e-8)


def test_a_backward_somersault_tilts_and_twists_from_zero():
    takeoff = so.Takeoff(tilt=0.1, angular_momentum=(0.0, -90.0, 0.0), joints=ARMS_DOWN)
    flight = so.fly("furrer", takeoff, 1.0)
    tilt, twist = principal_attitude(flight)
    np.testing.assert_allclose(tilt, flight.dataset["tilt"], atol=1e-9)
    np.testing.assert_allclose(np.exp(1j * twist), np.exp(1j * flight.dataset["twist"].values))


def test_without_momentum_there_is_no_such_attitude():
    flight = so.cat_turn(cycles=1).fly()
    with pytest.raises(so.SomersaultError, match="without angular momentum"):
        principal_attitude(flight)
