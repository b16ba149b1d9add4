"""Tables of the report's pages: rows of texts, and claims."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any

from somersault.thesis._claims import is_own

Record = Mapping[str, Any]
COLUMNS = ("", "where", "claim", "thesis", "computed", "id")
_POWER = re.compile(r"(?<![\w.])([-−]?\d+(?:\.\d+)?)e([+-]\d+)(?!\w)")
_MINUS = re.compile(r"(?<![\w.)\]-])-(?=\.?\d)")
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def printed(words: str) -> str:
    """Words as HTML, with numbers as a book has them: a real minus, and powers of ten."""
    return escape(_MINUS.sub("−", _POWER.sub(_power, words)))


def _power(found: re.Match[str]) -> str:
    mantissa, exponent = found[1], int(found[2])
    if float(mantissa.replace("−", "-")) == 0:
        return "0"
    if exponent == 0:
        return mantissa
    power = f"10{str(exponent).translate(_RAISED)}"
    return power if mantissa == "1" else f"{mantissa} × {power}"


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Rows under a header."""
    head = "".join(f"<th>{escape(cell)}</th>" for cell in header)
    body = "".join(
        "<tr>" + "".join(f"<td>{printed(cell)}</td>" for cell in row) + "</tr>" for row in rows
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
    differs = "not met" if is_own(claim["thesis"]) else "≠ differs"
    mark = '<td class="yes">✓ agrees</td>' if claim["holds"] else f'<td class="no">{differs}</td>'
    words = printed(str(claim["claim"]))
    if notes and claim["note"]:
        words += f'<br><span class="note">{printed(str(claim["note"]))}</span>'
    unit = "" if claim["unit"] in ("", "1") else f" {claim['unit']}"
    within = "" if claim["tolerance"] is None else f" ± {claim['tolerance']:g}"
    thesis = printed(_shown(claim["thesis"]) + within + unit)
    computed = printed(_shown(claim["computed"]) + unit)
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
