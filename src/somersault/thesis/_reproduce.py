"""Run the entries, and write their pictures, the claims and the report."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from somersault._core.checks import truth
from somersault._core.errors import SomersaultError
from somersault._core.files import temporary_folder, write
from somersault._core.interrupts import unbroken
from somersault._core.places import check_folder
from somersault._core.stages import stage
from somersault.thesis._claims import Claim
from somersault.thesis._entries import Entry, Result, Table, select
from somersault.thesis._errata import ERRATA
from somersault.thesis._motion import write_motion
from somersault.thesis._page import ChapterPage, Section, chapter_page, index_page
from somersault.thesis._registry import CHAPTERS, ENTRIES


def reproduce(
    ids: Iterable[str] | None,
    out: Path | str,
    progress: bool = True,
    entries: Sequence[Entry] = ENTRIES,
) -> list[Claim]:
    """Regenerate what the thesis shows, and check what it says.

    Writes figures/ID.svg and .png, data/ID.csv with the numbers that they show, tables/ID.csv, of
    what moves films/ID.mp4 and pages/ID.html, claims.json, a page for each chapter and index.html,
    all at the end or none. Films need PyAV; without it there are stills.

    Parameters
    ----------
    ids : iterable of str, or None
        Chapters ("ch4") and entries ("fig4-9", "table4-3"); None means everything.
    out : path
        A folder; it is made if it is not there.
    progress : bool
        Whether a bar on standard error shows what is being done.
    entries : sequence of Entry
        What there is to reproduce; everything unless given.

    Returns
    -------
    list of Claim
        All that was checked, as in claims.json.

    Raises
    ------
    SomersaultError
        For an ID that is not there, and for a place that cannot be written to.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from somersault.thesis import reproduce
    >>> with TemporaryDirectory() as folder:
    ...     claims = reproduce(["table4-1"], folder, progress=False)
    >>> len(claims), all(claim.holds for claim in claims)
    (16, True)
    """
    chosen = select(ids, entries)
    out = check_folder(out)
    truth("progress", progress)
    try:
        out.mkdir(parents=True, exist_ok=True)
        with temporary_folder(out) as folder:
            claims = _written(chosen, folder, progress)
            with unbroken():
                _published(folder, out)
    except OSError as error:
        raise SomersaultError(
            f"the report cannot be written to {out}: {error.strerror or error}; choose another "
            "directory"
        ) from error
    return claims


def _written(chosen: Sequence[Entry], folder: Path, progress: bool) -> list[Claim]:
    """Write everything to a folder that nobody sees before it is complete."""
    from somersault.view import style as look

    sections: dict[str, list[Section]] = {}
    claims: list[Claim] = []
    for entry in _watched(chosen, progress):
        with look.style():
            result = entry.make()
            section = _section(entry, result, folder)
        claims += result.claims
        sections.setdefault(entry.chapter, []).append(section)
    records = [claim.record() for claim in claims]
    write(folder / "claims.json", json.dumps(records, indent=1, ensure_ascii=False) + "\n")
    titles = {chapter.id: chapter.title for chapter in CHAPTERS}
    pages = [ChapterPage(id, titles[id], parts) for id, parts in sections.items()]
    for page in pages:
        write(folder / f"{page.id}.html", chapter_page(page))
    errata = [(e.where, e.printed, e.correct, e.why) for e in ERRATA]
    write(folder / "index.html", index_page(pages, errata))
    return claims


def _published(whole: Path, out: Path) -> None:
    """Rename every finished file into place, pictures before the pages that show them."""
    for file in sorted(whole.rglob("*"), key=lambda f: (f.parent == whole, f.name)):
        if file.is_file():
            target = out / file.relative_to(whole)
            target.parent.mkdir(exist_ok=True)
            file.replace(target)


def _watched(entries: Sequence[Entry], progress: bool) -> Iterable[Entry]:
    """The entries, with a bar on standard error that names each as it runs."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn
    from rich.progress import TimeElapsedColumn as Elapsed

    columns = TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), Elapsed()
    with stage(""), Progress(*columns, console=Console(stderr=True), disable=not progress) as bar:
        task = bar.add_task("starting", total=len(entries))
        for entry in entries:
            bar.update(task, description=entry.title)
            yield entry
            bar.advance(task)
        bar.update(task, description="done")


def _save(figure: Any, stem: Path) -> None:
    """SVG and PNG files that come out the same, byte for byte, every time."""
    from somersault.view import style as look

    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # laid out once, and the same in both files
    for ending in ("svg", "png"):
        write(stem.with_name(f"{stem.name}.{ending}"), look.saved(figure, ending))


def _csv(table: Table) -> str:
    """A table's rows under its header."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([table.header, *table.rows])
    return text.getvalue()


def _section(entry: Entry, result: Result, folder: Path) -> Section:
    """Write what belongs to one entry; say where it is."""
    from somersault.thesis._drawn import drawn

    numbers, table = None, result.table
    if result.figure is not None:
        _save(result.figure, folder / "figures" / entry.id)
        numbers = drawn(result.figure)
    if numbers is not None:
        write(folder / "data" / f"{entry.id}.csv", numbers)
    if table is not None:
        write(folder / "tables" / f"{entry.id}.csv", _csv(table))
    motion = result.motion
    return Section(
        entry.id,
        entry.title,
        result.says,
        result.ours,
        None if result.figure is None else f"figures/{entry.id}",
        [claim.record() for claim in result.claims],
        None if table is None else (table.header, table.rows),
        None if table is None else f"tables/{entry.id}.csv",
        None if numbers is None else f"data/{entry.id}.csv",
        None if motion is None else write_motion(motion, entry.id, entry.title, folder),
        entry.beyond,
    )
