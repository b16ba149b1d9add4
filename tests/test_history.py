"""What draws needs a model, times, a base and joints: flights, swings and recordings have them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from trees import mujoco_addresses, random_tree, to_mujoco

import somersault as so
from somersault.attitude import matrix_from_quaternion, quaternion_from_angles
from somersault.history import History, Recording, read_recording
from somersault.model import centre_of_mass


def whirling(seed: int) -> so.Flight:
    """A random tree, every joint free, that tumbles and falls."""
    rng = np.random.default_rng([11, seed])
    model = random_tree(rng, free=True, armature=False)
    joints = {
        joint.name: so.JointTakeoff("free", rate=1.0 if joint.kind != "ball" else (0.3, 0.4, 0.5))
        for joint in model.joints
    }
    takeoff = so.Takeoff(
        somersault=0.4, tilt=0.2, twist=-0.3, angular_velocity=(1.0, 2.0, 0.5),
        velocity=(0.3, -0.2, 4.0), joints=joints,
    )  # fmt: skip
    return so.fly(model, takeoff, 0.5, gravity=(0.0, 0.0, -9.81), samples=21)


@pytest.fixture(scope="module")
def twist() -> so.Flight:
    return so.arm_tilt().fly(samples=101)


def check_shapes(history: History) -> None:
    count, joints = len(history.times), len(history.model.coordinates)
    assert history.base_position.shape == (count, 3)
    assert history.base_quaternion.shape == (count, 4)
    assert history.joint_coordinates.shape == (count, joints)
    assert history.angles.shape == (count, 3)


@pytest.mark.parametrize("seed", range(4))
def test_a_flights_base_is_where_mujoco_has_its_centre_of_mass_fall(seed: int) -> None:
    flight = whirling(seed)
    check_shapes(flight)
    m = to_mujoco(flight.model)
    d, q_at = mujoco.MjData(m), mujoco_addresses(flight.model, m)[0]
    data = flight.dataset
    for k in range(len(flight.times)):
        d.qpos[:7] = [*flight.base_position[k], *flight.base_quaternion[k]]
        d.qpos[q_at] = flight.joint_coordinates[k]
        mujoco.mj_kinematics(m, d)
        mujoco.mj_comPos(m, d)
        wanted = data["centre_of_mass"].values[k]
        np.testing.assert_allclose(d.subtree_com[1], wanted, rtol=0, atol=1e-13)
    assert data["base_position"].dims == ("time", "inertial_axis")
    assert data["base_position"].attrs["units"] == "m"


@pytest.mark.parametrize("seed", range(4))
def test_momenta_of_segments_sum_to_the_flights(seed: int) -> None:
    flight = whirling(seed)
    parts = flight.segment_momentum
    assert parts.dims == ("time", "body", "inertial_axis")
    assert list(parts["body"].values) == [body.name for body in flight.model.bodies]
    assert parts.attrs["units"] == "kg m2/s"
    size = np.abs(parts).max()
    np.testing.assert_allclose(parts.sum("body"), flight.angular_momentum, atol=1e-13 * size)
    assert float(np.abs(parts.std("time")).max()) > 1e-3  # it moves from one to another


def test_momenta_of_a_gymnasts_segments_sum_to_the_flights(twist: so.Flight) -> None:
    parts = twist.segment_momentum
    size = float(np.abs(twist.angular_momentum).max())
    np.testing.assert_allclose(parts.sum("body"), twist.angular_momentum, atol=1e-13 * size)


def test_a_flight_is_read_back_as_it_was_saved(twist: so.Flight, tmp_path: Path) -> None:
    twist.save(tmp_path / "twist.nc")
    back = read_recording(tmp_path / "twist.nc", twist.model)
    assert back.model is twist.model
    for name in ("times", "base_position", "base_quaternion", "joint_coordinates", "angles"):
        np.testing.assert_array_equal(getattr(back, name), getattr(twist, name))
    assert repr(back) == "Recording of gymnast: 101 samples, 0 to 1.26396 s"
    assert repr(twist) == "Flight of gymnast: 101 samples, 0 to 1.26396 s, ended by duration"


def test_a_swing_is_a_history_of_what_is_held() -> None:
    doll = so.load("doll_weighted")
    zero = (0.0, 0.0, 0.0)
    bar = so.Joint("bar", "hinge", (0.0, 1.0, 0.0))
    mount = so.mounted(doll, so.Body("hinge", -1, 0.0, zero, (zero, zero, zero), joints=(bar,)))
    swung = so.swing(mount.held, {"bar": 1.0}, 0.2, samples=11)
    check_shapes(swung)
    assert not swung.base_position.any()
    assert repr(swung).startswith("Swing of doll_weighted, held: 11 samples, 0 to 0.2 s, ended by")
    np.testing.assert_array_equal(swung.joint_coordinates, swung.q)
    np.testing.assert_array_equal(matrix_from_quaternion(swung.base_quaternion[3]), np.eye(3))


def test_a_recording_counts_the_turns_of_its_attitudes() -> None:
    model = so.load("book")
    times = np.linspace(0, 2, 41)
    attitudes = quaternion_from_angles(3 * np.pi * times, 0.1, 0.0)
    recording = Recording(model, times, np.zeros((41, 3)), attitudes, np.zeros((41, 0)))
    np.testing.assert_allclose(recording.angles[-1], [6 * np.pi, 0.1, 0.0], atol=1e-12)
    assert not centre_of_mass(model, recording.joint_coordinates).any()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"times": [0.0, 1.0, 1.0]}, "must rise"),
        ({"times": [0.0, 1.0]}, "base_position"),
        ({"base_quaternion": np.ones((3, 4))}, "unit length"),
        ({"joint_coordinates": np.zeros((3, 7))}, "must be 3 x 2 numbers, and is 3 x 7"),
        ({"base_position": np.full((3, 3), np.nan)}, "finite"),
        ({"base_position": "somewhere"}, "must be numbers"),
        ({"angles": np.zeros(3)}, "angles"),
        ({"model": "furrer"}, "must be a somersault.Model"),
    ],
)
def test_what_is_no_recording_is_refused(change: dict[str, Any], said: str) -> None:
    still = np.tile([1.0, 0.0, 0.0, 0.0], (3, 1))
    given: dict[str, Any] = {
        "model": so.load("furrer"), "times": [0.0, 1.0, 2.0], "base_position": np.zeros((3, 3)),
        "base_quaternion": still, "joint_coordinates": np.zeros((3, 2)),
    }  # fmt: skip
    Recording(**given)
    with pytest.raises(so.SomersaultError, match=said):
        Recording(**given | change)


def test_what_holds_no_flight_is_refused(twist: so.Flight, tmp_path: Path) -> None:
    model, path = twist.model, tmp_path / "a.nc"
    with pytest.raises(so.SomersaultError, match="there is no file"):
        read_recording(path, model)
    path.write_bytes(b"no flight at all")
    with pytest.raises(so.SomersaultError, match="cannot be read as NetCDF"):
        read_recording(path, model)
    twist.dataset.drop_vars("base_position").to_netcdf(path, engine="h5netcdf")
    with pytest.raises(so.SomersaultError, match="it has no base_position"):
        read_recording(path, model)
    twist.save(path)
    with pytest.raises(so.SomersaultError, match="give the model that flew"):
        read_recording(path, so.load("doll"))
