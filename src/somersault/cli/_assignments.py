"""NAME=NUMBER arguments."""

from __future__ import annotations

import math
from collections.abc import Iterable

from somersault._core.errors import SomersaultError


def assignments(
    option: str, items: Iterable[str], what: str = "JOINT", example: str = "shoulder=1.3"
) -> dict[str, float]:
    """{"shoulder": 1.3} of ["shoulder=1.3"]; SomersaultError for anything else."""
    result: dict[str, float] = {}
    for item in items:
        name, equals, text = item.rpartition("=")
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not equals or not name or not math.isfinite(value):
            raise SomersaultError(
                f"{option} takes {what}=NUMBER, and {item!r} is not that; write for example "
                f"{option} {example}"
            )
        if name in result:
            raise SomersaultError(f"{option} gives {name!r} twice; give it once")
        result[name] = value
    return result
