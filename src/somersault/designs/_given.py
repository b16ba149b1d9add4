"""Candidates that differ in numbers of the same simulations."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from somersault._core.array import Array
from somersault.designs._source import Group, Source


@dataclass(frozen=True, eq=False)
class Given(Source):
    """Simulations that were given: all candidates are run together."""

    @property
    def specification(self) -> Mapping[str, Any]:
        return {}

    def candidates(self, table: Array) -> list[Group]:
        return [self.group(self.cases, table)]

    def of(self, what: Any) -> Source:
        return replace(self, cases=self.read(what))
