"""What an entry of the reproduction is, and which entries an ID means."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from somersault._core.errors import SomersaultError
from somersault.thesis._claims import Claim

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Table:
    """Rows of short texts under a header."""

    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Result:
    """What one entry gives: the thesis's statement, what was found, picture, table, claims."""

    says: str
    found: str
    claims: tuple[Claim, ...] = ()
    figure: Figure | None = None
    table: Table | None = None


@dataclass(frozen=True)
class Entry:
    """One figure, table or section; `beyond` marks what the thesis does not contain."""

    id: str
    title: str
    chapter: str
    make: Callable[[], Result]
    beyond: bool = False


def select(ids: Iterable[str] | None, entries: Sequence[Entry]) -> list[Entry]:
    """The entries that IDs name, in their own order: chapters ("ch4") or entries ("fig4-9")."""
    wanted = [ids] if isinstance(ids, str) else list(ids or [])
    if not wanted:
        return list(entries)
    chapters = list(dict.fromkeys(entry.chapter for entry in entries))
    names = [entry.id for entry in entries]
    for name in wanted:
        if name not in chapters and name not in names:
            raise SomersaultError(
                f"there is nothing called {name!r} to reproduce; there are "
                f"{', '.join(chapters)} and {', '.join(names)}"
            )
    return [entry for entry in entries if entry.id in wanted or entry.chapter in wanted]
