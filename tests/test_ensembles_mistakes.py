"""Bad specifications: one sentence that names the key, exit code 2, and nothing touched."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import zarr

from somersault.cli import main

BASE = {
    "": 'model = "furrer"\nduration = 0.2\n',
    "takeoff": "[takeoff]\ntilt = 0.01\nspin = 8.64\n",
    "joints": '[joints.shoulder]\nmotion = "sprung"\nangle = 1.4\nstiffness = 30.0\nhold = true\n',
    "vary": '[vary.K]\nsets = "joints.shoulder.stiffness"\nvalues = [20.0, 30.0]\n',
    "more": '[vary.leant]\nadds_to = "takeoff.tilt"\nnormal = [0.0, 0.05]\n',
    "sample": "[sample]\nsize = 4\nseed = 1\n",
    "report": '[report]\nquantities = ["tilt"]\n',
    "target": "",
}


def spec(folder: Path, **parts: str) -> Path:
    file = folder / "spec.toml"
    file.write_text("".join({**BASE, **parts}.values()))
    return file


def refused(
    capsys: pytest.CaptureFixture[str], file: Path, *names: str, more: tuple[str, ...] = ()
) -> str:
    """The one line that the command says, which has these words in it."""
    before = tree(file.parent)
    out = () if "--out" in more else ("--out", str(file.parent / "map.zarr"))
    try:
        code = main(["ensemble", str(file), *out, *more])
    except SystemExit as stop:  # of argparse
        code = stop.code
    said = capsys.readouterr()
    assert code == 2, said
    assert said.out == ""
    assert said.err.count("\n") == 1
    assert said.err.endswith("\n")
    assert said.err.startswith("somersault")
    assert "Traceback" not in said.err
    assert len(said.err) < 600
    for name in names:
        assert name in said.err, (name, said.err)
    assert tree(file.parent) == before
    return said.err


def tree(folder: Path) -> dict[str, tuple[int, bytes]]:
    """All that is in a folder; a place that was tried has another time, and nothing else."""
    return {
        str(f): (f.stat().st_mtime_ns, f.read_bytes()) if f.is_file() else (0, b"")
        for f in sorted(folder.rglob("*"))
    }


def vary(name: str, body: str) -> dict[str, str]:
    return {"vary": f"[vary.{name}]\n{body}\n"}


K = 'sets = "joints.shoulder.stiffness"\n'
GRID = "{from = 1.0, to = 2.0, count = 1000000}"
LISTED = 'sets = "takeoff.twist"\nsamples = '

BAD: list[tuple[dict[str, str], tuple[str, ...]]] = [
    # keys that there are not, at every level
    ({"": BASE[""] + "colour = 1\n"}, ("colour",)),
    ({"": BASE[""] + "samples = 10\n"}, ("samples", "[report]")),
    ({"takeoff": BASE["takeoff"] + "speed = 1\n"}, ("takeoff.speed",)),
    ({"joints": BASE["joints"] + "mass = 1\n"}, ("joints.shoulder.mass",)),
    (vary("K", K + "value = [1.0]"), ("vary.K.value", "values")),
    ({"sample": "[sample]\ncount = 4\n"}, ("sample.count", "size")),
    ({"report": '[report]\nquantity = ["tilt"]\n'}, ("report.quantity",)),
    ({"target": "[target]\nlean = 0.1\n"}, ("target", "lean")),
    (vary("K", K + "values = {start = 1.0, to = 2.0, count = 3}"), ("vary.K.values", "from")),
    (vary("K", K + "values = {from = 1.0, to = 2.0, count = 3, step = 1}"), ("vary.K.values",)),
    # of the wrong type
    ({"vary": "", "more": "", "": BASE[""] + "vary = 3\n"}, ("vary", "table")),
    ({"vary": "[vary]\nK = 3\n"}, ("vary.K", "table")),
    ({"sample": "[sample]\nsize = 4.5\n"}, ("sample.size", "whole")),
    ({"sample": '[sample]\nsize = "4"\n'}, ("sample.size", "whole")),
    ({"sample": "[sample]\nsize = 4\nseed = 1.5\n"}, ("sample.seed",)),
    ({"sample": "[sample]\nsize = 4\nsequence = 3\n"}, ("sample.sequence",)),
    ({"report": '[report]\nquantities = "tilt"\n'}, ("report.quantities",)),
    ({"report": '[report]\nhistory = ["tilt"]\nsamples = 2.5\n'}, ("report.samples",)),
    (vary("K", "sets = 3\nvalues = [1.0]"), ("vary.K.sets",)),
    (vary("K", K + "values = 3"), ("vary.K.values",)),
    (vary("K", K + 'values = ["a"]'), ("vary.K.values",)),
    (vary("K", K + "values = [[1.0], [2.0]]"), ("vary.K.values",)),
    (vary("K", K + 'values = {from = "a", to = 2.0, count = 3}'), ("vary.K.values.from",)),
    (vary("K", K + "values = {from = 1.0, to = 2.0, count = true}"), ("vary.K.values.count",)),
    (vary("K", K + 'uniform = "wide"'), ("vary.K.uniform",)),
    (vary("K", K + 'values = [1.0]\nscale = "big"'), ("vary.K.scale",)),
    (vary("K", K + "values = [1.0]\nunit = 3"), ("vary.K.unit",)),
    ({"target": '[target]\ntilt = "flat"\n'}, ("target.tilt",)),
    # empty and endless
    (vary("K", K + "values = []"), ("vary.K.values", "empty")),
    (vary("K", K + "values = {from = 1.0, to = 1.0, count = 3}"), ("vary.K.values", "range")),
    (vary("K", K + "values = {from = 1.0, to = 2.0, count = 1}"), ("vary.K.values", "range")),
    (vary("K", K + "values = {from = 1.0, to = 2.0, count = 0}"), ("vary.K.values.count",)),
    (vary("K", K + "values = {from = 1.0, to = 2.0, count = -3}"), ("vary.K.values.count",)),
    (vary("K", K + "values = {from = 1.0, to = 2.0, count = 2.5}"), ("vary.K.values.count",)),
    *[(vary("K", f"{K}values = {{from = 1.0, to = 2.0, count = {count}}}"),
       ("vary.K.values.count must be a whole number from 1 to 10000000, and is",))
      for count in ("1000000000000", "1e12", "1e300", "2e7", "-1e3", '"ten"')],
    ({"vary": "[vary]\n", "more": "", "sample": ""}, ("vary is empty", "[vary.NAME]")),
    (vary("K", f"{K}values = {GRID}\n[vary.t]\nsets = \"takeoff.twist\"\nvalues = {GRID}"),
     ("vary", "K 1000000", "t 1000000")),
    (vary("K", K + "values = [1.0, 2.0, 1.0]"), ("vary.K.values", "twice")),
    (vary("K", K + "uniform = [2.0, 2.0]"), ("vary.K.uniform", "empty")),
    (vary("K", K + "uniform = [3.0, 2.0]"), ("vary.K.uniform",)),
    (vary("K", K + "uniform = [3.0]"), ("vary.K.uniform", "[low, high]")),
    (vary("K", K + "normal = [3.0, 0.0]"), ("vary.K.normal",)),
    (vary("K", K + "normal = [3.0, -1.0]"), ("vary.K.normal",)),
    (vary("K", K + "triangular = [1.0, 3.0, 2.0]"), ("vary.K.triangular",)),
    (vary("K", K + "lognormal = [-1.0, 1.0]"), ("vary.K.lognormal",)),
    (vary("K", K + "truncated_normal = [0.0, 1.0, 20.0, 30.0]"), ("vary.K.truncated_normal",)),
    (vary("K", LISTED + "[]"), ("vary.K.samples",)),
    ({"sample": "[sample]\nsize = 0\n"}, ("sample.size",)),
    ({"sample": "[sample]\nsize = -4\n"}, ("sample.size",)),
    ({"sample": "[sample]\nsize = 1e300\n"}, ("sample.size",)),
    ({"report": '[report]\nhistory = ["tilt"]\n'}, ("report.samples",)),
    ({"report": '[report]\nhistory = ["tilt"]\nsamples = 1\n'}, ("report.samples",)),
    # not numbers
    (vary("K", K + "values = [1.0, nan]"), ("vary.K.values",)),
    (vary("K", K + "values = [1.0, inf]"), ("vary.K.values",)),
    (vary("K", K + "values = {from = nan, to = 2.0, count = 3}"), ("vary.K.values.from",)),
    (vary("K", K + "values = {from = 0.0, to = 2.0, count = inf}"), ("vary.K.values.count",)),
    (vary("K", K + "normal = [nan, 1.0]"), ("vary.K.normal",)),
    (vary("K", K + "values = [1.0]\nscale = nan"), ("vary.K.scale",)),
    ({"target": "[target]\ntilt = nan\n"}, ("target.tilt",)),
    ({"target": "[target]\ntilt = 0.0\ntolerance = nan\n"}, ("target.tolerance",)),
    ({"target": "[target]\ntilt = 0.0\ntolerance = inf\n"}, ("target.tolerance",)),
    # that are not there
    (vary("K", 'sets = "joints.shoulder.mass"\nvalues = [1.0]'), ("joints.shoulder.mass",)),
    (vary("K", 'sets = "joints.hip.angle"\nvalues = [1.0]'), ("hip", "left_shoulder")),
    (vary("K", 'sets = "joints.shoulder.rest"\nvalues = [1.0]'), ("vary.K", "rest")),
    (vary("K", 'sets = "joints.shoulder.times.1"\nvalues = [1.0]'), ("vary.K", "times.1")),
    (vary("K", 'sets = "bodies.head.mass"\nvalues = [1.0]'), ("vary.K", "head", "body")),
    (vary("K", 'sets = "bodies.body.position.1"\nvalues = [1.0]'), ("vary.K", "base")),
    (vary("K", 'sets = "bodies.body.com.4"\nvalues = [1.0]'), ("vary.K", "com.4")),
    (vary("K", 'sets = "takeoff.lean"\nvalues = [1.0]'), ("takeoff.lean", "takeoff.tilt")),
    (vary("K", 'sets = "takeoff.angular_momentum.2"\nvalues = [1.0]'), ("takeoff.spin",)),
    (vary("K", 'sets = "tilt"\nvalues = [1.0]'), ("vary.K", "takeoff.tilt")),
    (vary("K", 'sets = ""\nvalues = [1.0]'), ("vary.K", "sets")),
    (vary("K", "sets = []\nvalues = [1.0]"), ("vary.K", "sets")),
    (vary("K", "values = [1.0]"), ("vary.K", "sets")),
    (vary("K", K), ("vary.K", "values")),
    (vary("K", K + "values = [1.0]\nuniform = [0.0, 1.0]"), ("vary.K", "values and uniform")),
    (vary("K", K + 'adds_to = "takeoff.tilt"\nvalues = [1.0]'), ("vary.K", "adds_to")),
    ({"report": '[report]\nquantities = ["flips"]\n'}, ("report.quantities", "flips", "tilt")),
    ({"report": '[report]\nextremes = ["twists"]\n'}, ("report.extremes", "twists")),
    ({"report": '[report]\nhistory = ["landing_error"]\nsamples = 3\n'}, ("report.history",)),
    ({"report": '[report]\nquantities = ["tilt", "tilt"]\n'}, ("report.quantities", "twice")),
    ({"report": '[report]\nquantities = ["landing_error"]\n'}, ("landing_error", "target")),
    ({"target": "[target]\ntilt = 0.0\ntolerance = 0.1\n"}, ("landing_error",)),
    ({"target": "[target]\ntolerance = 0.1\n"}, ("target.tolerance",)),
    ({"": 'model = "robot"\n'}, ("robot",)),
    ({"": 'model = "furrer"\nuntil = "landing"\n'}, ("until", "quarter twist")),
    ({"": 'model = "furrer"\naccuracy = 1.0\n'}, ("accuracy",)),
    ({"": 'model = "furrer"\nduration = 0.0\n'}, ("duration",)),
    ({"": BASE[""] + "steps = 0\n"}, ("steps",)),
    ({"": BASE[""] + "steps = 1.5\n"}, ("steps", "whole")),
    # that do not go together
    (vary("K", K + 'values = [1.0]\n[vary.L]\nsets = "joints.left_shoulder.stiffness"\n'
          "values = [1.0]"), ("vary.K", "vary.L", "same number")),
    (vary("tilt", 'sets = "takeoff.tilt"\nvalues = [1.0]'), ("vary.tilt", "reported")),
    (vary("sample", K + "values = [1.0]"), ("vary.sample",)),
    (vary("time", K + "values = [1.0]"), ("vary.time",)),
    (vary("K", 'sets = "joints.shoulder.angle"\nvalues = [1.0, 4.0]'), ("vary.K.values", "4")),
    (vary("K", 'sets = "joints.shoulder.damping"\nvalues = [-1.0, 1.0]'), ("vary.K.values", "-1")),
    (vary("K", 'adds_to = "bodies.body.mass"\nvalues = [-99.0, 1.0]'), ("vary.K.values", "-99")),
    (vary("K", 'sets = "takeoff.spin"\nvalues = [0.0, 1.0]'), ("vary.K.values", "0")),
    ({"more": ""}, ("sample.size", "drawn")),
    ({"sample": "[sample]\nsize = 4\nsequence = \"saltelli\"\n"}, ("sample.size", "multiple of 3")),
    ({"sample": "[sample]\nsize = 4\nsequence = \"latin\"\n"}, ("sample.sequence", "sobol")),
    ({"sample": "[sample]\nsize = 4\nseed = -1\n"}, ("sample.seed",)),
    ({"sample": f"[sample]\nsize = 4\nseed = {10**30}\n"}, ("sample.seed", "9223372036854775807")),
    (vary("K", LISTED + "[0.1, 0.2, 0.3]"), ("vary.K.samples", "sample.size")),
    (vary("K", LISTED + str([0.1] * 20_000)), ("vary.K.samples", "20000")),
    (vary("K", LISTED + str([0.1] * 20_000)[:-1] + ", nan]"), ("vary.K.samples", "finite")),
    (vary("K", K + "values = " + str([0.1] * 20_000)[:-1] + ", inf]"), ("vary.K.values",)),
    (vary("K", LISTED + str([0.1] * 6)) | {
        "sample": "[sample]\nsize = 6\nsequence = \"saltelli\"\n"}, ("vary.K.samples", "saltelli")),
    # names that are paths
    *[(vary(f'"{name}"', K + "values = [1.0]"), ("vary.", "name"))
      for name in ("a/b", "../up", "..", "", "zarr.json")],
]  # fmt: skip


@pytest.mark.parametrize(
    ("parts", "names"), BAD, ids=[f"{k}-{n[0]}" for k, (_, n) in enumerate(BAD)]
)
def test_a_bad_specification(
    parts: dict[str, str], names: tuple[str, ...], tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    refused(capsys, spec(tmp_path, **parts), *names)


OPTIONS = [
    (("--workers", "0"), ("workers",)),
    (("--chunk", "0"), ("chunk",)),
    (("--threads", "-1"), ("threads",)),
    (("--chunk", "many"), ("--chunk",)),
    (("--workers", "1", "--scheduler", "tcp://127.0.0.1:1"), ("workers", "scheduler")),
    (("--tls-ca", "ca.pem"), ("--tls-ca", "--scheduler")),
    (("--tls-ca", "a", "--tls-cert", "b", "--tls-key", "c"), ("--tls-key", "--scheduler")),
    (("--tls-ca", "ca.pem", "--scheduler", "tls://a:1"), ("--tls-cert", "give both")),
    (("--plot", "map.doc"), ("map.doc", ".png or .svg")),
]


@pytest.mark.parametrize(("more", "names"), OPTIONS)
def test_bad_options(
    more: tuple[str, ...], names: tuple[str, ...], tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    refused(capsys, spec(tmp_path), *names, more=more)


@pytest.mark.parametrize("address", ["127.0.0.1:9", "tcp://127.0.0.1:9", "nobody:x", "ftp://a:1"])
def test_a_scheduler_that_is_not_there(
    address: str, tmp_path: Path, capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    monkeypatch.setattr("somersault.ensembles._scheduler._PATIENCE", 1.0)
    refused(capsys, spec(tmp_path), "scheduler", address, more=("--scheduler", address))


def test_a_path_that_is_something_else(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A file, a folder, another Zarr group, a broken store, a file on the way there."""
    file = spec(tmp_path)
    plain, folder, other = (tmp_path / n for n in ("plain", "folder", "other.zarr"))
    plain.write_text("mine")
    folder.mkdir()
    (folder / "mine").write_text("mine")
    zarr.create_group(store=str(other)).create_array("mine", data=np.arange(3.0))
    broken = tmp_path / "broken.zarr"
    broken.mkdir()
    (broken / "zarr.json").write_text("{")
    for out in (plain, folder, other, broken):
        refused(capsys, file, out.name, more=("--out", str(out)))
    refused(capsys, file, "plain", more=("--out", str(plain / "map.zarr")))


def test_a_store_of_another_specification(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, store = spec(tmp_path), tmp_path / "map.zarr"
    assert main(["ensemble", str(file), "--out", str(store)]) == 0
    capsys.readouterr()
    for key, parts in {
        "sample.seed": {"sample": "[sample]\nsize = 4\nseed = 2\n"},
        "sample.size": {"sample": "[sample]\nsize = 5\nseed = 1\n"},
        "takeoff.tilt": {"takeoff": "[takeoff]\ntilt = 0.02\nspin = 8.64\n"},
        "duration": {"": 'model = "furrer"\nduration = 0.3\n'},
        "vary.K.values": vary("K", K + "values = [20.0, 31.0]"),
        "vary.leant.normal": {"more": BASE["more"].replace("0.05", "0.06")},
        "report.quantities": {"report": '[report]\nquantities = ["twist"]\n'},
    }.items():
        refused(capsys, spec(tmp_path, **parts), key, "map.zarr")


def test_too_much_for_one_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    parts = {"sample": "[sample]\nsize = 50000000\n"}
    refused(capsys, spec(tmp_path, **parts), "Zarr store", more=("--out", str(tmp_path / "map.nc")))


def test_a_spec_that_is_none(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "spec.toml"
    file.write_text("model = furrer")
    refused(capsys, file, "TOML")
    file.write_bytes(b"\xff\xfe\x00")
    refused(capsys, file, "TOML")


def test_an_unknown_table_is_told_what_an_ensemble_takes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = spec(tmp_path, vary='[vry.K]\nsets = "joints.shoulder.stiffness"\nvalues = [20.0]\n')
    said = refused(capsys, file, "vry is no key", "vary, sample, report, target", "takeoff")
    assert "samples" not in said


def test_a_scheduler_that_is_not_there_leaves_dask_as_it_was() -> None:
    """Where nothing has used dask before: its settings are looked at in a program of its own."""
    program = (
        "import somersault as so\n"
        "for _ in range(2):\n"
        "    try:\n"
        "        so.ensemble('furrer', so.Takeoff(spin=5.0), 0.1, size=1, scheduler='x://y')\n"
        "    except so.SomersaultError as mistake:\n"
        "        print(mistake)\n"
        "import dask.config, distributed\n"
        "print(dask.config.get('distributed.comm.timeouts.connect'))\n"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    first, again, seconds = run.stdout.splitlines()
    assert first == again
    assert seconds
