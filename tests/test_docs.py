"""The code in the documentation runs, in the order in which it stands."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from types import ModuleType

import pytest

import somersault

DOCS = Path(__file__).parents[1] / "docs"
QUICK = ("extending", "flight", "models", "motions", "maneuvers", "doll")
SLOW = ("ensembles", "seeing", "stability", "twisting")
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
