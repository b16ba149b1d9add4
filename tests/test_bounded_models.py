"""Model files that ask for more than any machine has are refused, and hold nobody up."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import somersault as so
from somersault._core import limited
from somersault.model.read import _apart

WORLD = (
    '<worldbody><body name="a"><freejoint/><geom size="0.1" contype="0" conaffinity="0"/>{}'
    "</body></worldbody>"
)
ENDLESS = (
    '<replicate count="1000" offset="0.1 0 0">' * 6 + '<geom size="0.1"/>' + "</replicate>" * 6
)

TOO_LARGE = {
    "heights": ('<asset><hfield name="h" nrow="100000" ncol="100000" size="1 1 1 1"/></asset>', ""),
    "texture": (
        '<asset><texture name="t" type="2d" builtin="flat" width="99999" height="99999"/></asset>',
        "",
    ),
    "numbers": ('<size nuserdata="1000000000"/>', ""),
    "numbers of a body": ('<size nuser_body="1000000000"/>', ""),
    "sensor": ('<sensor><user dim="1000000000"/></sensor>', ""),
}


def written(folder: Path, before: str = "", inside: str = "") -> Path:
    file = folder / "robot.xml"
    file.write_text(f"<mujoco>{before}{WORLD.format(inside)}</mujoco>")
    return file


@pytest.mark.parametrize("what", TOO_LARGE)
def test_more_memory_than_a_model_gets_is_refused(what: str, tmp_path: Path) -> None:
    with pytest.raises(so.SomersaultError, match=r"^robot\.xml asks for more than 2 GB of memory"):
        so.load(written(tmp_path, *TOO_LARGE[what]))


@pytest.mark.parametrize("size", ['memory="100G"', 'njmax="80000" nconmax="40000"'])
def test_room_for_a_simulation_is_none_that_is_taken(size: str, tmp_path: Path) -> None:
    assert so.load(written(tmp_path, f"<size {size}/>")) == so.load(written(tmp_path))


@pytest.mark.parametrize("limit", ["SECONDS", "WAIT"])
def test_what_repeats_without_end_is_refused(
    limit: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By the processor's time or by the clock, whichever is up first."""
    monkeypatch.setattr(limited, limit, 2)
    with pytest.raises(so.SomersaultError, match=r"^robot\.xml takes more than 2 s to read"):
        so.load(written(tmp_path, inside=ENDLESS))


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="Windows has no signals")
@pytest.mark.parametrize(
    ("program", "words"),
    [
        ("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)", "SIGSEGV"),
        ("import os; os.write(1, b'half'); os.abort()", "SIGABRT"),
        ("raise MemoryError", "exit code 1"),
    ],
)
def test_a_reader_that_dies_is_not_said_to_be_slow(
    program: str, words: str, tmp_path: Path
) -> None:
    (tmp_path / "dies.py").write_text(program)
    with pytest.raises(limited.Ended, match=rf"ends the program that reads it \({words}\)"):
        limited.answer(str(tmp_path / "dies.py"))


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes")
@pytest.mark.parametrize(
    "before",
    [
        '<include file="pipe.xml"/>',
        '<asset><mesh name="m" file="pipe.stl"/></asset>',
        '<compiler meshdir="below"/><asset><mesh name="m" file="pipe.stl"/></asset>',
        '<include file="between.xml"/>',
        '<include file="/dev/zero"/>',
    ],
)
def test_pipes_and_devices_are_refused(before: str, tmp_path: Path) -> None:
    (tmp_path / "below").mkdir()
    for name in ("pipe.xml", "pipe.stl", "below/pipe.stl"):
        os.mkfifo(tmp_path / name)
    (tmp_path / "between.xml").write_text('<mujoco><include file="pipe.xml"/></mujoco>')
    with pytest.raises(so.SomersaultError, match="no file but a pipe or a device"):
        so.load(written(tmp_path, before))


def test_files_that_include_each_other_are_refused(tmp_path: Path) -> None:
    (tmp_path / "other.xml").write_text('<mujoco><include file="robot.xml"/></mujoco>')
    with pytest.raises(so.SomersaultError, match="already included"):
        so.load(written(tmp_path, '<include file="other.xml"/>'))


def test_a_model_read_apart_is_the_same_to_the_last_bit(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plain = (Path(so.model.__file__).parent / "shipped" / "gymnast.xml").read_text()
    file = tmp_path / "gymnast.xml"
    file.write_text(plain)
    here = so.load(file)

    def never(path: str) -> None:
        raise AssertionError("compiled in this process")

    monkeypatch.setattr(_apart, "compile_file", never)
    file.write_text(plain.replace("<worldbody>", "<size nuserdata='1'/><worldbody>"))
    apart = so.load(file)
    assert apart == here
    for one, two in zip(here.bodies, apart.bodies, strict=True):
        assert one.inertia_from == two.inertia_from
        assert len(one.shapes) == len(two.shapes)
        np.testing.assert_array_equal(one.inertia, two.inertia)


@pytest.mark.filterwarnings("ignore::somersault.SomersaultWarning")  # of what a robot has besides
def test_shipped_models_need_no_other_process(monkeypatch: pytest.MonkeyPatch) -> None:
    def never(path: Path) -> None:
        raise AssertionError(path)

    monkeypatch.setattr(_apart, "_apart", never)
    for file in (Path(so.model.__file__).parent / "shipped").glob("*.xml"):
        assert so.load(file).bodies


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells a child of it")
def test_the_process_ends_with_whoever_asked(tmp_path: Path) -> None:
    """Killed without a word, it leaves nothing that goes on."""
    file = written(tmp_path, inside=ENDLESS)
    program = f"import somersault as so; so.load({str(file)!r})"
    asking = subprocess.Popen([sys.executable, "-c", program])
    try:
        while not (children := _reading(file)):
            assert asking.poll() is None
            time.sleep(0.05)
    finally:
        asking.kill()
        asking.wait()
    while set(children) & set(_reading(file)):
        time.sleep(0.05)  # the limit on its time would end it too, but only after a minute


def _reading(file: Path) -> list[int]:
    """Processes that are busy with a file within limits, by their number."""
    busy = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            words = (process / "cmdline").read_bytes().split(b"\0")  # none of one that has ended
        except OSError:
            continue
        if str(file).encode() in words:
            busy.append(int(process.name))
    return busy
