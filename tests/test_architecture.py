"""The rooms import in one direction, start quickly, and stay small."""

import ast
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

import somersault

SOURCE = Path(somersault.__file__).parent
ROOMS = [
    "_core", "spec", "attitude", "simulation", "rigid", "model", "engine", "laws", "dynamics",
    "motion", "history", "stability", "view", "flight", "planning", "ground", "robot", "ensembles",
    "designs", "thesis", "cli",
]  # fmt: skip
MOST_LINES = 400


def modules() -> list[Path]:
    return sorted(SOURCE.rglob("*.py"))


def imported_rooms(path: Path) -> set[str]:
    """Rooms that a file imports from, type-checking imports included."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        names = []
        if isinstance(node, ast.ImportFrom) and node.module:
            names = [node.module]
            if node.module == "somersault":
                names = [f"somersault.{alias.name}" for alias in node.names]
        elif isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        found |= {n.split(".")[1] for n in names if n.startswith("somersault.")}
    return found


@pytest.mark.parametrize("path", modules(), ids=lambda p: str(p.relative_to(SOURCE)))
def test_imports_go_one_way(path: Path) -> None:
    room = path.relative_to(SOURCE).parts[0].removesuffix(".py")
    if room in ("__init__", "__main__"):
        return
    allowed = {"__version__"}
    if room in ROOMS:
        allowed |= set(ROOMS[: ROOMS.index(room) + 1])
    assert imported_rooms(path) <= allowed


@pytest.mark.parametrize("path", modules(), ids=lambda p: str(p.relative_to(SOURCE)))
def test_a_file_holds_one_idea(path: Path) -> None:
    assert len(path.read_text(encoding="utf-8").splitlines()) <= MOST_LINES


def name_of(path: Path) -> str:
    """A module's dotted name, without the package's."""
    parts = path.relative_to(SOURCE).with_suffix("").parts
    return ".".join(parts).removesuffix(".__init__")


@cache
def graph() -> dict[str, frozenset[str]]:
    """For each module the modules that it imports, wherever in its text, for types too."""
    names = {name_of(path): path for path in modules()}
    found = {}
    for name, path in names.items():
        imported = set()
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("somersault."):
                module = (node.module or "").removeprefix("somersault.")
                inner = {f"{module}.{alias.name}" for alias in node.names}
                imported |= (inner & set(names)) or {module}
        found[name] = frozenset(imported - {name})
    return found


def test_no_import_goes_in_a_circle() -> None:
    waiting = {name: set(imported) & set(graph()) for name, imported in graph().items()}
    while done := {name for name, left in waiting.items() if not left}:
        waiting = {name: left - done for name, left in waiting.items() if name not in done}
    assert not waiting


@pytest.mark.parametrize("name", sorted(graph()))
def test_no_room_looks_into_another(name: str) -> None:
    """Rooms offer what others need of them; only `_core` has no door."""
    room = name.partition(".")[0]
    for imported in graph()[name]:
        other, _, inside = imported.partition(".")
        private = any(part.startswith("_") for part in inside.split("."))
        assert other in (room, "_core") or not private, imported


def loaded_by(code: str) -> set[str]:
    """Top-level packages in memory after running some code in a fresh interpreter."""
    script = f"import sys\n{code}\nprint(*{{n.split('.')[0] for n in sys.modules}})"
    run = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, encoding="utf-8", check=True
    )
    return set(run.stdout.split())


def test_starting_loads_no_numerics() -> None:
    loaded = loaded_by("import somersault, somersault.cli; somersault.cli._parser().format_help()")
    assert not loaded & {"numpy", "casadi", "mujoco", "xarray", "matplotlib", "llvmlite", "rich"}


def test_a_verdict_loads_no_pictures_or_tables() -> None:
    loaded = loaded_by("import somersault as so; so.spin('furrer').linear().stable")
    assert not loaded & {"xarray", "matplotlib", "pandas", "scipy", "sympy"}


def test_public_names_exist() -> None:
    for name in somersault.__all__:
        assert getattr(somersault, name) is not None
    with pytest.raises(AttributeError, match="nothing_of_the_kind"):
        _ = somersault.nothing_of_the_kind
