"""What a program is doing: told on a terminal once it takes long."""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

_PATIENCE = 2.0  # s before anything is told
_PERIOD = 0.2  # s
_WIDTH = 76  # columns
_CLEAR = "\r\x1b[2K"

_stages: list[Stage] = []


class Stage:
    """Something that a program is doing, and how much of it is done."""

    def __init__(self, words: str, total: int = 0) -> None:
        self.words, self.total, self.done = words, total, 0

    def advance(self, more: int = 1) -> None:
        """So many more of the total are done."""
        self.done += more

    def __str__(self) -> str:
        return f"{self.words}, {self.done:,} of {self.total:,}" if self.total else self.words


@contextmanager
def stage(words: str, total: int = 0) -> Iterator[Stage]:
    """What is done within, in words like "compiling"; of so many parts, where they are counted."""
    current = Stage(words, total)
    _stages.append(current)
    try:
        yield current
    finally:
        _stages.remove(current)


@contextmanager
def told() -> Iterator[None]:
    """On a terminal, a line says what is done within and for how long, once it takes long.

    A stage without words has a way of its own to tell, like a bar.
    """
    if not os.isatty(2):
        yield
        return
    over = threading.Event()
    teller = threading.Thread(target=_tell, args=(over,), daemon=True)
    teller.start()
    try:
        yield
    finally:
        over.set()
        teller.join()
        wipe()


def wipe() -> None:
    """Take away the line that is told, before something else is said."""
    if _line:
        _show("")


_line = ""


def _tell(over: threading.Event) -> None:
    begun = time.monotonic()
    while not over.wait(_PERIOD):
        seconds = time.monotonic() - begun
        stages = list(_stages)
        if seconds < _PATIENCE or not all(stage.words for stage in stages):
            wipe()
            continue
        words = str(stages[-1]) if stages else "working"
        _show(f"{words[:_WIDTH]} … {seconds:.0f} s")


def _show(line: str) -> None:
    global _line
    _line = line
    sys.stderr.write(_CLEAR + line)
    sys.stderr.flush()
