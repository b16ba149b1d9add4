"""`somersault reproduce [ID …]`: regenerate and check what the thesis shows."""

from __future__ import annotations

import argparse
from pathlib import Path

EXAMPLES = """examples:
  somersault reproduce
  somersault reproduce ch4 --out report
  somersault reproduce fig4-9 table4-3

Writes OUT/index.html, a page for each chapter, OUT/claims.json, figures and tables, the numbers
that they show, and of what moves a film and a page that plays it."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument(
        "ids", nargs="*", metavar="ID", help="ch4, fig4-9, table4-3, …; none: everything"
    )
    parser.add_argument(
        "--out", type=Path, default=Path("report"), metavar="DIR", help="default: report"
    )


def run(chosen: argparse.Namespace) -> None:
    """Write the report, and print how many claims agree."""
    from somersault.thesis import reproduce, verdict

    claims = reproduce(chosen.ids, chosen.out)
    missed = sum(claim.own for claim in claims if not claim.holds)
    differ = sum(not claim.holds for claim in claims) - missed
    print(f"{verdict(len(claims), differ, missed)} See {chosen.out / 'index.html'}")
