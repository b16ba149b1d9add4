"""`somersault design SPEC.toml`: the numbers that are most reliable."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from somersault.cli._cluster import add_cluster, security
from somersault.cli._outputs import (
    PICTURE_ENDINGS,
    PICTURES,
    Writing,
    check_apart,
    check_distinct,
    save_picture,
    written_lines,
)

if TYPE_CHECKING:
    from somersault.designs import Design, TradeOff

EXAMPLES = """examples:
  somersault design examples/layout_design.toml
  somersault design examples/layout_design.toml --out layout_design --plot layout_design.png

A SPEC is that of `somersault ensemble`, and what is chosen, to what end:
  [choose.stiffness]
  sets = "joints.shoulder.K"           # or adds_to, or multiplies
  between = [0.1, 2.0]
  scale = "log"                        # or linear
  [choose.frequency]
  between = [0.3, 3.0]
  multiplies = {"joints.*hip*.stiffness" = 2, "joints.*hip*.damping" = 1}   # and their powers
  [objective]
  kind = "share"                       # or mean, quantile
  quantity = "landing_error"
  most = 0.1
  [limits.torque]
  quantity = "greatest_tilt"
  most = 1.0
  [search]
  evaluations = 400
  held_out = 1024
Instead of [objective], tables [objectives.NAME] are traded off: the Pareto front is found."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("spec", type=Path, metavar="SPEC.toml", help="the design")
    parser.add_argument(
        "--out", type=Path, metavar="FOLDER",
        help="keep the search in a folder; it goes on with what is there",
    )  # fmt: skip
    add_cluster(parser)
    parser.add_argument(
        "--plot", type=Path, metavar="FILE",
        help=f"draw the search and how sharp the optimum is, or a trade-off: {PICTURE_ENDINGS}",
    )  # fmt: skip
    parser.add_argument("--json", action="store_true", help="print JSON for programs")


def run(chosen: argparse.Namespace) -> None:
    """Search, judge the best on other starts, and print what it came to."""
    import json

    from somersault._core.places import check_file
    from somersault.designs import TradeOff, read_design

    if chosen.plot is not None:
        check_file(chosen.plot, PICTURES)
    check_distinct(chosen.out, chosen.plot)
    check_apart(chosen.spec, chosen.out, chosen.plot)
    found = read_design(chosen.spec).run(
        out=chosen.out, threads=chosen.threads, workers=chosen.workers,
        scheduler=chosen.scheduler, security=security(chosen), progress=sys.stderr.isatty(),
    )  # fmt: skip
    writing, traded = Writing(), isinstance(found, TradeOff)
    record = _front(found) if isinstance(found, TradeOff) else _record(found)
    if chosen.out is not None:
        record["folder"] = str(chosen.out)
    if chosen.plot is not None:
        with writing:
            save_picture(chosen.plot, found.plot())
            record["picture"] = str(chosen.plot)
    page = _front_page if traded else _page
    print(json.dumps(record) if chosen.json else "\n".join(page(record)))
    writing.finish()


def _record(found: Design) -> dict[str, Any]:
    low, high = found.interval
    return {
        "model": found.trial.simulation.name,
        "objective": found.trial.objective.words,
        "chosen": found.best,
        "figure": found.figure,
        "low": low,
        "high": high,
        "first": found.first_figure,
        "starts": next(iter(found.rows.values())).shape[1],
        "candidates": sum(len(parts) for parts, _ in found.generations),
        "worst_start": found.worst_start,
        "unit": found.trial.unit(found.trial.objective),
        "units": {name: one.unit for name, one in found.trial.chosen.items()},
    }


def _front(found: TradeOff) -> dict[str, Any]:
    data = found.dataset
    names = [str(name) for name in data["quantity"].values]
    points = [
        {
            "chosen": dict(zip(names, one["chosen"].values.tolist(), strict=True)),
            **{key: one[key].values.tolist() for key in ("figure", "low", "high")},
            "beaten": bool(one["beaten"]),
        }
        for one in (data.isel(point=k) for k in range(data.sizes["point"]))
    ]
    return {
        "model": found.trial.simulation.name,
        "objectives": [str(name) for name in data["objective"].values],
        "objective_units": [str(unit) for unit in data["units"].values],
        "points": points,
        "first": found.first["figure"].values.tolist(),
        "starts": next(iter(found.rows.values())).shape[1],
        "candidates": sum(len(parts) for parts, _ in found.generations),
        "units": {name: one.unit for name, one in found.trial.chosen.items()},
    }


def _front_page(record: dict[str, Any]) -> list[str]:
    points, aims = record["points"], record["objectives"]
    named = [*zip(aims, record["objective_units"], strict=True), *record["units"].items()]
    rows = [[f"{name} ({unit})" if unit not in ("", "1") else name for name, unit in named]]
    for point in points:
        spans = zip(point["figure"], point["low"], point["high"], strict=True)
        figures = [_with_interval(*span) for span in spans]
        rows.append([*figures, *(f"{x:.5g}" for x in point["chosen"].values())])
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [
        f"{record['model']}: {len(points)} points of the front of {record['candidates']:,} "
        f"candidates, on {record['starts']:,} other starts (with 95 % confidence)"
    ]
    marks = ["", *("beaten" if point["beaten"] else "" for point in points)]
    for row, mark in zip(rows, marks, strict=True):
        cells = [cell.ljust(width) for cell, width in zip(row, widths, strict=True)]
        lines.append("  " + "  ".join([*cells, mark]).rstrip())
    return lines + _places(record)


def _with_interval(figure: float, *interval: float) -> str:
    low, high = (f"{x:.4g}" for x in interval)
    return f"{figure:.4g}" if low == high else f"{figure:.4g} ({low} to {high})"


def _places(record: dict[str, Any]) -> list[str]:
    places = ("folder", "picture")
    return written_lines({name: record[name] for name in places if name in record})


def _page(record: dict[str, Any]) -> list[str]:
    unit = "" if record["unit"] == "1" else f" {record['unit']}"
    worst = ", ".join(f"{name} {x:.4g}" for name, x in record["worst_start"].items())
    lines = [f"{record['model']}: best of {record['candidates']:,} candidates"]
    lines += [
        f"  {name}: {x:.5g} {record['units'][name]}".rstrip()
        for name, x in record["chosen"].items()
    ]
    lines += [
        f"  {record['objective']}, {record['starts']:,} other starts: {record['figure']:.4g}{unit} "
        f"({record['low']:.4g} to {record['high']:.4g} with 95 % confidence); at first "
        f"{record['first']:.4g}",
        f"  worst start: {worst}",
    ]
    return lines + _places(record)
