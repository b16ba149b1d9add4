"""Commands with a hundred kinds of wrong words: an answer, or one sentence and exit code 2."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from somersault.cli import main

DIGITS = "9" * 5000
SPEC = 'model = "book"\nduration = 0.1\n[takeoff]\nspin = 5.0\n'
MANY = SPEC + '[vary.a]\nadds_to = "takeoff.tilt"\nnormal = [0.0, 0.1]\n[sample]\nsize = 4\n'
PLAN = 'model = "furrer"\n[plan]\ntorque = 60.0\nnodes = 4\nstarts = 1\ntwists = 0\n'
INERTIAL = (
    '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
    "</inertial>"
)
HELD = (
    f'<robot name="r"><link name="world"/><link name="a">{INERTIAL}</link><joint name="j" '
    'type="continuous"><parent link="world"/><child link="a"/></joint></robot>'
)
NAMES = [
    "", ".", "..", "/", "-", "folder", "folder/", "fifo", "fifo.toml", "fifo.xml", "empty",
    "empty/x.xml", "noise.xml", "noise.toml", "loop", "loop.xml", "loop.toml", "/dev/zero",
    "/dev/stdin", "/dev/null", "n" * 5000, "n" * 300 + ".xml", "n" * 300 + ".toml", "a\nb.xml", "~",
    "*", "=", "nan", "-1", ".xml", ".toml", "nothing.urdf", "book ", "%s", "{}", "\udcff.xml",
    "a\0b.xml", "a\0b.toml", "é", "\ud800.osim",
]  # fmt: skip
ASSIGNED = [
    "", "=", "=1", "shoulder", "shoulder=", "shoulder=a", "shoulder=nan", "shoulder=inf",
    "shoulder=1e999", f"shoulder={DIGITS}", "shoulder=1=2", "shoulder=1e308", "shoulder=-1e308",
    "left_shoulder=1e300", "é=1", "\udcff=1", f"{'a' * 5000}=1", "shoulder=0x10", "a\0b=1",
]  # fmt: skip
NUMBERS = ["0", "-1", "1.5", "nan", "inf", "1e3", DIGITS, "9" * 19, "x", "", "-" + DIGITS]
SCHEDULERS = [
    "", "x", "tcp://", "tcp://127.0.0.1:99999", "tcp://127.0.0.1:1", "tcp://[::1", "http://a",
    "tcp://127.0.0.1:nan", f"tcp://127.0.0.1:{DIGITS}", "\udcff", "ucx://a", "inproc://x",
    "ws://127.0.0.1:3", "tls://127.0.0.1:2", "a" * 3000, "a\0b",
]  # fmt: skip
ORDERS = [
    [], [""], ["x"], ["--x"], ["fly"], ["fly", "one.toml", "one.toml"], ["models", "--json", "x"],
    ["ensemble", "many.toml", "--workers", "1", "--scheduler", "x"],
    ["equations", "book", "--latex", "--c"], ["reproduce", "", "x"], ["stability", "furrer"],
    ["stability", "furrer", "--lock"], ["stability", "furrer", "--axis", "2", "--axis", "4"],
    ["map", "book", "--out", "a.txt", "--out", "a.png"], ["fly", "one.toml", "--json", "--json"],
    ["ensemble", "many.toml", "--out", "same", "--plot", "same"],
    ["fly", "one.toml", "--out", "same.nc", "--video", "same.nc"],
    ["plan", "one.toml"], ["plan", "plan.toml", "--out", "plan.toml"],
    ["plan", "plan.toml", "--out", "plan.nc"], ["plan", "plan.toml", "--video", "plan.toml"],
]  # fmt: skip


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the names mean something, of every strange kind."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "one.toml").write_text(SPEC)
    (tmp_path / "many.toml").write_text(MANY)
    (tmp_path / "plan.toml").write_text(PLAN)
    (tmp_path / "folder").mkdir()
    (tmp_path / "empty").touch()
    for ending in (".xml", ".toml"):
        (tmp_path / f"noise{ending}").write_bytes(bytes(range(256)))
    if hasattr(os, "mkfifo"):
        for name in ("fifo", "fifo.toml", "fifo.xml"):
            os.mkfifo(tmp_path / name)
    for name in ("loop", "loop.xml", "loop.toml"):
        (tmp_path / name).symlink_to(name)


def answered(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    try:
        code = main(words)
    except SystemExit as stop:  # argparse
        code = stop.code  # type: ignore[assignment]
    said = [line for line in capsys.readouterr().err.split("\n") if not line.startswith("note: ")]
    assert (code, len(said)) in ((0, 1), (2, 2)), (words, said)
    assert len(said[0]) < 2000


@pytest.mark.parametrize(
    "command", ["models", "stability", "map", "equations", "fly", "plan", "ensemble"]
)
def test_names(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    for name in NAMES:
        answered([command, name], capsys)


@pytest.mark.parametrize("option", ["--pose", "--stiffness", "--damping", "--lock", "--axis"])
def test_assignments(option: str, capsys: pytest.CaptureFixture[str]) -> None:
    for text in ASSIGNED:
        answered(["stability", "furrer", option, text], capsys)


@pytest.mark.parametrize("option", ["--threads", "--workers", "--chunk"])
def test_numbers(option: str, capsys: pytest.CaptureFixture[str]) -> None:
    for text in NUMBERS:
        answered(["ensemble", "many.toml", option, text], capsys)


def test_processes(capsys: pytest.CaptureFixture[str]) -> None:
    for text in [*NUMBERS, "1"]:
        answered(["plan", "plan.toml", "--processes", text], capsys)


def test_other_numbers(capsys: pytest.CaptureFixture[str]) -> None:
    for text in NUMBERS:
        answered(["map", "human_pike", "--energies", text], capsys)
        answered(["stability", "book", "--rate", text], capsys)


def test_schedulers(capsys: pytest.CaptureFixture[str]) -> None:
    for address in SCHEDULERS:
        answered(["ensemble", "many.toml", "--scheduler", address], capsys)


@pytest.mark.parametrize("words", ORDERS, ids=" ".join)
def test_orders(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    answered(words, capsys)


@pytest.mark.parametrize("name", [n for n in NAMES if n])
def test_entries_of_the_thesis(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    answered(["reproduce", name, "--out", "report"], capsys)
    assert not Path("report").exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (
            ["models", "--athlete", "heigt=1.7"],
            "heigt is no key of --athlete; here it",
        ),
        (["run", "biped", "--flip", "att=1"], "flip.att is no key of --flip; here it takes at"),
        (["fly", "latin.toml"], "latin.toml is not UTF-8, as TOML is; save it as that"),
        (["fly", "fifo.toml"], "'fifo.toml' is a folder, a pipe or a device, and no SPEC file"),
        (["models", "fifo.xml"], "'fifo.xml' is a folder, a pipe or a device, and no model file"),
        (["models", "fifo"], "'fifo' is a folder, a pipe or a device, and no model file"),
        (["fly", "of_fifo.toml"], "fifo.xml' is a folder, a pipe or a device, and no model file"),
        (["fly", "nothing.toml"], "there is no SPEC file 'nothing.toml'; check the path"),
        (["models", "nothing.xml"], "there is no model file 'nothing.xml'; check the path"),
        (["stability", "held.urdf"], 'load it with base = "free"'),
    ],
)
def test_what_is_said_of_a_mistake(
    words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    if "fifo" in said and not hasattr(os, "mkfifo"):
        pytest.skip("there are no pipes")
    Path("latin.toml").write_bytes(SPEC.replace("book", "Bücher").encode("latin-1"))
    Path("of_fifo.toml").write_text(SPEC.replace("book", "fifo.xml"))
    Path("held.urdf").write_text(HELD)
    assert main(words) == 2
    error = capsys.readouterr().err
    assert error.startswith("somersault: ")
    assert error.count("\n") == 1
    assert said in error
