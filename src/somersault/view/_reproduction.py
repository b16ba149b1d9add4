"""The page of what was reproduced: one HTML file with its pictures next to it, nothing fetched."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

Record = Mapping[str, Any]


@dataclass(frozen=True)
class Section:
    """One figure or table: `picture` is its path without ending, beside the page."""

    id: str
    title: str
    says: str
    found: str
    picture: str | None
    claims: Sequence[Record]
    table: tuple[Sequence[str], Sequence[Sequence[str]]] | None = None
    beyond: bool = False


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
.yes { color: var(--good); font-weight: 700; white-space: nowrap; }
.no { color: var(--bad); font-weight: 700; white-space: nowrap; }
.note { color: var(--quiet); }
details summary { cursor: pointer; color: var(--link); }
@media print { details { display: block; } nav { display: none; } }
"""


def reproduction_page(sections: Sequence[Section], errata: Iterable[Sequence[str]]) -> str:
    """The whole page."""
    claims = [claim for section in sections for claim in section.claims]
    bad = [claim for claim in claims if not claim["holds"]]
    links = "".join(f'<li><a href="#{escape(s.id)}">{escape(s.id)}</a></li>' for s in sections)
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>The passive somersault, reproduced</title>
<style>{_STYLE}</style>
</head>
<body>
<header>
<h1>The passive somersault, reproduced</h1>
<p class="text">Figures, tables and statements of R. R. Playter, <cite>Passive Dynamics in the
Control of Gymnastic Maneuvers</cite> (1994), computed anew from the shipped models. Whether a claim
holds is computed; one that does not stays in the list, with the reason as far as it is known.</p>
<ul class="counts">
<li><b>{len(claims)}</b>claims checked</li>
<li class="yes"><b>{len(claims) - len(bad)}</b>hold</li>
<li class="no"><b>{len(bad)}</b>do not hold</li>
<li><b>{sum(s.picture is not None for s in sections)}</b>pictures</li>
</ul>
</header>
<nav aria-label="Contents"><ul><li><a href="#differences">differences</a></li>{links}<li><a \
href="#errata">errata</a></li><li><a href="#claims">all claims</a></li></ul></nav>
<main>
<h2 id="differences">What does not agree</h2>
{_claims(bad, notes=True) if bad else "<p>Every claim holds.</p>"}
{"".join(_section(section) for section in sections)}
<h2 id="errata">Errata of the thesis</h2>
<p class="text">Errors of the printed text that calculation shows. The corrected form is the one
used.</p>
{_table(("where", "printed", "correct", "why"), errata)}
<h2 id="claims">All claims</h2>
<p>The same as data: <a href="claims.json">claims.json</a>.</p>
{_claims(claims, notes=False)}
</main>
</body>
</html>
"""


def _section(section: Section) -> str:
    parts = [f'<section><h2 id="{escape(section.id)}">{escape(section.title)}</h2>']
    if section.beyond:
        parts.append('<p class="beyond">Beyond the thesis: not in its text or figures.</p>')
    who = "" if section.beyond else '<span class="who">Thesis:</span> '
    words = (
        f"<p>{who}{escape(section.says)}</p>"
        f'<p><span class="who">Here:</span> {escape(section.found)}</p>'
    )
    if section.picture is None:
        parts.append(f'<div class="text">{words}</div>')
    else:
        name = escape(section.picture)
        parts.append(
            f'<figure><img src="{name}.svg" alt="{escape(section.title)}" loading="lazy">'
            f'<figcaption>{words}<p><a href="{name}.png">PNG</a> · <a href="{name}.svg">SVG</a></p>'
            "</figcaption></figure>"
        )
    if section.table is not None:
        parts.append(_table(*section.table))
    if section.claims:
        held = sum(bool(claim["holds"]) for claim in section.claims)
        opened = "" if held == len(section.claims) and len(section.claims) > 12 else " open"
        parts.append(
            f"<details{opened}><summary>{held} of {len(section.claims)} claims hold</summary>"
            f"{_claims(section.claims, notes=True)}</details>"
        )
    return "".join(parts) + "</section>\n"


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
    mark = '<td class="yes">✓ holds</td>' if claim["holds"] else '<td class="no">✗ differs</td>'
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
