"""Candidates that a function makes of what is chosen."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from somersault._core.array import Array
from somersault._core.checks import shown
from somersault._core.errors import SomersaultError
from somersault.designs._choose import Choose
from somersault.designs._source import Group, Source


@dataclass(frozen=True, eq=False)
class Made(Source):
    """Simulations of what `function` makes for each candidate, of all that moves no number by
    itself."""

    function: Callable[..., Any]

    @property
    def specification(self) -> Mapping[str, Any]:
        return {"made_by": getattr(self.function, "__qualname__", type(self.function).__name__)}

    def candidates(self, table: Array) -> list[Group]:
        return [self._made(row) for row in table]

    def _made(self, row: Array) -> Group:
        try:
            cases = self.read(self.function(**arguments(self.chosen, row)))
        except SomersaultError:
            return Group(1, ())
        return self.group(cases, row[None])

    def of(self, what: Any) -> Source:
        if not callable(what):
            raise SomersaultError(
                f"{shown(what)} is no function, and a function makes this design's candidates; "
                "give another of what is chosen"
            )
        check_arguments(what, self.chosen)
        return replace(self, function=what)


def arguments(chosen: Mapping[str, Choose], row: Array) -> dict[str, float]:
    """What the function is given for a candidate."""
    values = zip(chosen.items(), row.tolist(), strict=True)
    return {name: value for (name, one), value in values if not one.moves}


def check_arguments(function: Callable[..., Any], chosen: Mapping[str, Choose]) -> None:
    """SomersaultError unless a function takes what is chosen and moves no number."""
    given = [name for name, one in chosen.items() if not one.moves]
    try:
        inspect.signature(function).bind(**dict.fromkeys(given, 0.0))
    except TypeError as mistake:
        raise SomersaultError(
            f"the function that makes candidates cannot be called with what is chosen and moves "
            f"no number ({', '.join(given)}): {mistake}"
        ) from None
