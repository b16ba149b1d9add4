"""What commands write never replaces what they read."""

from __future__ import annotations

import json
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


FLIGHT = 'model = "book"\nduration = 0.1\n[takeoff]\nspin = 6.0\n'


def test_what_was_written_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """As every command says it, on standard output; the JSON of a flight is as it always was."""
    monkeypatch.chdir(tmp_path)
    Path("a.toml").write_text(FLIGHT)
    outputs = ["--out", "a.csv", "--page", "a.html"]
    assert main(["fly", "a.toml", *outputs]) == 0
    assert capsys.readouterr().out.endswith("  history: a.csv\n  page: a.html\n")
    records = []
    for more in (outputs, []):
        assert main(["fly", "a.toml", *more, "--json"]) == 0
        records.append(json.loads(capsys.readouterr().out))
    assert records[0] == records[1]
    assert main(["equations", "simplest", "--out", "a.tex"]) == 0
    assert capsys.readouterr().out == "simplest\n  equations: a.tex\n"
    assert main(["equations", "simplest"]) == 0
    assert capsys.readouterr().out == Path("a.tex").read_text()
