"""Which of many alike cases every run has; the others are slow."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest
from _pytest.mark import ParameterSet


def every(cases: Iterable[Any], one_in: int) -> list[Any]:
    """The cases, of which all but one in so many are marked slow."""
    return [case if k % one_in == 0 else _slow(case) for k, case in enumerate(cases)]


def _slow(case: Any) -> ParameterSet:
    if isinstance(case, ParameterSet):
        return case._replace(marks=[*case.marks, pytest.mark.slow])
    return pytest.param(case, marks=pytest.mark.slow)
