"""Tables of the report's pages: rows of texts, and claims."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any

Record = Mapping[str, Any]
COLUMNS = ("", "where", "claim", "thesis", "computed", "id")


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Rows under a header."""
    head = "".join(f"<th>{escape(cell)}</th>" for cell in header)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows
    )
    return (
        f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>'
        "</div>"
    )


def claims_table(bodies: str, id: str = "") -> str:
    """A table of claims, a card for each on a phone."""
    head = "".join(f"<th>{name}</th>" for name in COLUMNS)
    named = f' id="{id}"' if id else ""
    return f'<table class="claims"{named}><thead><tr>{head}</tr></thead>{bodies}</table>'


def claim_row(claim: Record, notes: bool, link: str = "") -> str:
    """A row; its ID is a link, or where a link leads."""
    mark = '<td class="yes">✓ agrees</td>' if claim["holds"] else '<td class="no">≠ differs</td>'
    words = escape(str(claim["claim"]))
    if notes and claim["note"]:
        words += f'<br><span class="note">{escape(str(claim["note"]))}</span>'
    unit = "" if claim["unit"] in ("", "1") else f" {claim['unit']}"
    within = "" if claim["tolerance"] is None else f" ± {claim['tolerance']:g}"
    thesis = escape(_shown(claim["thesis"]) + within + unit)
    computed = escape(_shown(claim["computed"]) + unit)
    id = escape(str(claim["id"]))
    place = "" if link else f' id="{id}"'
    name = f'<a href="{escape(link)}">{id}</a>' if link else id
    holds = "yes" if claim["holds"] else "no"
    return (
        f'<tr{place} data-holds="{holds}">{mark}<td>{escape(str(claim["where"]))}</td>'
        f'<td>{words}</td><td class="n" data-is="thesis">{thesis}</td>'
        f'<td class="n" data-is="computed">{computed}</td><td class="id">{name}</td></tr>'
    )


def _shown(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:.5g}"
