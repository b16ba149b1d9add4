"""Where files are to be written is looked at before anything is computed, and nothing is lost."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from shares import every

import somersault as so
from somersault._core import files, places
from somersault.cli import main
from somersault.thesis import reproduce
from somersault.view import film, page, picture

ROOT = sys.platform == "linux" and os.geteuid() == 0
FLIGHT = so.fly("book", so.Takeoff(spin=5.0), 0.2)
LEANT = {"leant": so.Vary(adds_to="takeoff.tilt", normal=[0.0, 0.05])}
SPEC = 'model = "book"\nduration = 0.2\n[takeoff]\nspin = 5.0\n'
MANY = SPEC + '[vary.leant]\nadds_to = "takeoff.tilt"\nnormal = [0.0, 0.1]\n[sample]\nsize = 9\n'
# The command in front of a place, and the ending that it writes.
COMMANDS = {
    "fly --out": (["fly", "no.toml", "--out"], ".nc"),
    "fly --video": (["fly", "no.toml", "--video"], ".gif"),
    "fly --page": (["fly", "no.toml", "--page"], ".html"),
    "ensemble --out": (["ensemble", "no.toml", "--out"], ".nc"),
    "ensemble --out, a store": (["ensemble", "no.toml", "--out"], ".zarr"),
    "ensemble --plot": (["ensemble", "no.toml", "--plot"], ".png"),
    "map --out": (["map", "no.xml", "--out"], ".svg"),
    "equations --out": (["equations", "no.xml", "--out"], ".tex"),
    "equations --c --out": (["equations", "no.xml", "--c", "--out"], ".c"),
}
CALLS: dict[str, tuple[Callable[[Path], object], str]] = {
    "Flight.save": (FLIGHT.save, ".csv"),
    "film": (lambda path: film(FLIGHT, path), ".gif"),
    "page": (lambda path: page(FLIGHT, path), ".html"),
    "picture": (lambda path: picture(FLIGHT, path), ".png"),
    "Maneuver.save": (so.Maneuver("book", so.Takeoff(spin=5.0), 0.2).save, ".toml"),
    "write_mjcf": (lambda path: so.write_mjcf(so.load("book"), path), ".xml"),
    "ensemble": (
        lambda path: so.ensemble("book", so.Takeoff(spin=5.0), 1e9, LEANT, size=9, out=path),
        ".nc",
    ),
}  # fmt: skip


def in_the_way(folder: Path, ending: str) -> dict[str, Path]:
    """Places at which no file can be written, by what they are called in the message."""
    (folder / "file").write_text("mine")
    (folder / f"folder{ending}").mkdir()
    (folder / f"text{ending}").write_text("what somebody wrote")
    long = "n" * 300
    return {
        "folder": folder / f"file/a{ending}",
        "too long": folder / f"{long}{ending}",
        "File name": folder / "new" / long / f"a{ending}",
        "cannot": Path(f"/proc/nowhere/a{ending}"),
        f"folder{ending}": folder / f"folder{ending}",
        "did not write it" if ending != ".zarr" else "no ensemble": folder / f"text{ending}",
    }


@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_looks_at_the_place_first(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The model or SPEC that is not there is not even looked for."""
    words, ending = COMMANDS[name]
    for says, place in in_the_way(tmp_path, ending).items():
        if ending == ".zarr" and os.path.lexists(place):
            continue  # what is there is looked at with the SPEC that it has to be of
        assert main([*words, str(place)]) == 2
        said = capsys.readouterr().err
        assert said.count("\n") == 1
        assert says in said
        assert "no.toml" not in said
        assert "no.xml" not in said
    assert (tmp_path / f"text{ending}").read_text() == "what somebody wrote"
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted(
        ["file", f"folder{ending}", f"text{ending}"]
    )


@pytest.mark.parametrize("name", CALLS)
def test_a_call_looks_at_the_place_first(name: str, tmp_path: Path) -> None:
    call, ending = CALLS[name]
    for says, place in in_the_way(tmp_path, ending).items():
        with pytest.raises(so.SomersaultError, match=says) as mistake:
            call(place)
        assert "\n" not in str(mistake.value)
    assert (tmp_path / f"text{ending}").read_text() == "what somebody wrote"


@pytest.mark.parametrize("name", [name for name in CALLS if name != "ensemble"])
def test_what_is_written_replaces_its_like(name: str, tmp_path: Path) -> None:
    """The mark by which a file is known is in what is written."""
    call, ending = CALLS[name]
    for _ in range(2):
        call(tmp_path / f"a{ending}")
    (tmp_path / f"empty{ending}").touch()
    call(tmp_path / f"empty{ending}")


@pytest.mark.parametrize("name", ["equations --out", "equations --c --out", "map --out"])
def test_a_command_replaces_its_like(name: str, tmp_path: Path) -> None:
    words, ending = COMMANDS[name]
    for _ in range(2):
        assert main([words[0], "book", *words[2:], str(tmp_path / f"a{ending}")]) == 0


@pytest.mark.parametrize("name", ["map.csv", "map.png", "map.txt", "run_1.5"])
def test_a_store_of_another_ending_is_refused(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "many.toml").write_text(MANY)
    assert main(["ensemble", str(tmp_path / "many.toml"), "--out", str(tmp_path / name)]) == 2
    assert ".zarr" in capsys.readouterr().err
    assert not (tmp_path / name).exists()


def test_a_store_needs_no_ending(tmp_path: Path) -> None:
    options = {"size": 9, "out": tmp_path / "leant"}
    so.ensemble("book", so.Takeoff(spin=5.0), 0.2, LEANT, **options)
    (tmp_path / "leant").rename(tmp_path / "leant.v1")  # what is there already keeps its name
    options["out"] = tmp_path / "leant.v1"
    so.ensemble("book", so.Takeoff(spin=5.0), 0.2, LEANT, **options)
    assert [p.name for p in tmp_path.iterdir()] == ["leant.v1"]


def test_a_report_in_a_place_that_cannot_be(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(so.SomersaultError, match="folder"):
        reproduce(None, tmp_path / "file" / "report", progress=False)


def test_a_write_protected_file_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "a.csv"
    FLIGHT.save(file)
    monkeypatch.setattr(places.os, "access", lambda path, mode: False)  # root may write all
    with pytest.raises(so.SomersaultError, match="protected"):
        FLIGHT.save(file)


def no_room(path: Path, content: object) -> None:
    raise OSError(28, "No space left on device", str(path))


def test_a_disk_that_is_full_in_the_end(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """What was found is printed all the same."""
    for name, text in (("one.toml", SPEC), ("many.toml", MANY)):
        (tmp_path / name).write_text(text)
    for module in ("_core.datasets", "ensembles._netcdf", "view._film"):
        monkeypatch.setattr(f"somersault.{module}.write", no_room)
    for words in (
        ["fly", "one.toml", "--out", "a.nc", "--video", "a.gif"],
        ["ensemble", "many.toml", "--out", "a.nc"],
    ):
        words = [str(tmp_path / word) if "." in word else word for word in words]
        assert main(words) == 2
        out, err = capsys.readouterr()
        assert "book" in out
        assert err.count("\n") == 1
        assert "No space left" in err
    with pytest.warns(so.SomersaultWarning, match="in memory alone"):
        found = so.ensemble(
            "book", so.Takeoff(spin=5.0), 0.2, LEANT, size=9, out=tmp_path / "a.nc"
        )  # fmt: skip
    assert np.isfinite(found.dataset["tilt"]).all()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no such device")
def test_a_standard_output_that_is_full() -> None:
    with open("/dev/full", "w") as full:
        run = subprocess.run(
            [sys.executable, "-m", "somersault", "models", "--json"],
            stdout=full, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
    assert run.returncode == 2
    assert run.stderr == "somersault: cannot write: No space left on device\n"


def test_what_is_not_finished_is_removed(tmp_path: Path) -> None:
    with files.temporary_folder(tmp_path) as folder:
        (folder / "deep").mkdir()
        (folder / "deep" / "file").touch()
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere all names are text")
@pytest.mark.parametrize(
    "environment", every([{}, {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}], 2)
)
def test_names_of_files_that_are_no_text(tmp_path: Path, environment: dict[str, str]) -> None:
    folder = os.fsencode(tmp_path) + b"/\xff\xc3\xa9"
    os.mkdir(folder)
    model = Path(so.__file__).parent / "model" / "shipped" / "book.xml"
    shutil.copy(model, folder + b"/b\xe9.xml")
    for name, text in ((b"one\xff.toml", SPEC), (b"many\xff.toml", MANY)):
        with open(folder + b"/" + name, "w") as file:
            file.write(text)
    for words in (
        [b"models", b"b\xe9.xml"],
        [b"models", b"no\xe9.xml"],
        [b"map", b"b\xe9.xml", b"--out", b"map\xff.svg"],
        [b"equations", b"b\xe9.xml", b"--out", b"b\xff.tex"],
        [b"fly", b"one\xff.toml", b"--out", b"a\xff.nc", b"--page", b"a\xff.html"],
        [b"ensemble", b"many\xff.toml", b"--out", b"a\xff.zarr", b"--plot", b"a\xff.png"],
        [b"ensemble", b"many\xff.toml", b"--out", b"b\xff.nc", b"--json"],
        [b"reproduce", b"table4-1", b"--out", b"report\xff"],
    ):
        run = subprocess.run(
            [sys.executable, "-m", "somersault", *words], cwd=folder, capture_output=True,
            env={**os.environ, **environment},
        )  # fmt: skip
        assert run.returncode == (2 if b"no\xe9.xml" in words else 0), run.stderr
        assert b"Traceback" not in run.stderr
    written = {b"map\xff.svg", b"b\xff.tex", b"a\xff.nc", b"a\xff.html", b"a\xff.zarr",
               b"a\xff.png", b"b\xff.nc", b"report\xff"}  # fmt: skip
    assert written <= set(os.listdir(folder))
