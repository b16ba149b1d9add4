"""Maneuvers as files: they fly the same, bit for bit, when they are read again."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import somersault as so
from somersault import JointTakeoff, Maneuver, Takeoff
from somersault.cli import main

TIMES = np.linspace(0.0, 1.0, 101)


def recorded() -> Maneuver:
    """A gymnast who follows a recording, as paths and not as keyframes."""
    motion = so.sampled_motion("gymnast", TIMES, {"elbow": 1 + 0.3 * np.sin(6 * TIMES)})
    takeoff = Takeoff(spin=5.0, joints=so.prescribed("gymnast", motion))
    return Maneuver("gymnast", takeoff, 0.8, gravity=(0.0, 0.0, -9.81))


def every_behaviour() -> Maneuver:
    joints = {
        "elbow": JointTakeoff.sprung(0.3, -0.2, stiffness=3.0, damping=0.1, rest=0.2),
        "left_shoulder_abduction": JointTakeoff.torque(
            times=[0.0, 0.2], torques=[1.0, -2.0], between="held", stop_stiffness=50.0
        ),
        "right_shoulder_abduction": JointTakeoff.free(0.4, damping=0.2),
        "left_hip_flexion": JointTakeoff.prescribed(times=[0.0, 0.3], angles=[0.1, 0.9]),
        "right_hip_flexion": JointTakeoff.coupled(leader="left_hip_flexion", factor=0.5),
        "torso_twist": JointTakeoff.locked(0.1),
    }
    takeoff = Takeoff(tilt=0.1, angular_velocity=[0.2, 4.0, 0.1], velocity=[1, 0, 4], joints=joints)
    return Maneuver("gymnast", takeoff, 0.5, accuracy=1e-8, samples=11, steps=5000)


MANEUVERS: dict[str, Callable[[], Maneuver]] = {
    "arm tilt": so.arm_tilt,
    "compliant": lambda: so.arm_tilt().compliant(30.0, pose="wrap").off_nominal(tilt=-0.05),
    "recorded": recorded,
    "every behaviour": every_behaviour,
    "by quaternion": lambda: Maneuver(
        "book", Takeoff(quaternion=[0.5, 0.5, 0.5, 0.5], angular_momentum=[0, 1, 0.1]), 0.4
    ),
    "turned axes": lambda: Maneuver(so.load("book", (1, 2, 3)), Takeoff(spin=3.0), 0.4),
    "an athlete": lambda: Maneuver(
        so.athlete(1.7, 62.0), Takeoff(spin=5.0, joints={"elbow": JointTakeoff(angle=1.0)}), 0.3
    ),
}


@pytest.mark.parametrize("name", MANEUVERS)
def test_a_saved_maneuver_flies_the_same(name: str, tmp_path: Path) -> None:
    maneuver = MANEUVERS[name]()
    file = tmp_path / "maneuver.toml"
    maneuver.save(file)
    again = Maneuver.read(file)
    one, two = (m.fly(accuracy=1e-7) for m in (maneuver, again))
    np.testing.assert_array_equal(one.times, two.times)
    for quantity in ("quaternion", "joint_angle", "centre_of_mass"):
        np.testing.assert_array_equal(one.dataset[quantity], two.dataset[quantity])
    assert main(["fly", str(file)]) == 0


def test_another_file_is_never_written_over(tmp_path: Path) -> None:
    athlete = MANEUVERS["an athlete"]()
    precious = tmp_path / "mine.xml"
    precious.write_text("<mujoco/>")
    with pytest.raises(so.SomersaultError, match=r"mine\.xml is there already"):
        athlete.save(tmp_path / "mine.toml")
    assert precious.read_text() == "<mujoco/>"
    assert not (tmp_path / "mine.toml").exists()
    athlete.save(tmp_path / "again.toml")
    athlete.save(tmp_path / "again.toml")  # the same model is no other
    for name in ("q.xml", ".", "x.json"):
        with pytest.raises(so.SomersaultError, match=r"another ending than \.toml"):
            athlete.save(tmp_path / name)
    (tmp_path / "folder.toml").mkdir()
    with pytest.raises(so.SomersaultError, match="is a folder"):
        athlete.save(tmp_path / "folder.toml")
    assert not (tmp_path / "folder.xml").exists()


def test_what_is_by_default_is_not_written(tmp_path: Path) -> None:
    file = tmp_path / "m.toml"
    Maneuver("furrer", Takeoff(spin=8.0, joints={"shoulder": JointTakeoff(angle=1.4)})).save(file)
    assert file.read_text().split() == [
        "model", "=", '"furrer"', "[takeoff]", "spin", "=", "8.0", "[joints.shoulder]", "angle",
        "=", "1.4",
    ]  # fmt: skip


def test_fields_of_a_maneuver_can_be_others() -> None:
    maneuver = so.arm_tilt()
    assert so.fly(maneuver, samples=3).times.size == 3
    assert maneuver.changed(duration=0.2).fly().times[-1] == 0.2
    with pytest.raises(so.SomersaultError, match="speed is no part of a maneuver"):
        maneuver.changed(speed=2.0)
    with pytest.raises(so.SomersaultError, match="takeoff of its own"):
        so.fly(maneuver, Takeoff())


def test_a_flight_says_what_it_is_in_a_line() -> None:
    maneuver = so.arm_tilt()
    for text in (repr(maneuver), repr(maneuver.fly()), repr(maneuver.model)):
        assert len(text) < 200
        assert "\n" not in text


def test_a_flight_that_breaks_off_warns_with_the_reason() -> None:
    stiff = {"left_shoulder": JointTakeoff.sprung(1.4, stiffness=1e9)}
    maneuver = Maneuver("furrer", Takeoff(spin=8.0, joints=stiff), steps=10, samples=2)
    with pytest.warns(so.SomersaultWarning, match=r"broke off at .* too stiff"):
        assert maneuver.fly().ended == "too many steps"


def test_moves_backwards_and_in_other_time() -> None:
    turn = so.cat_turn(cycles=1)
    slow = turn.scaled(2.0)
    ends = [m.fly(accuracy=1e-10).landing.twist for m in (turn, slow)]
    assert ends[0] == pytest.approx(ends[1], abs=1e-8)
    assert slow.duration == 2 * turn.duration
    path = recorded()
    end = path.reversed().reversed()
    for name, does in path.takeoff.joints.items():
        np.testing.assert_allclose(
            end.takeoff.joints[name].path.coefficients, does.path.coefficients, atol=1e-6
        )
    assert replace(turn, duration=1.0).duration == 1.0
