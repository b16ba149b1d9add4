"""The programs that read what others wrote (`limited`), forked instead of started.

A new Python and MuJoCo take a good half second, a fork a few milliseconds. The program, its limits
and what is made of its end are those of the package.
"""

from __future__ import annotations

import os
import runpy
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NoReturn
from unittest import mock

import mujoco  # noqa: F401  # before anything is forked

from somersault._core import limited


@contextmanager
def programs_forked() -> Iterator[None]:
    """While this lasts, `limited.answer` forks this process."""
    with mock.patch.object(limited, "subprocess", _Forking()):
        yield


class _Forking:
    """The module `subprocess` but for its `run`."""

    def run(self, command: list[str], **given: Any) -> Any:
        """Fork."""
        return _run(command, **given)

    def __getattr__(self, name: str) -> Any:
        return getattr(subprocess, name)


def _run(command: list[str], *, timeout: float, **_: Any) -> Any:
    """As `subprocess.run`: the program's own clock (`limited.limit`) is the only one here."""
    program, arguments = command[2], command[3:]
    ours, theirs = os.pipe()
    child = os.fork()
    if child == 0:
        _become(theirs, program, arguments)
    os.close(theirs)
    with os.fdopen(ours, "rb") as pipe:
        said = pipe.read()
    _, status = os.waitpid(child, 0)
    return subprocess.CompletedProcess(command, os.waitstatus_to_exitcode(status), said)


def _become(out: int, program: str, arguments: list[str]) -> NoReturn:
    code = 1
    try:
        os.dup2(out, 1)
        sys.argv = [program, *arguments]
        runpy.run_path(program, run_name="__main__")
        code = 0
    finally:
        os._exit(code)
