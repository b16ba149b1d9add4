"""What users give, of the kind that was meant, or one sentence."""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Iterable, Mapping
from itertools import takewhile
from pathlib import Path
from typing import Any, TypeVar

from somersault._core.errors import SomersaultError

T = TypeVar("T")
_SHOWN = 200  # characters of a mistaken value


def shown(value: Any) -> str:
    """A mistaken value in a line that can be read."""
    try:
        text = " ".join(repr(value).split())
    except Exception:  # an integer of more digits than Python writes; a repr that is not ours
        text = _unwritten(value)
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]} …"


def _unwritten(value: Any) -> str:
    if isinstance(value, int):
        return f"a whole number of about {value.bit_length() * math.log10(2):,.0f} digits"
    return f"a {type(value).__name__} that cannot be shown"


def one_of(what: str, value: Any, there: Iterable[str]) -> str:
    """One of some words; SomersaultError naming `what`, with those there are."""
    words = tuple(there)
    if not isinstance(value, str) or value not in words:
        raise SomersaultError(f"{what} is {shown(value)}; give {' or '.join(map(repr, words))}")
    return value


def truth(what: str, value: Any) -> bool:
    """True or false; SomersaultError naming `what` for anything that merely counts as one."""
    import numpy as np  # only where it is wanted: much is asked for without any numerics

    if not isinstance(value, bool | np.bool_):
        raise SomersaultError(f"{what} must be true or false, and is {shown(value)}")
    return bool(value)


def text(what: str, value: Any) -> str:
    """A text; SomersaultError naming `what`."""
    if not isinstance(value, str):
        raise SomersaultError(f"{what} must be a text, and is {shown(value)}")
    return value


def file_path(what: str, value: Any) -> Path:
    """A path; SomersaultError naming `what` for what can be none."""
    try:
        name = os.fspath(value)
    except TypeError:
        name = ""
    if not isinstance(name, str) or "\0" in name or not name:
        raise SomersaultError(f"{what} must be the path of a file, and is {shown(value)}")
    return Path(name)


def whole_number(what: str, value: Any, least: int, most: int) -> int:
    """A whole number within bounds; SomersaultError naming `what`."""
    import numpy as np

    right = isinstance(value, int | np.integer) and not isinstance(value, bool)
    if not right or not least <= value <= most:
        raise SomersaultError(
            f"{what} must be a whole number from {least} to {most}, and is {shown(value)}"
        )
    return int(value)


def by_name(what: str, value: Any) -> dict[str, Any]:
    """Values by name, none for None; SomersaultError naming `what` for what is no mapping."""
    if value is None:
        return {}
    if not isinstance(value, Mapping) or not all(isinstance(name, str) for name in value):
        raise SomersaultError(f"{what} must be given by name, {{'name': …}}, and is {shown(value)}")
    return dict(value)


def name_list(what: str, value: Any) -> tuple[str, ...]:
    """A row of names; SomersaultError naming `what`, for one text too."""
    try:
        row = (None,) if isinstance(value, str) else tuple(value)
    except TypeError:
        row = (None,)
    if not all(isinstance(name, str) for name in row):
        raise SomersaultError(f"{what} must be a list of names, and is {shown(value)}")
    return row


def list_of(what: str, value: Any, kind: type[T]) -> list[T]:
    """Values of some class; SomersaultError naming `what`, for one of them alone too."""
    try:
        things = list(value)
    except TypeError:
        things = [None]
    if not all(isinstance(thing, kind) for thing in things):
        raise SomersaultError(
            f"{what} must be a list of {_public_name(kind)}, and is {shown(value)}"
        )
    return things


def instance(what: str, value: Any, kind: type[T]) -> T:
    """A value of some class; SomersaultError naming `what` and how such are called."""
    if not isinstance(value, kind):
        raise SomersaultError(f"{what} must be a {_public_name(kind)}, and is {shown(value)}")
    return value


def _public_name(kind: type) -> str:
    """By which users know a class of ours: that of the package, or of a room in it."""
    package, *rooms = kind.__module__.split(".")
    if kind.__name__ in getattr(sys.modules[package], "__all__", ()):
        return f"{package}.{kind.__name__}"
    public = takewhile(lambda room: not room.startswith("_"), rooms)
    return ".".join([package, *public, kind.__name__])
