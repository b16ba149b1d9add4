"""What users give, of the kind that was meant, or one sentence."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, TypeVar

import numpy as np

from somersault._core.errors import SomersaultError

T = TypeVar("T")
_SHOWN = 200  # characters of a mistaken value


def shown(value: Any) -> str:
    """A mistaken value in a line that can be read."""
    text = " ".join(repr(value).split())
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]} …"


def one_of(what: str, value: Any, there: Iterable[str]) -> str:
    """One of some words; SomersaultError naming `what`, with those there are."""
    words = tuple(there)
    if not isinstance(value, str) or value not in words:
        raise SomersaultError(f"{what} is {shown(value)}; give {' or '.join(map(repr, words))}")
    return value


def truth(what: str, value: Any) -> bool:
    """True or false; SomersaultError naming `what` for anything that merely counts as one."""
    if not isinstance(value, bool | np.bool_):
        raise SomersaultError(f"{what} must be true or false, and is {shown(value)}")
    return bool(value)


def text(what: str, value: Any) -> str:
    """A text; SomersaultError naming `what`."""
    if not isinstance(value, str):
        raise SomersaultError(f"{what} must be a text, and is {shown(value)}")
    return value


def whole_number(what: str, value: Any, least: int, most: int) -> int:
    """A whole number within bounds; SomersaultError naming `what`."""
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


def instance(what: str, value: Any, kind: type[T]) -> T:
    """A value of some class; SomersaultError naming `what` and how such are called."""
    if not isinstance(value, kind):
        raise SomersaultError(f"{what} must be a somersault.{kind.__name__}, and is {shown(value)}")
    return value
