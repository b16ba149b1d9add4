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
COMPLETE = (  # rooms whose public calls say all that they should, and whose examples run
    "attitude", "dynamics", "engine", "ensembles", "flight", "flight.behaviours",
    "history", "model", "motion", "planning", "rigid", "spec", "stability", "thesis", "view",
)  # fmt: skip
FOR_USERS = ("attitude", "rigid", "stability")  # in which every call needs an example
EXEMPLARY = sorted(
    ".".join(("somersault", *path.relative_to(SOURCE).with_suffix("").parts))
    for path in SOURCE.rglob("*.py")
    if path.relative_to(SOURCE).parts[0].removesuffix(".py") in COMPLETE
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
    for name in getattr(room, "__all__", vars(room)):
        value = getattr(room, name)
        here = (getattr(value, "__module__", None) or "").startswith(room.__name__)
        if here and callable(value) and not name.startswith("_"):
            yield name, value


def for_users(room: str, name: str, method: str | None = None) -> bool:
    """Whether users call it, and not other rooms alone.

    They call what the package exports, but for methods that subclasses define anew: those are
    what whoever writes such a class has to know.
    """
    if room in FOR_USERS:
        return True
    cls = getattr(importlib.import_module(f"somersault.{room}"), name)
    redefined = method is not None and any(method in vars(sub) for sub in descendants(cls))
    return name in somersault.__all__ and not redefined


def descendants(cls: type) -> Iterator[type]:
    for sub in cls.__subclasses__():
        yield sub
        yield from descendants(sub)


def members(cls: type) -> dict[str, Any]:
    """What a class has of the package's, inherited or not."""
    ours = [one for one in cls.__mro__ if one.__module__.startswith("somersault.")]
    return {name: value for one in reversed(ours) for name, value in vars(one).items()}


def calls(room: str) -> Iterator[tuple[str, Any, bool]]:
    """Public functions and classes, the methods of the classes, and whether users call them."""
    for name, value in public(importlib.import_module(f"somersault.{room}")):
        yield f"{room}.{name}", value, for_users(room, name)
        if inspect.isclass(value):
            for method, function in members(value).items():
                bound = isinstance(function, classmethod | staticmethod)
                if not method.startswith("_") and (bound or inspect.isfunction(function)):
                    yield f"{room}.{name}.{method}", function, for_users(room, name, method)


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
    ("call", "users"),
    [pytest.param(call, users, id=name) for room in COMPLETE for name, call, users in calls(room)],
)
def test_a_docstring_says_what_goes_in_and_what_comes_out(call: Any, users: bool) -> None:
    there, function = sections(call), function_of(call)
    assert there["summary"].strip()
    if inspect.isclass(function):
        return
    signature = inspect.signature(function)
    parameters = [name for name in signature.parameters if name not in ("self", "cls")]
    assert set(parameters) <= documented(there.get("Parameters", ""))
    if signature.return_annotation not in ("None", None):
        assert there.get("Returns", "").strip() or there.get("Yields", "").strip()
    if "raise SomersaultError" in inspect.getsource(inspect.unwrap(function)):
        assert there.get("Raises", "").strip()
    if parameters and users:
        assert there.get("Examples", "").strip()
