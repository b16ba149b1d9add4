"""What keys of a SPEC may hold, and one sentence where they do not."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from somersault._core.checks import shown
from somersault._core.errors import SomersaultError

NUMBER, NUMBERS, TEXT, TEXTS, YES, TABLE = (
    "a number",
    "a list of numbers",
    "a text",
    "a list of texts",
    "true or false",
    "a table",
)
WHOLE = "a whole number"
EITHER = "a number, or three for a ball"
BODY_AXES = "1, 2 and 3 in some order (the body's axes of somersault, tilt and twist)"


def check_keys(where: str, given: Mapping[str, Any], known: Mapping[str, str]) -> None:
    """SomersaultError unless every key is known and every value of its kind."""
    for key, value in given.items():
        if key not in known:
            raise SomersaultError(
                f"{where}{key} is no key of a SPEC; here it takes {', '.join(known)}"
            )
        if not _fits(value, known[key]):
            raise SomersaultError(f"{where}{key} must be {known[key]}, and is {shown(value)}")


def _fits(value: Any, kind: str) -> bool:
    if kind == TEXT:
        return isinstance(value, str)
    if kind == YES:
        return isinstance(value, bool)
    if kind == TABLE:
        return isinstance(value, Mapping)
    if kind == BODY_AXES:
        whole = isinstance(value, list) and all(type(item) is int for item in value)
        return whole and sorted(value) == [1, 2, 3]
    if kind == EITHER:
        return _fits(value, NUMBER) or _fits(value, NUMBERS)
    if kind in (NUMBERS, TEXTS):
        one = NUMBER if kind == NUMBERS else TEXT
        return isinstance(value, list) and all(_fits(item, one) for item in value)
    if not isinstance(value, int | float) or isinstance(value, bool):
        return False
    return kind == NUMBER or float(value).is_integer()
