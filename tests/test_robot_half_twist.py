"""A somersault with half a twist: the robot, what it foresees, and where it lands."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import casadi as ca
import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from test_shipped_models import SHIPPED

import somersault as so
from somersault import cli, rigid
from somersault.robot import Control, Robot, Run, Runs, Twist, maneuver, parse_runs, run, run_of
from somersault.robot.rigid_turn import facing, turned
from somersault.thesis.ch6 import _half_twist, _torque_twist_tilt
from somersault.thesis.ch6._half_twist_attempts import backwards
from somersault.thesis.ch6._half_twist_runs import held_out
from somersault.thesis.ch6._weighted_biped import twisting_tilt, weighted


@pytest.fixture(scope="module")
def turn() -> Run:
    return run("biped_weighted", 11.0, maneuver("half_twist"), flip=3.0)


class TestRobot:
    def test_is_the_biped_with_a_weight_and_stronger_hips(self) -> None:
        """In all else that MuJoCo knows of their bodies, joints and actuators."""
        bare, heavy = (
            mujoco.MjModel.from_xml_path(str(SHIPPED / f"{name}.xml"))
            for name in ("biped", "biped_weighted")
        )
        weight = heavy.body("weight").id
        assert heavy.body_mass[weight] == 4.0
        assert heavy.body_pos[weight].tolist() == [0.0, 0.0, 0.8]
        for name in ("body_mass", "body_pos", "body_inertia", "body_ipos"):
            np.testing.assert_array_equal(
                np.delete(getattr(heavy, name), weight, axis=0), getattr(bare, name), name
            )
        for name in ("jnt_range", "jnt_axis", "dof_armature", "actuator_gainprm", "dof_damping"):
            np.testing.assert_array_equal(getattr(heavy, name), getattr(bare, name), name)
        motors = bare.actuator_ctrllimited.astype(bool)
        assert np.all(heavy.actuator_ctrlrange[motors, 1] > 2 * bare.actuator_ctrlrange[motors, 1])

    @pytest.mark.parametrize("length", [0.647, 0.862])
    def test_knows_its_inertia(self, length: float) -> None:
        """By the map's parallel axes, in which the weight is a point."""
        machine = Robot("biped_weighted").machine
        straight = machine.short if length < 0.7 else machine.long
        np.testing.assert_allclose(straight.inertias, weighted(length), rtol=0.01)
        assert straight.rise == pytest.approx(4 * 0.8 / 35.44, abs=0.006)


class TestForeseen:
    def test_turns_as_a_rigid_body_does(self) -> None:
        """Against the exact motion, past its separatrix."""
        inertias = np.array([3.1, 3.5, 0.62])
        momentum = np.array([-2.0, 23.0, 4.8])
        begin = Rotation.from_euler("zyx", [0.1, 0.3, -0.05])
        start = begin.as_quat()[[3, 0, 1, 2]]
        exact = rigid.RigidMotion.from_momentum(inertias, momentum, start)
        wanted = so.attitude.matrix_from_quaternion(exact.quaternion(0.8))
        found = turned(ca.SX(begin.as_matrix()), ca.DM(momentum), ca.DM(inertias), 0.8)
        np.testing.assert_allclose(np.array(ca.evalf(found)), wanted, atol=0.03)

    @pytest.mark.parametrize("heading", [-3.0, -0.4, 2.0])
    def test_faces_where_it_faces(self, heading: float) -> None:
        """A lean does not change that."""
        lean = Rotation.from_rotvec([0.3, -0.2, 0.0])
        body = (lean * Rotation.from_euler("z", heading)).as_matrix()
        assert float(facing(ca.DM(body))) == pytest.approx(heading, abs=1e-12)


class TestHalfTwist:
    def test_lands_facing_backwards_and_runs_back(self, turn: Run) -> None:
        assert not turn.fell
        assert turn.outcome["steps_after"] >= 4
        assert abs(np.degrees(turn.outcome["landing_twist"]) - 180) < 45
        late = turn.times > 10.0
        fronts = so.attitude.matrix_from_quaternion(turn.base_quaternion[late])[:, :, 0]
        assert np.all(fronts[:, 0] < -0.9)
        assert turn.sensed[late, 3].mean() < -0.3  # where it came from

    def test_somersaults_on_the_way(self, turn: Run) -> None:
        """Its head is down at half of it, and its somersault angle ends a turn further on."""
        air = (turn.times > turn.began("tuck")) & (turn.times < turn.began("landing compression"))
        heads = so.attitude.matrix_from_quaternion(turn.base_quaternion[air])[:, 2, 2]
        assert heads.min() < -0.85
        assert heads[-1] > 0.8
        assert np.degrees(turn.angles[-1, 0]) == pytest.approx(360, abs=15)

    def test_foresees_when_it_lands(self, turn: Run) -> None:
        at = np.searchsorted(turn.times, turn.began("servo") + 0.1)
        lands = turn.times[at] + turn.kept["time_left"][at]
        assert lands == pytest.approx(turn.began("landing compression"), abs=0.06)

    def test_without_a_twist_the_states_are_a_somersault_s(self) -> None:
        """Whose controller is another."""
        plain, twisting = Runs(), Runs(control=Control(twist=Twist(angle=3.14)))
        assert plain.controller is not twisting.controller
        assert plain.controller.names == twisting.controller.names

    @pytest.mark.slow
    def test_attempts_come_off_that_it_was_not_tuned_on(self) -> None:
        data = held_out(48)
        assert float(backwards(data).mean()) > 0.75


class TestMistakesAndSpecs:
    def test_a_spec_has_the_numbers_of_its_maneuver_but_for_its_own(self) -> None:
        spec = {
            "robot": "biped_weighted", "maneuver": "half_twist", "flip": {"at": 2.0, "hold": 0.1},
        }  # fmt: skip
        control = parse_runs(spec, Path()).control
        flip = replace(maneuver("half_twist").flip, at=2.0, hold=0.1)
        assert control == replace(maneuver("half_twist"), flip=flip)
        assert parse_runs({"robot": "biped"}, Path()).control == Control()

    def test_command(self, capsys: pytest.CaptureFixture[str]) -> None:
        arguments = [
            "run",
            "biped_weighted",
            "--half-twist",
            "at=0.8",
            "--duration",
            "3.5",
            "--json",
        ]
        assert cli.main(arguments) == 0
        record = json.loads(capsys.readouterr().out)
        assert record["somersaults"] == 1
        assert abs(np.degrees(record["outcome"]["landing_twist"]) - 180) < 60

    def test_command_refuses_to_do_away_with_a_spec(
        self, capsys: pytest.CaptureFixture[str], tmp_path: Path
    ) -> None:
        spec = tmp_path / "run.toml"
        spec.write_text('robot = "biped_weighted"')
        assert cli.main(["run", str(spec), "--half-twist", "at=2"]) == 2
        assert 'maneuver = "half_twist"' in capsys.readouterr().err

    @pytest.mark.parametrize(
        ("mistake", "says"),
        [
            (lambda: maneuver("full_twist"), "somersault or half_twist"),
            (lambda: parse_runs({"robot": "biped", "maneuver": 3}, Path()), "maneuver"),
            (lambda: Control(twist=Twist(yaw_damping=-1.0)), "yaw_damping must not be"),
            (lambda: run_of(Runs(control=Control(twist=Twist(angle=float("inf"))))), "finite"),
        ],
    )
    def test_get_a_sentence(self, mistake: object, says: str) -> None:
        with pytest.raises(so.SomersaultError, match=says) as error:
            mistake()  # type: ignore[operator]
        assert "\n" not in str(error.value)


class TestClaims:
    def test_half_a_twist_takes_a_momentum_beyond_the_separatrix(self) -> None:
        """With the weight; and it then lands upright, facing backwards."""
        inertias = weighted(0.75)
        found = _torque_twist_tilt.half_twist(inertias)
        assert found.momentum > twisting_tilt(inertias)
        heading, _ = _torque_twist_tilt.somersault_once(inertias, found.momentum)
        assert abs(heading) == pytest.approx(np.pi, abs=0.1)

    def test_a_plain_somersault_is_noticed(self, monkeypatch: pytest.MonkeyPatch) -> None:
        plain = run("biped", 12.0, flip=3.0, samples=1000)
        monkeypatch.setattr(_half_twist, "nominal", lambda: plain)
        monkeypatch.setattr(_half_twist, "weak", lambda: plain)
        failing = {claim.id for claim in _half_twist.fig_6_8().claims if not claim.holds}
        assert {
            "sec6-4.torque-twist", "sec6-4.tilted", "fig6-8.backwards", "fig6-8.runs-on",
            "fig6-8.unharmed", "sec6-4.power",
        } <= failing  # fmt: skip
