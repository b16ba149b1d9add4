"""What answers a mistake fits where it was made: in a call, in a SPEC, or at the shell."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

import somersault as so

SOURCE = Path(so.__file__).parent
OF_ONE_PLACE = re.compile(r"--[a-z]|\bso\.\w|=True|=False|\bNone\b|\w='\w")
BOTH_ARE_NAMED = {"_scheduler.py"}  # the option, and what it is called in Python


def refusals(path: Path) -> list[str]:
    """The texts of what a module raises."""
    found = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Raise) and node.exc is not None:
            texts = [
                one.value
                for one in ast.walk(node.exc)
                if isinstance(one, ast.Constant) and isinstance(one.value, str)
            ]
            found.append("".join(texts))
    return found


def shared() -> list[Path]:
    return [path for path in sorted(SOURCE.rglob("*.py")) if path.parent.name != "cli"]


@pytest.mark.parametrize("path", shared(), ids=lambda p: str(p.relative_to(SOURCE)))
def test_no_advice_for_another_place(path: Path) -> None:
    """No options of a command where Python or a SPEC is read too, and no Python where TOML is."""
    for text in refusals(path):
        if path.name not in BOTH_ARE_NAMED:
            assert not OF_ONE_PLACE.search(text), text
