"""An acrobat of biorbd's, x to his right, in a layout somersault that his arms make twist."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from test_biomod_flight import ACROBAT
from test_flight_mujoco import by_momentum, quintic

import somersault as so
from somersault.cli import main
from somersault.ensembles import parse_ensemble

OUT, UP, DOWN = np.pi / 2, np.pi - 0.1, 0.1  # of an arm, away from hanging down
TIMES = (0.1, 0.35)
SECONDS = 1.5


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "acrobat.bioMod"
    path.write_text(ACROBAT)
    return path


def arms(left: float, right: float) -> dict[str, tuple[float, float]]:
    """From both out, one way each; about the axis that points to the front."""
    return {"LeftArm_RotY": (OUT, left), "RightArm_RotY": (-OUT, -right)}


def takeoff(moves: dict[str, tuple[float, float]], **begun: float) -> so.Takeoff:
    joints = {
        n: so.JointTakeoff("prescribed", times=TIMES, angles=angles) for n, angles in moves.items()
    }
    return so.Takeoff(spin=8.0, **begun, joints=joints)


def independent(
    model: so.Model, flight: so.Flight, moves: dict[str, tuple[float, float]], times: np.ndarray
) -> np.ndarray:
    """Euler angles about x, y, z at times: momentum kept, mass matrix and angles of others."""
    paths = {
        joint.name: quintic(np.array(TIMES), np.array(moves.get(joint.name, (0.0, 0.0))))
        for joint in model.joints
    }
    attitudes, before = [flight.start.quaternion], 0.0
    for time in times:
        attitude, _ = by_momentum(model, flight, paths, float(time), (before, attitudes[-1]))
        attitudes, before = [*attitudes, attitude], float(time)
    turned = Rotation.from_quat(attitudes, scalar_first=True)
    return np.unwrap(turned.as_euler("XYZ"), axis=0)


def test_the_arms_start_a_twist(file: Path) -> None:
    model, moves = so.load(file, axes=(1, 2, 3)), arms(left=DOWN, right=UP)
    times = np.linspace(0, SECONDS, 16)
    flight = so.fly(model, takeoff(moves), SECONDS, samples=times, accuracy=1e-11)
    found = np.stack([flight.dataset[n].values for n in ("somersault", "tilt", "twist")], 1)
    np.testing.assert_allclose(found[1], [0.8, 0, 0], atol=1e-12)  # until the arms move
    assert found[-1, 2] > 6 * np.pi
    assert 0.1 < np.abs(found[4:, 1]).max() < 0.3
    assert found[-1, 0] == pytest.approx(8 * SECONDS, rel=0.1)
    wanted = independent(model, flight, moves, times[1:])
    np.testing.assert_allclose(found, wanted, rtol=0, atol=2e-7)


def test_the_other_arms_twist_the_other_way(file: Path) -> None:
    model = so.load(file, axes=(1, 2, 3))
    one, other = (
        so.fly(model, takeoff(moves), SECONDS, accuracy=1e-11).landing
        for moves in (arms(DOWN, UP), arms(UP, DOWN))
    )
    assert other.somersault == pytest.approx(one.somersault, abs=1e-8)
    assert (other.tilt, other.twist) == pytest.approx((-one.tilt, -one.twist), abs=1e-8)


def test_a_quarter_twist_is_found(file: Path) -> None:
    model, moves = so.load(file, axes=(1, 2, 3)), arms(DOWN, UP)
    flight = so.fly(model, takeoff(moves), SECONDS, until="quarter twist", accuracy=1e-11)
    assert flight.ended == "event"
    assert flight.landing.twist == pytest.approx(np.pi / 2, abs=1e-9)
    angles = independent(model, flight, moves, np.array([flight.landing.time]))[-1]
    assert angles[2] == pytest.approx(np.pi / 2, abs=2e-7)


def test_nothing_but_the_angles_depends_on_the_axes(file: Path) -> None:
    start = replace(takeoff(arms(DOWN, UP)), spin=None, angular_velocity=(8.0, 0.1, 0.2))
    ours, other = (
        so.fly(so.load(file, axes=axes), start, 0.8, accuracy=1e-12).dataset
        for axes in ((2, 1, 3), (1, 2, 3))
    )
    for name in ours.data_vars:
        apart = float(np.abs(ours[name] - other[name]).max())
        if name in ("somersault", "tilt", "twist"):
            assert apart > 0.1
        else:
            assert apart < 1e-8, name
    assert [list(data.attrs["axes"]) for data in (ours, other)] == [[2, 1, 3], [1, 2, 3]]


def test_a_body_let_go_keeps_its_axes(file: Path) -> None:
    model = so.load(file, axes=(1, 2, 3))
    bar = so.Body("bar", -1, 0.0, (0, 0, 0), ((0.0,) * 3,) * 3, joints=(so.Joint("grip", "hinge"),))
    held = so.mounted(model, bar, position=(0.0, 0.0, -1.0))
    swung = so.swing(held.held, {"grip": 2.0}, 0.6)
    locked = {joint.name: so.JointTakeoff("locked") for joint in model.joints}
    landing = so.fly(held.rider, so.released(swung, held, locked).takeoff, 0.5).landing
    turned = Rotation.from_quat(landing.quaternion, scalar_first=True).as_euler("XYZ")
    found = [landing.somersault, landing.tilt, landing.twist]
    np.testing.assert_allclose(np.exp(1j * np.array(found)), np.exp(1j * turned), atol=1e-12)


# ---------------------------------------------------------------------------------- SPECs

SPEC = """
model = "acrobat.bioMod"
axes = [1, 2, 3]
duration = 1.5
[takeoff]
tilt = 0.02
spin = 8.0
[joints.LeftArm_RotY]
motion = "prescribed"
times = [0.1, 0.35]
angles = [1.5707963267948966, 0.1]
"""
VARIED = """
[vary.leant]
sets = "takeoff.tilt"
values = [0.0, 0.02]
[report]
quantities = ["somersault", "tilt", "twist"]
"""


def test_axes_in_a_spec(file: Path, capsys: pytest.CaptureFixture) -> None:
    spec = file.parent / "s.toml"
    spec.write_text(SPEC)
    assert main(["fly", str(spec), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["final"]
    moves = {"LeftArm_RotY": (OUT, DOWN)}
    wanted = so.fly(so.load(file, axes=(1, 2, 3)), takeoff(moves, tilt=0.02), SECONDS).landing
    for name in ("somersault", "tilt", "twist"):
        assert found[name] == getattr(wanted, name)
    out = file.parent / "map.nc"
    spec.write_text(SPEC + VARIED)
    assert main(["ensemble", str(spec), "--out", str(out), "--json"]) == 0
    made = so.Ensemble.open(out).dataset
    for name in ("somersault", "tilt", "twist"):
        assert float(made[name][1]) == pytest.approx(found[name], abs=1e-5)


def test_the_example_twists_twice(capsys: pytest.CaptureFixture) -> None:
    spec = Path(__file__).parents[1] / "examples" / "acrobat.toml"
    assert main(["fly", str(spec), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["final"]
    assert found["somersault"] > 2 * np.pi
    assert found["twist"] == pytest.approx(4 * np.pi, abs=0.3)


def test_axes_tell_specifications_apart() -> None:
    given = {"model": "furrer", "takeoff": {"spin": 8.0}}
    plans = [
        parse_ensemble({**given, **axes}, Path()).plan
        for axes in ({}, {"axes": [2, 1, 3]}, {"axes": [1, 2, 3]})
    ]
    assert plans[0].specification == plans[1].specification != plans[2].specification


@pytest.mark.parametrize(
    "axes", ["[1, 2]", "[1, 2, 2]", "[0, 1, 2]", "[1.0, 2.0, 3.0]", '"xyz"', "2", "[true, 2, 3]"]
)
def test_wrong_axes_are_told(axes: str, tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    spec = tmp_path / "s.toml"
    spec.write_text(f'model = "furrer"\naxes = {axes}\n')
    for command in ("fly", "ensemble"):
        assert main([command, str(spec), "--json"]) == 2
        out, err = capsys.readouterr()
        assert (out, err.count("\n")) == ("", 1)
        assert "axes must be 1, 2 and 3 in some order" in err
