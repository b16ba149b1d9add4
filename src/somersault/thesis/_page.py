"""The pages of the reproduction: an overview, and one page for each chapter."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

Record = Mapping[str, Any]
_BOOK = "<cite>Passive Dynamics in the Control of Gymnastic Maneuvers</cite>"


@dataclass(frozen=True)
class Section:
    """One figure, table or section as a page shows it.

    `picture` and `data` are paths from the page: the picture's without its ending, and that of the
    table's CSV file. `claims` are records of claims.json.
    """

    id: str
    title: str
    says: str
    ours: str
    picture: str | None
    claims: Sequence[Record]
    table: tuple[Sequence[str], Sequence[Sequence[str]]] | None = None
    data: str | None = None
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


_STYLE = """
:root { color-scheme: light dark; --ink: #1c1c1c; --paper: #ffffff; --soft: #f3f5f7;
  --line: #d5dae0; --quiet: #5a6470; --link: #0b5394; --good: #00694d; --bad: #a63e00; }
@media (prefers-color-scheme: dark) { :root { --ink: #e8e8e8; --paper: #16181b; --soft: #22262b;
  --line: #3a4149; --quiet: #a3adb8; --link: #7db8ef; --good: #45c9a0; --bad: #ff9a5c; } }
* { box-sizing: border-box; }
body { margin: 0; font: 16px/1.5 system-ui, sans-serif; color: var(--ink);
  background: var(--paper); }
main, header, nav { max-width: 62rem; margin: 0 auto; padding: 0 1.2rem; }
header { padding-top: 2rem; }
h1 { margin: 0 0 .3rem; font-size: 1.7rem; }
h2 { margin: 2.6rem 0 .6rem; padding-top: .6rem; border-top: 1px solid var(--line);
  font-size: 1.25rem; }
a { color: var(--link); }
nav ul { display: flex; flex-wrap: wrap; gap: .2rem .9rem; padding: 0; list-style: none;
  font-size: .9rem; }
.overview td.n, .overview th.n { text-align: right; }
.counts { display: flex; flex-wrap: wrap; gap: .8rem; margin: 1rem 0; padding: 0;
  list-style: none; }
.counts li { padding: .5rem 1rem; border-radius: .5rem; background: var(--soft); }
.counts b { font-size: 1.4rem; margin-right: .4rem; }
figure { margin: 1rem 0; }
figure img { display: block; max-width: 100%; height: auto; padding: .6rem; background: #ffffff;
  border: 1px solid var(--line); border-radius: .4rem; }
figcaption, .text { max-width: 48rem; }
.who { color: var(--quiet); font-weight: 600; }
.beyond { border-left: .3rem solid var(--bad); padding-left: .8rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; margin: .8rem 0; font-size: .88rem; width: 100%; }
th, td { padding: .3rem .6rem; text-align: left; vertical-align: top;
  border-bottom: 1px solid var(--line); overflow-wrap: anywhere; }
th { background: var(--soft); }
td.id { white-space: nowrap;
  font-family: ui-monospace, monospace; font-size: .8rem; color: var(--quiet); }
td.n { font-variant-numeric: tabular-nums; min-width: 5.2rem; }
th { white-space: nowrap; }
code { font-size: .9em; }
.yes { color: var(--good); font-weight: 700; white-space: nowrap; }
.no { color: var(--bad); font-weight: 700; white-space: nowrap; }
.note { color: var(--quiet); }
details summary { cursor: pointer; color: var(--link); }
@media print { details { display: block; } nav { display: none; } }
"""


def index_page(chapters: Sequence[ChapterPage], errata: Iterable[Sequence[str]]) -> str:
    """The overview: how many claims agree, chapter by chapter, what differs, and all claims."""
    claims = [claim for chapter in chapters for claim in chapter.claims]
    differ = [claim for claim in claims if not claim["holds"]]
    pictures = sum(s.picture is not None for chapter in chapters for s in chapter.sections)
    return _page(
        "The passive somersault, reproduced",
        f"""<p class="text">Figures, tables and statements of R. R. Playter, {_BOOK} (1994),
computed anew from the shipped models. Each claim compares what the thesis says with what the
computation gives, and whether the two agree is computed. {verdict(len(claims), len(differ))}</p>
<ul class="counts">
<li class="yes"><b>{len(claims) - len(differ)}</b>agree</li>
<li class="no"><b>{len(differ)}</b>misprints or differences, each explained</li>
<li><b>{pictures}</b>pictures</li>
</ul>""",
        [(f"{c.id}.html", c.name) for c in chapters]
        + [("#differences", "differences"), ("#errata", "errata"), ("#claims", "all claims")],
        f"""<h2 id="chapters">Chapters</h2>
{_overview(chapters)}
<h2 id="differences">Misprints and differences</h2>
{_claims(differ, notes=True) if differ else "<p>Every claim agrees.</p>"}
<h2 id="errata">Errata of the thesis</h2>
<p class="text">Errors of the printed text, each shown by an independent calculation. The corrected
form is the one used here.</p>
{_table(("where", "printed", "correct", "why"), errata)}
<h2 id="claims">All claims</h2>
<p>The same as data: <a href="claims.json">claims.json</a>.</p>
{_claims(claims, notes=False)}""",
    )


def chapter_page(chapter: ChapterPage) -> str:
    """One chapter's figures and tables, with their claims."""
    links = [("index.html", "overview"), *((f"#{s.id}", s.id) for s in chapter.sections)]
    differ = sum(not claim["holds"] for claim in chapter.claims)
    count = len(chapter.claims)
    return _page(
        chapter.name,
        f'<p class="text">Chapter {escape(chapter.id.removeprefix("ch"))} of R. R. Playter, '
        f"{_BOOK} (1994). {verdict(count, differ)}</p>",
        links,
        "".join(_section(section) for section in chapter.sections),
    )


def verdict(count: int, differ: int) -> str:
    """How many claims agree, in a sentence.

    Parameters
    ----------
    count : int
        Claims that were checked.
    differ : int
        Those that do not hold.

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
    if not differ:
        return f"{count} claims were checked, and all agree."
    those = "is a misprint or differs, as" if differ == 1 else "are misprints or differ, each"
    return (
        f"{count} claims were checked: {count - differ} agree; {differ} of the thesis's numbers "
        f"{those} explained."
    )


def _page(title: str, header: str, links: Iterable[tuple[str, str]], body: str) -> str:
    """A whole page; `links` are (target, words)."""
    items = "".join(f'<li><a href="{escape(to)}">{escape(words)}</a></li>' for to, words in links)
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(title)}</title>
<style>{_STYLE}</style>
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
</body>
</html>
"""


def _overview(chapters: Sequence[ChapterPage]) -> str:
    """One row for each chapter: what was checked, what agrees, and its sections."""
    rows = []
    for chapter in chapters:
        agree = sum(bool(claim["holds"]) for claim in chapter.claims)
        parts = ", ".join(
            f'<a href="{escape(chapter.id)}.html#{escape(s.id)}">{escape(s.id)}</a>'
            for s in chapter.sections
        )
        rows.append(
            f'<tr><td><a href="{escape(chapter.id)}.html">{escape(chapter.name)}</a></td>'
            f'<td class="n">{len(chapter.claims)}</td><td class="n">{agree}</td>'
            f'<td class="n">{len(chapter.claims) - agree}</td><td>{parts}</td></tr>'
        )
    return (
        '<div class="scroll"><table class="overview"><thead><tr><th>chapter</th>'
        '<th class="n">claims</th><th class="n">agree</th><th class="n">differ</th>'
        "<th>figures, tables, sections</th></tr></thead>"
        f"<tbody>{''.join(rows)}</tbody></table></div>"
    )


def _section(section: Section) -> str:
    parts = [f'<section><h2 id="{escape(section.id)}">{escape(section.title)}</h2>']
    if section.beyond:
        parts.append('<p class="beyond">Beyond the thesis: not in its text or figures.</p>')
    who = "" if section.beyond else '<span class="who">Thesis:</span> '
    words = (
        f"<p>{who}{escape(section.says)}</p>"
        f'<p><span class="who">Here:</span> {escape(section.ours)}</p>'
    )
    made_by = f"<code>somersault reproduce {escape(section.id)}</code>"
    if section.picture is None:
        parts.append(f'<div class="text">{words}<p>{made_by}</p></div>')
    else:
        name = escape(section.picture)
        parts.append(
            f'<figure><img src="{name}.svg" alt="{escape(section.title)}" loading="lazy">'
            f'<figcaption>{words}<p><a href="{name}.png">PNG</a> · <a href="{name}.svg">SVG</a> · '
            f"{made_by}</p></figcaption></figure>"
        )
    if section.table is not None:
        parts.append(_table(*section.table))
    if section.data is not None:
        parts.append(f'<p><a href="{escape(section.data)}">The table as CSV</a></p>')
    if section.claims:
        agree = sum(bool(claim["holds"]) for claim in section.claims)
        count = len(section.claims)
        opened = "" if agree == count and count > 12 else " open"
        parts.append(
            f"<details{opened}><summary>{_agreement(count, agree)}</summary>"
            f"{_claims(section.claims, notes=True)}</details>"
        )
    return "".join(parts) + "</section>\n"


def _agreement(count: int, agree: int) -> str:
    if count == 1:
        return "1 claim agrees" if agree else "1 claim, which differs"
    if agree == count:
        return f"All {count} claims agree"
    return f"{agree} of {count} claims agree; {count - agree} misprinted or different"


def _table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    head = "".join(f"<th>{escape(cell)}</th>" for cell in header)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows
    )
    return (
        f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>'
        "</div>"
    )


def _claims(claims: Sequence[Record], notes: bool) -> str:
    head = "".join(
        f"<th>{name}</th>" for name in ("", "where", "claim", "thesis", "computed", "id")
    )
    return (
        f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>'
        + "".join(_claim(claim, notes) for claim in claims)
        + "</tbody></table></div>"
    )


def _claim(claim: Record, notes: bool) -> str:
    mark = '<td class="yes">✓ agrees</td>' if claim["holds"] else '<td class="no">≠ differs</td>'
    words = escape(str(claim["claim"]))
    if notes and claim["note"]:
        words += f'<br><span class="note">{escape(str(claim["note"]))}</span>'
    unit = "" if claim["unit"] in ("", "1") else f" {claim['unit']}"
    within = "" if claim["tolerance"] is None else f" ± {claim['tolerance']:g}"
    thesis = escape(_shown(claim["thesis"]) + within + unit)
    computed = escape(_shown(claim["computed"]) + unit)
    return (
        f"<tr>{mark}<td>{escape(str(claim['where']))}</td><td>{words}</td>"
        f'<td class="n">{thesis}</td><td class="n">{computed}</td>'
        f'<td class="id">{escape(str(claim["id"]))}</td></tr>'
    )


def _shown(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:.5g}"
