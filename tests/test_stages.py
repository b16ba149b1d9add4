"""What is told of long work, on a terminal and nowhere else."""

from __future__ import annotations

import os
import pty
import subprocess
import sys
from pathlib import Path

import pytest

from somersault._core import stages

SPEC = 'model = "furrer"\nduration = 1.0\n[takeoff]\nspin = 8.6\n'


@pytest.fixture
def terminal(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """A terminal on which everything is told at once; what was written to it."""
    written: list[str] = []
    monkeypatch.setattr(stages.os, "isatty", lambda number: True)
    monkeypatch.setattr(stages, "_PATIENCE", 0.0)
    monkeypatch.setattr(stages, "_PERIOD", 0.01)
    monkeypatch.setattr(stages, "_show", lambda line: written.append(line))
    return written


def until(written: list[str], words: str) -> None:
    """Wait until some words are told."""
    for _ in range(1_000):
        if any(words in line for line in written):
            return
        stages.time.sleep(0.01)
    pytest.fail(f"{words!r} was never told, but {set(written)}")


def test_what_is_done_is_told_with_how_much_of_it(terminal: list[str]) -> None:
    with stages.told():
        until(terminal, "working … 0 s")
        with stages.stage("drawing", 1_200) as drawing:
            drawing.advance(1_000)
            until(terminal, "drawing, 1,000 of 1,200 … 0 s")
            with stages.stage("compiling"):
                until(terminal, "compiling … 0 s")


def test_a_bar_is_not_talked_over(terminal: list[str]) -> None:
    with stages.stage(""), stages.told(), stages.stage("compiling"):
        stages.time.sleep(0.2)
    assert not terminal


def test_commands_tell_on_a_terminal(tmp_path: Path) -> None:
    """A film takes long enough."""
    (tmp_path / "a.toml").write_text(SPEC)
    ours, theirs = pty.openpty()
    shown = subprocess.Popen(
        [sys.executable, "-m", "somersault", "fly", "a.toml", "--video", "a.gif"],
        cwd=tmp_path, stdout=subprocess.DEVNULL, stderr=theirs,
    )  # fmt: skip
    os.close(theirs)
    said = b""
    while True:
        try:
            said += os.read(ours, 4096)
        except OSError:  # it has ended
            break
    assert shown.wait(60) == 0
    assert b"\xe2\x80\xa6" in said
    assert said.endswith(b"\r\x1b[2K")
