"""Candidates that a function makes of what is chosen."""

from __future__ import annotations

import hashlib
import inspect
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import shown
from somersault._core.errors import SomersaultError
from somersault.designs._choose import Choose, table_of
from somersault.designs._source import Group, Misfit, Source
from somersault.simulation import Simulation

_GOLDEN = 0.5 * (5**0.5 - 1)  # whose multiples, without the whole numbers, are all over 0 to 1


@dataclass(frozen=True, eq=False)
class Made(Source):
    """Simulations of what `function` makes for each candidate, of all that moves no number by
    itself."""

    function: Callable[..., Any]

    @property
    def specification(self) -> Mapping[str, Any]:
        """What the function makes at two points: functions are told apart by what they do."""
        chosen = np.arange(1, len(self.chosen) + 1)
        parts = np.stack([_GOLDEN * chosen % 1, 1 - _GOLDEN * chosen % 1])
        made = [self._cases(row) for row in table_of(self.chosen, parts)]
        plain = json.dumps([[case.specification for case in cases] for cases in made])
        return {"made": hashlib.sha256(plain.encode()).hexdigest()}

    def candidates(self, table: Array) -> list[Group]:
        return [self._made(row) for row in table]

    def _made(self, row: Array) -> Group:
        cases = self._cases(row)
        return self.group(cases, row[None]) if cases else Group(1, ())

    def _cases(self, row: Array) -> tuple[Simulation, ...]:
        """What the function makes for a candidate; nothing where it says that it cannot be."""
        try:
            return self.read(self.function(**arguments(self.chosen, row)))
        except Misfit:
            raise
        except SomersaultError:
            return ()

    def of(self, what: Any) -> Source:
        if not callable(what):
            raise SomersaultError(
                f"{shown(what)} is no function, and a function makes this design's candidates; "
                "give another of what is chosen"
            )
        check_arguments(what, self.chosen)
        begins = np.array([[one.begins for one in self.chosen.values()]])
        begin = arguments(self.chosen, table_of(self.chosen, begins)[0])
        return replace(self, function=what, cases=self.read(what(**begin)))


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
