"""Docstrings of public calls: their sections, the arguments they name, and examples that run.

A room joins by being listed here; nothing else needs to be written.
"""

from __future__ import annotations

import doctest
import importlib
import inspect
import re
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import somersault

SOURCE = Path(somersault.__file__).parent
ROOMS = (  # whose examples run
    "attitude", "dynamics", "engine", "ensembles", "flight", "history", "model", "motion", "rigid",
    "stability", "thesis", "view",
)  # fmt: skip
COMPLETE = ("attitude", "rigid", "stability")  # whose public calls say all that they should
EXEMPLARY = sorted(
    ".".join(("somersault", *path.relative_to(SOURCE).with_suffix("").parts))
    for path in SOURCE.rglob("*.py")
    if path.relative_to(SOURCE).parts[0].removesuffix(".py") in ROOMS
    and ">>> " in path.read_text(encoding="utf-8")
)
_SECTION = re.compile(r"^(\w[\w ]*)\n-{3,}$", re.MULTILINE)


@pytest.mark.parametrize("name", EXEMPLARY)
def test_examples_hold(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", somersault.SomersaultWarning)
        result = doctest.testmod(importlib.import_module(name), optionflags=doctest.ELLIPSIS)
    assert result.attempted
    assert not result.failed


def public(room: ModuleType) -> Iterator[tuple[str, Any]]:
    """The public names of a room that it defines, or that its own modules do."""
    for name in room.__all__:
        value = getattr(room, name)
        if getattr(value, "__module__", "").startswith(room.__name__) and callable(value):
            yield name, value


def calls(room: str) -> Iterator[tuple[str, Any]]:
    """Public functions and classes, and the methods of the classes that are called."""
    for name, value in public(importlib.import_module(f"somersault.{room}")):
        yield f"{room}.{name}", value
        if inspect.isclass(value):
            for method, function in vars(value).items():
                bound = isinstance(function, classmethod | staticmethod)
                if not method.startswith("_") and (bound or inspect.isfunction(function)):
                    yield f"{room}.{name}.{method}", function


def function_of(call: Any) -> Callable[..., Any]:
    return call.__func__ if isinstance(call, classmethod | staticmethod) else call


def sections(call: Any) -> dict[str, str]:
    """The sections of a docstring by their names."""
    pieces = _SECTION.split(inspect.getdoc(function_of(call)) or "")
    return {"summary": pieces[0], **dict(zip(pieces[1::2], pieces[2::2], strict=True))}


def documented(section: str) -> set[str]:
    """Names that a section of arguments explains."""
    heads = [line for line in section.splitlines() if line and not line[0].isspace()]
    return {name.strip().lstrip("*") for head in heads for name in head.split(" : ")[0].split(",")}


@pytest.mark.parametrize(
    "call", [pytest.param(call, id=name) for room in COMPLETE for name, call in calls(room)]
)
def test_a_docstring_says_what_goes_in_and_what_comes_out(call: Any) -> None:
    there, function = sections(call), function_of(call)
    assert there["summary"].strip()
    if inspect.isclass(function):
        return
    parameters = [n for n in inspect.signature(function).parameters if n not in ("self", "cls")]
    assert set(parameters) <= documented(there.get("Parameters", ""))
    assert there.get("Returns", "").strip()
    if parameters:
        assert there.get("Examples", "").strip()
