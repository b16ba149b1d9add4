"""What an entry of the reproduction is, which chapter it stands in, and which ones an ID means."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING

from somersault._core.checks import list_of, name_list
from somersault._core.errors import SomersaultError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from somersault.thesis._claims import Claim
    from somersault.thesis._motion import Motion


@dataclass(frozen=True)
class Table:
    """Rows of short texts under a header.

    Attributes
    ----------
    header : tuple of str
    rows : tuple of tuple of str
        Each as long as the header.
    """

    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Result:
    """What one entry of the reproduction gives.

    Attributes
    ----------
    says : str
        What the thesis says or shows.
    ours : str
        What the computation gives.
    claims : tuple of Claim
        What was checked.
    figure : matplotlib.figure.Figure or None
        The picture.
    table : Table or None
    motion : Motion or None
        What moves, to be filmed.
    """

    says: str
    ours: str
    claims: tuple[Claim, ...] = ()
    figure: Figure | None = None
    table: Table | None = None
    motion: Motion | None = None


@dataclass(frozen=True)
class Deferred:
    """A function that is imported when it is called, so that a list of entries costs nothing."""

    module: str
    function: str

    def __call__(self) -> Result:
        result: Result = getattr(import_module(self.module), self.function)()
        return result


@dataclass(frozen=True)
class Entry:
    """One figure, table or section that can be reproduced.

    Attributes
    ----------
    id : str
        "fig4-9": what `somersault reproduce` calls it.
    title : str
    chapter : str
        "ch4".
    make : callable
        Computes its `Result`.
    beyond : bool
        Whether the thesis does not contain it.
    """

    id: str
    title: str
    chapter: str
    make: Callable[[], Result]
    beyond: bool = False

    @classmethod
    def of(cls, package: str, id: str, title: str, source: str, beyond: bool = False) -> Entry:
        """An entry whose function stands in a chapter's folder.

        Parameters
        ----------
        package : str
            The folder's `__name__`.
        id, title : str
            As in `Entry`.
        source : str
            "module.function", within the folder. The function takes nothing and returns a `Result`.
        beyond : bool
            Whether the thesis does not contain it.

        Returns
        -------
        Entry
        """
        module, _, function = source.rpartition(".")
        chapter = package.rpartition(".")[2]
        return cls(id, title, chapter, Deferred(f"{package}.{module}", function), beyond)


@dataclass(frozen=True)
class Chapter:
    """A chapter's entries, in the order of the thesis."""

    id: str
    title: str
    entries: tuple[Entry, ...]


def select(ids: Iterable[str] | None, entries: Sequence[Entry]) -> list[Entry]:
    """The entries that IDs name, in their own order: chapters ("ch4") or entries ("fig4-9")."""
    wanted = [ids] if isinstance(ids, str) else [*name_list("ids", () if ids is None else ids)]
    list_of("entries", entries, Entry)
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
