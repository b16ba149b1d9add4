"""Examples in docstrings do what they say."""

from __future__ import annotations

import doctest
import importlib
from pathlib import Path

import pytest

import somersault

SOURCE = Path(somersault.__file__).parent
ROOMS = ("model", "history", "view")
EXEMPLARY = sorted(
    ".".join(("somersault", *path.relative_to(SOURCE).with_suffix("").parts))
    for path in SOURCE.rglob("*.py")
    if path.relative_to(SOURCE).parts[0].removesuffix(".py") in ROOMS
    and ">>> " in path.read_text(encoding="utf-8")
)


@pytest.mark.parametrize("name", EXEMPLARY)
def test_examples_hold(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    result = doctest.testmod(importlib.import_module(name), optionflags=doctest.ELLIPSIS)
    assert result.attempted
    assert not result.failed
