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


MANY = FLIGHT + '[vary.leant]\nadds_to = "takeoff.tilt"\nnormal = [0.0, 0.1]\n[sample]\nsize = 9\n'


@pytest.mark.parametrize(
    ("outputs", "says"),
    [
        (["--plot", "p.png", "--landings", "p.png"], "p.png is to be written twice"),
        (["--plot", "p.png", "--landings", "new/../p.png"], "p.png is to be written twice"),
        (["--out", "new", "--plot", "new/x.png"], "new/x.png would be inside of new"),
        (["--out", "link/s.zarr", "--plot", "s.zarr/x.png"], "s.zarr/x.png would be inside of"),
        (["--out", "old/inner.zarr"], "old/inner.zarr would be inside of"),
        (["--out", "old/tilt/inner.nc"], "old/tilt/inner.nc would be inside of"),
        (["--out", "old", "--plot", "old/x.png"], "old/x.png would be inside of"),
        (["--out", "link/old/inner.zarr"], "inner.zarr would be inside of"),
    ],
)
def test_outputs_do_not_replace_each_other(
    outputs: list[str],
    says: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What is refused is refused before anything is written."""
    monkeypatch.chdir(tmp_path)
    Path("many.toml").write_text(MANY)
    Path("link").symlink_to(".")
    (tmp_path / "old" / "tilt").mkdir(parents=True)
    (tmp_path / "old" / "zarr.json").write_text("{}")
    before = sorted(tmp_path.rglob("*"))
    assert main(["ensemble", "many.toml", *outputs]) == 2
    said = capsys.readouterr().err
    assert says in said
    assert said.count("\n") == 1
    assert sorted(tmp_path.rglob("*")) == before


def test_outputs_of_one_motion_do_not_replace_each_other(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Their endings differ; links do not."""
    monkeypatch.chdir(tmp_path)
    Path("a.html").symlink_to("a.gif")
    Path("a.toml").write_text(FLIGHT)
    assert main(["fly", "a.toml", "--video", "a.gif", "--page", "a.html"]) == 2
    assert "a.html is to be written twice" in capsys.readouterr().err


def test_outputs_beside_a_store_are_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("many.toml").write_text(MANY)
    for _ in range(2):  # the second time the store is there
        outputs = ["--out", "s.zarr", "--plot", "s.zarr/../p.png"]
        assert main(["ensemble", "many.toml", *outputs]) == 0
    assert Path("p.png").is_file()
