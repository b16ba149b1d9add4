"""The code in the documentation runs, in the order in which it stands."""

from __future__ import annotations

import re
import sys
from dataclasses import fields
from pathlib import Path
from types import ModuleType

import pytest

import somersault

DOCS = Path(__file__).parents[1] / "docs"
QUICK = (
    "extending",
    "flight",
    "models",
    "motions",
    "maneuvers",
    "doll",
    "laws",
    "design",
    "landings",
    "planning",
)
SLOW = ("ensembles", "robots", "seeing", "stability", "twisting")
RUN = (*QUICK, *(pytest.param(page, marks=pytest.mark.slow) for page in SLOW))
BLOCK = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("page", RUN)
def test_the_code_of_a_page_runs(
    page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "examples").symlink_to(DOCS.parent / "examples")
    monkeypatch.chdir(tmp_path)
    module = ModuleType(page)
    monkeypatch.setitem(sys.modules, page, module)
    blocks = BLOCK.findall((DOCS / f"{page}.md").read_text(encoding="utf-8"))
    assert blocks
    for number, block in enumerate(blocks, 1):
        exec(compile(block, f"{page}.md, block {number}", "exec"), module.__dict__)


def test_every_room_has_a_page_of_reference() -> None:
    pages = (DOCS / "reference").glob("*.md")
    shown = {line for page in pages for line in page.read_text(encoding="utf-8").splitlines()}
    rooms = [
        name for name in somersault.__all__ if isinstance(getattr(somersault, name), ModuleType)
    ]
    assert rooms
    for room in rooms:
        assert f"::: somersault.{room}" in shown


def test_every_key_of_a_spec_is_in_the_documentation() -> None:
    """As code: in backticks, or in a block."""
    from somersault.ensembles._spec import Reported, Sample, Spin, SpinKeys, Tables
    from somersault.flight._spec import Keys
    from somersault.flight._spec_motion import Compliance, OffNominal, Recording
    from somersault.flight.behaviours._registry import Registry
    from somersault.model import AthleteKeys

    text = "\n".join(page.read_text(encoding="utf-8") for page in DOCS.glob("*.md"))
    code = re.findall(r"```.*?```|`[^`\n]*`|^    .*$", text, re.DOTALL | re.MULTILINE)
    words = set(re.findall(r"\w+", " ".join(code)))
    ours = [kind for kind in Registry.classes.values() if kind.__module__.startswith("somersault.")]
    from somersault.designs._spec import Search
    from somersault.designs._spec import Tables as DesignTables
    from somersault.planning._spec import Asked

    designs = [DesignTables, Search, somersault.Choose, somersault.designs.Limit]
    designs += somersault.designs.Objective.kinds.values()
    tables = [
        *designs,
        Asked,
        Keys,
        Tables,
        Sample,
        Reported,
        Spin,
        SpinKeys,
        Recording,
        Compliance,
        OffNominal,
        AthleteKeys,
    ]
    for table in (*tables, somersault.Takeoff, somersault.Replay, somersault.Vary, *ours):
        keys = {field.name for field in fields(table) if field.init}
        assert keys <= words, (table.__name__, keys - words)
