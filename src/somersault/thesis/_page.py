"""The pages of the reproduction: an overview, and one page for each chapter."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from html import escape
from importlib.resources import files

from somersault.thesis._claims import is_own
from somersault.thesis._motion import Written
from somersault.thesis._page_tables import COLUMNS, Record, claim_row, claims_table, printed, table
from somersault.view import style as look

_BOOK = "<cite>Passive Dynamics in the Control of Gymnastic Maneuvers</cite>"


@dataclass(frozen=True)
class Section:
    """One figure, table or section as a page shows it.

    Paths are from the page: `picture` without its ending, `drawn` of the numbers that it shows,
    `data` of the table's. `claims` are records of claims.json.
    """

    id: str
    title: str
    says: str
    ours: str
    picture: str | None
    claims: Sequence[Record]
    table: tuple[Sequence[str], Sequence[Sequence[str]]] | None = None
    data: str | None = None
    drawn: str | None = None
    motion: Written | None = None
    beyond: bool = False


@dataclass(frozen=True)
class ChapterPage:
    """A chapter with those of its sections that were reproduced."""

    id: str
    title: str
    sections: Sequence[Section]

    @property
    def claims(self) -> list[Record]:
        """Those of all its sections."""
        return [claim for section in self.sections for claim in section.claims]

    @property
    def name(self) -> str:
        """Its heading: number and title."""
        return f"{self.id.removeprefix('ch')}  {self.title}"


def index_page(chapters: Sequence[ChapterPage], errata: Iterable[Sequence[str]]) -> str:
    """The overview: how many claims agree, chapter by chapter, what moves, what differs, and all
    claims, to be searched."""
    claims = [claim for chapter in chapters for claim in chapter.claims]
    differ, missed = _failed(claims)
    sections = [section for chapter in chapters for section in chapter.sections]
    pictures = sum(section.picture is not None for section in sections)
    motions = sum(section.motion is not None for section in sections)
    header = f"""<p class="text">Figures, tables and statements of R. R. Playter, {_BOOK} (1994),
computed anew from the shipped models. Each claim compares what the thesis says with what the
computation gives, and whether the two agree is computed. Where the thesis says nothing, a claim is
an aim of our own. {verdict(len(claims), differ, missed)}</p>
<ul class="counts">
<li class="yes"><b>{len(claims) - differ - missed}</b>agree</li>
<li class="no"><b>{differ}</b>{_misprints(differ)}, explained</li>
<li class="no"><b>{missed}</b>{_aims(missed)} not met</li>
<li><b>{pictures}</b>{"picture" if pictures == 1 else "pictures"}</li>
<li><b>{motions}</b>{"motion" if motions == 1 else "motions"}</li>
</ul>"""
    moving = _gallery(chapters)
    links = [
        ("#chapters", "chapters"), *([("#motions", "motions")] if moving else []),
        ("#differences", "differences"), ("#errata", "errata"), ("#claims", "all claims"),
    ]  # fmt: skip
    apart = _tables(chapters, differing=True, notes=True)
    return _page(
        "The passive somersault, reproduced",
        header,
        links,
        f"""<h2 id="chapters">Chapters</h2>
{_overview(chapters)}
{moving}
<h2 id="differences">Misprints, differences, and aims not met</h2>
{claims_table(apart) if apart else "<p>Every claim agrees.</p>"}
<h2 id="errata">Errata of the thesis</h2>
<p class="text">Errors of the printed text, each shown by an independent calculation. The corrected
form is the one used here.</p>
{table(("where", "printed", "correct", "why"), errata)}
<h2 id="claims">All claims</h2>
<p>The same as data: <a href="claims.json">claims.json</a>.</p>
{_filter(chapters)}
{claims_table(_tables(chapters), "all-claims")}""",
        _asset("report.js"),
    )


def chapter_page(chapter: ChapterPage) -> str:
    """One chapter's figures and tables, with their claims."""
    links = [("index.html", "overview"), *((f"#{s.id}", s.id) for s in chapter.sections)]
    count = len(chapter.claims)
    return _page(
        chapter.name,
        f'<p class="text">Chapter {escape(chapter.id.removeprefix("ch"))} of R. R. Playter, '
        f"{_BOOK} (1994). {verdict(count, *_failed(chapter.claims))}</p>",
        links,
        "".join(_section(section) for section in chapter.sections),
    )


def verdict(count: int, differ: int, missed: int = 0) -> str:
    """How many claims agree, in a sentence.

    Parameters
    ----------
    count : int
        Claims that were checked.
    differ : int
        Those of the thesis that do not hold.
    missed : int
        Those of our own, where the thesis says nothing, that do not hold.

    Returns
    -------
    str

    Examples
    --------
    >>> from somersault.thesis import verdict
    >>> verdict(9, 0)
    '9 claims were checked, and all agree.'
    """
    if not count:
        return "Nothing here was checked."
    if not differ and not missed:
        return f"{count} claims were checked, and all agree."
    parts = []
    if differ:
        those = "is a misprint or differs, as" if differ == 1 else "are misprints or differ, each"
        parts.append(f"{differ} of the thesis's numbers {those} explained")
    if missed:
        verb = "is" if missed == 1 else "are"
        parts.append(f"{missed} {_aims(missed)} of the package's own {verb} not met")
    agree = count - differ - missed
    return f"{count} claims were checked: {agree} agree; {', and '.join(parts)}."


def _failed(claims: Iterable[Record]) -> tuple[int, int]:
    """How many claims of the thesis do not hold, and how many of our own."""
    own = [is_own(claim["thesis"]) for claim in claims if not claim["holds"]]
    return len(own) - sum(own), sum(own)


def _page(
    title: str, header: str, links: Iterable[tuple[str, str]], body: str, script: str = ""
) -> str:
    """A whole page; `links` are (target, words)."""
    items = "".join(f'<li><a href="{escape(to)}">{escape(words)}</a></li>' for to, words in links)
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="icon" href="data:,">
<title>{escape(title)}</title>
<style>{look.variables()}
{_asset("report.css")}</style>
</head>
<body>
<header>
<h1>{escape(title)}</h1>
{header}
</header>
<nav aria-label="Contents"><ul>{items}</ul></nav>
<main>
{body}
</main>
{f"<script>{script}</script>" if script else ""}
</body>
</html>
"""


@cache
def _asset(name: str) -> str:
    return (files("somersault.thesis") / "site" / name).read_text(encoding="utf-8")


# ---------------------------------------------------------------------------- the overview


def _overview(chapters: Sequence[ChapterPage]) -> str:
    """One row for each chapter: what was checked, what agrees, and its sections."""
    rows = []
    for chapter in chapters:
        count = len(chapter.claims)
        differ, missed = _failed(chapter.claims)
        parts = ", ".join(
            f'<a href="{escape(chapter.id)}.html#{escape(s.id)}">{escape(s.id)}</a>'
            for s in chapter.sections
        )
        rows.append(
            f'<tr><td><a href="{escape(chapter.id)}.html">{escape(chapter.name)}</a></td>'
            f'<td class="n">{count}</td><td class="n">{count - differ - missed}</td>'
            f'<td class="n">{differ}</td><td class="n">{missed}</td><td>{parts}</td></tr>'
        )
    return (
        '<div class="scroll"><table class="overview"><thead><tr><th>chapter</th>'
        '<th class="n">claims</th><th class="n">agree</th><th class="n">differ</th>'
        '<th class="n">aims not met</th>'
        "<th>figures, tables, sections</th></tr></thead>"
        f"<tbody>{''.join(rows)}</tbody></table></div>"
    )


def _gallery(chapters: Sequence[ChapterPage]) -> str:
    """Stills of everything that moves, each a link to where it is shown."""
    items = [
        f'<li><a href="{escape(chapter.id)}.html#{escape(section.id)}">'
        f'<img src="{escape(section.motion.still)}" alt="" loading="lazy">'
        f"<span>{escape(section.title)}</span></a></li>"
        for chapter in chapters
        for section in chapter.sections
        if section.motion is not None
    ]
    if not items:
        return ""
    return f'<h2 id="motions">Motions</h2>\n<ul class="gallery">{"".join(items)}</ul>'


def _filter(chapters: Sequence[ChapterPage]) -> str:
    """What the script reads; hidden where there is none."""
    choices = "".join(f'<option value="{escape(c.id)}">{escape(c.name)}</option>' for c in chapters)
    return (
        '<form id="filter" hidden><input type="search" name="words" placeholder="search: spring, '
        'fig4-9, §6.3 …" aria-label="words"><select name="chapter" aria-label="chapter">'
        f'<option value="">all chapters</option>{choices}</select>'
        '<select name="holds" aria-label="whether they agree"><option value="">all</option>'
        '<option value="yes">agree</option><option value="no">differ</option></select>'
        '<button type="reset">clear</button><output name="count"></output></form>'
    )


def _tables(chapters: Sequence[ChapterPage], differing: bool = False, notes: bool = False) -> str:
    """Claims chapter by chapter; their IDs are links to where they are explained."""
    parts = []
    for chapter in chapters:
        rows = "".join(
            claim_row(claim, notes, f"{chapter.id}.html#{claim['id']}")
            for claim in chapter.claims
            if not (differing and claim["holds"])
        )
        if rows:
            heading = f'<tr><th colspan="{len(COLUMNS)}">{escape(chapter.name)}</th></tr>'
            parts.append(f'<tbody data-chapter="{escape(chapter.id)}">{heading}{rows}</tbody>')
    return "".join(parts)


# ----------------------------------------------------------------------- figures and tables


def _section(section: Section) -> str:
    parts = [f'<section><h2 id="{escape(section.id)}">{escape(section.title)}</h2>']
    if section.beyond:
        parts.append('<p class="beyond">Beyond the thesis: not in its text or figures.</p>')
    who = "" if section.beyond else '<span class="who">Thesis:</span> '
    words = (
        f"<p>{who}{printed(section.says)}</p>"
        f'<p><span class="who">Here:</span> {printed(section.ours)}</p>'
    )
    made_by = f"<code>somersault reproduce {escape(section.id)}</code>"
    if section.picture is None:
        parts.append(f'<div class="text">{words}<p class="files">{made_by}</p></div>')
    else:
        name = section.picture
        links = _files((f"{name}.png", "PNG"), (f"{name}.svg", "SVG"), (section.drawn, "CSV"))
        parts.append(
            f'<figure><img src="{escape(name)}.svg" alt="{escape(section.title)}" loading="lazy">'
            f'<figcaption>{words}<p class="files">{links} · {made_by}</p></figcaption></figure>'
        )
    if section.motion is not None:
        parts.append(_motion(section.motion, section.title))
    if section.table is not None:
        parts.append(table(*section.table))
    if section.data is not None:
        parts.append(f'<p class="files"><a href="{escape(section.data)}">The table as CSV</a></p>')
    if section.claims:
        count = len(section.claims)
        differ, missed = _failed(section.claims)
        opened = "" if not differ + missed and count > 12 else " open"
        rows = "".join(claim_row(claim, True) for claim in section.claims)
        parts.append(
            f"<details{opened}><summary>{_agreement(count, differ, missed)}</summary>"
            f"{claims_table(f'<tbody>{rows}</tbody>')}</details>"
        )
    return "".join(parts) + "</section>\n"


def _motion(motion: Written, title: str) -> str:
    """The film, or a still where there is none, with its page and its numbers."""
    still, page = escape(motion.still), escape(motion.page)
    if motion.film is None:
        shown = f'<a href="{page}"><img src="{still}" alt="{escape(title)}" loading="lazy"></a>'
    else:
        shown = (
            f'<video src="{escape(motion.film)}" poster="{still}" controls loop muted playsinline '
            f'preload="none" aria-label="{escape(title)}"></video>'
        )
    who = "" if len(motion.names) < 2 else f"From left to right: {', '.join(motion.names)}. "
    slow = "" if motion.speed == 1 else f", at {motion.speed:.3g} times real speed"
    what = "A still" if motion.film is None else f"The film{slow}"
    links = _files((motion.film, "MP4"), (motion.still, "still"), (motion.data, "CSV"))
    return (
        f"<figure>{shown}<figcaption><p>{escape(who)}{what}; "
        f'<a href="{page}">the page</a> turns it, scrubs through it and shows its momentum sphere.'
        f'</p><p class="files">{links}</p></figcaption></figure>'
    )


def _files(*links: tuple[str | None, str]) -> str:
    """Links to those files that are there."""
    return " · ".join(f'<a href="{escape(to)}">{words}</a>' for to, words in links if to)


def _misprints(count: int) -> str:
    return "misprint or difference" if count == 1 else "misprints or differences"


def _aims(count: int) -> str:
    return "aim" if count == 1 else "aims"


def _agreement(count: int, differ: int, missed: int) -> str:
    if not differ and not missed:
        return "1 claim agrees" if count == 1 else f"All {count} claims agree"
    if count == 1:
        return "1 claim, which differs" if differ else "1 aim, which is not met"
    parts = [f"{differ} misprinted or different"] if differ else []
    parts += [f"{missed} {_aims(missed)} not met"] if missed else []
    return f"{count - differ - missed} of {count} claims agree; {', '.join(parts)}"
