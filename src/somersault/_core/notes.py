"""What is accepted and strange: a warning that points at the user's line."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence
from types import FrameType

from somersault._core.errors import SomersaultWarning

_PACKAGE = __name__.partition(".")[0]


def note(message: str) -> None:
    """Warn of something with a SomersaultWarning, at the line that called the package.

    That is the caller of the outermost call of ours. `skip_file_prefixes` of `warnings.warn` (from
    Python 3.12 on) would stop sooner, at a dataclass's own `__init__`, which is in no file.

    Parameters
    ----------
    message : str
        One sentence.
    """
    line = _users_line()
    warnings.warn_explicit(
        message,
        SomersaultWarning,
        line.f_code.co_filename,
        line.f_lineno,
        _module(line),
        line.f_globals.setdefault("__warningregistry__", {}),
    )


def listed(names: Sequence[str], most: int = 8) -> str:
    """The first few names, and how many more there are."""
    more = len(names) - most
    return ", ".join(names[:most]) + (f" and {more} more" if more > 0 else "")


def _users_line() -> FrameType:
    """The frame that called the outermost frame of the package, or that itself if nothing did."""
    frame: FrameType | None = sys._getframe(1)
    outermost = frame
    while frame is not None:
        if _is_ours(frame):
            outermost = frame
        frame = frame.f_back
    assert outermost is not None
    line = outermost.f_back or outermost
    while _module(line) == "dataclasses" and line.f_back is not None:  # its `replace`
        line = line.f_back
    return line


def _is_ours(frame: FrameType) -> bool:
    return _module(frame).partition(".")[0] == _PACKAGE


def _module(frame: FrameType) -> str:
    return str(frame.f_globals.get("__name__", ""))
