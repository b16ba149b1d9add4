"""Flights that no step gets on with: given up soon, and said why."""

from __future__ import annotations

import json
from contextlib import nullcontext
from importlib.resources import files
from pathlib import Path

import pytest

import somersault as so
from somersault.cli import main
from somersault.flight import _flown
from somersault.flight._lock import aligned

RUDI = json.loads((files("somersault.thesis.ch6") / "rudi.json").read_text())
PATHS = {name: (path["times"], path["angles"]) for name, path in RUDI["joints"].items()}
JOINTS = {
    name: so.JointTakeoff("prescribed", times=times, angles=angles)
    for name, (times, angles) in PATHS.items()
}
LOCKED = "left_shoulder_abduction", "left_shoulder_flexion"


def spec(folder: Path, gains: str, more: str = "") -> str:
    """The rudi without its tape, with gains of some pose, as a SPEC."""
    tables = [
        f'[joints.{name}]\nmotion = "prescribed"\ntimes = {times}\nangles = {angles}'
        for name, (times, angles) in PATHS.items()
    ]
    head = f'model = "gymnast"\nduration = {RUDI["landing"]}\n{more}'
    soft = f"[compliance]\nnatural_frequency = 20\npose = {gains}\ntape = false"
    takeoff = f"[takeoff]\nspin = {RUDI['spin']}"
    file = folder / "spec.toml"
    file.write_text("\n".join([head, takeoff, soft, *tables]))
    return str(file)


def test_a_gimbal_lock_is_given_up_and_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["fly", spec(tmp_path, "0.0", "steps = 1000")]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "broke off at 0.199" in said
    assert f"{' and '.join(LOCKED)} have come into line there (gimbal lock)" in said
    assert main(["fly", spec(tmp_path, '"wrap"')]) == 0


@pytest.mark.parametrize(("omega_n", "locks"), [(10.0, True), (400.0, False)])
def test_what_is_in_line(omega_n: float, locks: bool) -> None:
    takeoff = so.Takeoff(spin=RUDI["spin"], joints=JOINTS)
    soft = so.compliant("gymnast", takeoff, omega_n, pose=0.0, tape=False)
    breaks = pytest.warns(so.SomersaultWarning, match="gimbal lock") if locks else nullcontext()
    with breaks:
        flight = so.fly("gymnast", soft, RUDI["landing"], samples=2, steps=3000, accuracy=1e-6)
    assert flight.ended == ("too many steps" if locks else "duration")
    assert aligned(flight) == (LOCKED if locks else ())


def test_a_stiff_spring_is_no_gimbal_lock(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "spec.toml").write_text(
        'model = "furrer"\nsteps = 10\nsamples = 2\n[takeoff]\nspin = 8.64\n[joints.shoulder]\n'
        'motion = "sprung"\nangle = 1.4\nstiffness = 1e8'
    )
    assert main(["fly", str(tmp_path / "spec.toml")]) == 2
    said = capsys.readouterr().err
    assert "too stiff" in said
    assert "gimbal" not in said


def test_a_negative_spring_that_drives_joints_away_is_named() -> None:
    """And no stiff spring is blamed, which would be made softer in vain."""
    arms = {"shoulder": so.JointTakeoff.sprung(0.3, stiffness=-3000.0)}
    with pytest.warns(so.SomersaultWarning) as said:
        so.fly("furrer", so.Takeoff(spin=8.0, joints=arms), 1.0, steps=2000, samples=2)
    words = [str(one.message) for one in said]
    drives = [one for one in words if one.startswith("joint ")]
    assert [one.split()[1] for one in drives] == ["left_shoulder", "right_shoulder"]  # each once
    assert len(words) == 3
    assert "negative stiffness have driven joints away" in words[-1]
    assert "left_shoulder (-3000), right_shoulder (-3000)" in words[-1]
    assert "too stiff" not in words[-1]


def test_a_joint_that_a_torque_drives_away_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its turns are still not counted finely enough after the last refinement."""
    monkeypatch.setattr(_flown, "_MOST_REFINEMENTS", 6)
    arm = so.JointTakeoff("torque", angle=0.3, times=[0.0, 1.0], torques=[1e9 - 1] * 2)
    with pytest.warns(so.SomersaultWarning, match="have run away.*: left_shoulder; drive them"):
        flight = so.fly("furrer", so.Takeoff(spin=8.0, joints={"left_shoulder": arm}), steps=2000)
    assert flight.ended == "too many steps"


def test_samples_and_turns_are_not_counted_as_steps() -> None:
    """Every sample is landed on, which takes a step, and a long flight is no mistake."""
    takeoff = so.Takeoff(tilt=0.01, spin=8.64)
    assert so.fly("furrer", takeoff, 2.0, samples=20_001, steps=1).ended == "duration"
    assert so.fly("furrer", takeoff, 500.0, samples=2, steps=1).ended == "duration"


def test_flights_alone_and_together_are_given_up_alike() -> None:
    of = "furrer", so.Takeoff(spin=8.0), 1.0
    assert so.Maneuver(*of).steps == so.flight.flights(*of).steps == 100_000
    assert so.flight.flights(so.Maneuver(*of, steps=50)).steps == 50


@pytest.mark.parametrize("steps", [0, -1, 1.5, True, "many", 10**10])
def test_steps_are_a_whole_number(steps: object) -> None:
    with pytest.raises(so.SomersaultError, match="steps must be a whole number"):
        so.fly("furrer", so.Takeoff(spin=8.0), steps=steps)  # type: ignore[arg-type]
