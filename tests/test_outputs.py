"""What commands write never replaces what they read."""

from __future__ import annotations

from pathlib import Path

import pytest

import somersault as so
from somersault.cli import main

SPEC = """
model = "gymnast"
duration = 0.1
[takeoff]
spin = 6.0
[motion]
file = "dive.csv"
"""


def test_a_recording_that_is_flown_stays(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    so.fly("gymnast", so.Takeoff(spin=6.0), 0.2).save(tmp_path / "dive.csv")
    before = (tmp_path / "dive.csv").read_bytes()
    spec = tmp_path / "dive.toml"
    spec.write_text(SPEC)
    assert main(["fly", str(spec), "--out", str(tmp_path / "dive.csv")]) == 2
    assert "dive.csv is read here; give what is written" in capsys.readouterr().err
    assert (tmp_path / "dive.csv").read_bytes() == before
    assert main(["fly", str(spec), "--out", str(tmp_path / "flown.csv")]) == 0


def test_a_model_that_is_read_stays(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "mine.xml"
    so.write_mjcf(so.load("furrer"), file)
    before = file.read_bytes()
    assert main(["models", str(file), "--out", str(file)]) == 2
    assert "mine.xml is read here" in capsys.readouterr().err
    assert file.read_bytes() == before
