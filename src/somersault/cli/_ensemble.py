"""`somersault ensemble SPEC.toml`: many flights."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

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

EXAMPLES = """examples:
  somersault ensemble examples/layout_map.toml --out map.zarr
  somersault ensemble examples/layout_map.toml --out map.nc --plot map.png
  somersault ensemble SPEC.toml --landings landings.png
  somersault ensemble SPEC.toml --out map.zarr --workers 2
  somersault ensemble SPEC.toml --out map.zarr --scheduler tcp://127.0.0.1:8786

A SPEC is that of `somersault fly`, and what varies:
  [vary.arm_angle]
  sets = "joints.shoulder.angle"       # or adds_to; a number of the takeoff, or several
  values = {from = 0.4, to = 2.2, count = 19}
  [vary.tilt]
  adds_to = "takeoff.tilt"
  normal = [0.0, 0.05]                 # or uniform, triangular, lognormal, truncated_normal
  [sample]
  size = 1000
  seed = 1
  sequence = "sobol"                   # or random, halton, saltelli
  [report]
  quantities = ["somersaults", "twist", "landing_error"]
  extremes = ["tilt"]
  [target]
  somersault = 6.2832
  tolerance = 0.1
or that of `somersault run`, with [vary] and [sample]: attempts of a robot"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("spec", type=Path, metavar="SPEC.toml", help="the flights")
    parser.add_argument(
        "--out", type=Path, metavar="MAP.zarr",
        help="write the dataset: a Zarr store, resumed if it is there, or .nc (NetCDF)",
    )  # fmt: skip
    add_cluster(parser)
    parser.add_argument("--chunk", type=int, metavar="N", help="flights in a chunk")
    parser.add_argument(
        "--plot", type=Path, metavar="FILE", help=f"draw what is reported first: {PICTURE_ENDINGS}"
    )
    parser.add_argument(
        "--landings", type=Path, metavar="FILE.png",
        help="draw the bodies of a hundred flights as they land",
    )  # fmt: skip
    parser.add_argument("--json", action="store_true", help="print JSON for programs")


def run(chosen: argparse.Namespace) -> None:
    """Fly what is left to fly, and print what it all adds up to."""
    import json

    from somersault._core.places import check_file
    from somersault.ensembles import carried_out, check_out, read_ensemble, summary

    if chosen.plot is not None:
        check_file(chosen.plot, PICTURES)
    if chosen.landings is not None:
        check_file(chosen.landings, (".png",))
    whole = chosen.out is not None and check_out(chosen.out)  # written in one piece, at the end
    check_distinct(chosen.out, chosen.plot, chosen.landings)
    check_apart(chosen.spec, chosen.out, chosen.plot, chosen.landings)
    spec = read_ensemble(chosen.spec)
    flown = carried_out(
        spec.plan, None if whole else chosen.out, chosen.chunk, chosen.threads, chosen.workers,
        chosen.scheduler, security(chosen), progress=sys.stderr.isatty(),
    )  # fmt: skip
    writing, called = Writing(), spec.plan.simulation.endings.called
    record = {"model": spec.plan.simulation.name, "dimensions": spec.plan.dims}
    record |= summary(flown.dataset, spec.tolerance)
    drawn = [n for n, v in spec.plan.vary.items() if v.distribution is not None]
    if whole:
        with writing:
            flown.save(chosen.out)
            record["dataset"] = str(chosen.out)
    elif chosen.out is not None:
        record["dataset"] = str(chosen.out)
    if chosen.plot is not None:
        with writing:
            save_picture(chosen.plot, flown.plot())
            record["picture"] = str(chosen.plot)
    if chosen.landings is not None:
        with writing:
            flown.landings(chosen.landings, tolerance=spec.tolerance)
            record["landings"] = str(chosen.landings)
    points = spec.plan.count // spec.plan.dims.get("sample", 1)
    few = points * len(spec.quantities) <= _MOST_RANKINGS
    if len(drawn) > 1 and 64 <= spec.plan.size <= _MOST_RANKED and few:
        record |= _ranking(flown.dataset, spec.quantities)
    print(json.dumps(record) if chosen.json else "\n".join(_page(record, called)))
    writing.finish()


_MOST_RANKED = 100_000  # samples
_MOST_RANKINGS = 24  # one of each thing reported, at every point of the grids


def _ranking(data: Any, names: tuple[str, ...]) -> dict[str, Any]:
    """Sobol' indices of what is reported, averaged over the grids, and from how many samples;
    None where they are not determined: too few flights that did not fail, or no variance."""
    from somersault.ensembles import quick_sensitivity

    ranked, used = quick_sensitivity(data, names)
    result = {}
    for name, indices in ranked.items():
        which = "total" if "total" in indices else "first_order"
        values = indices[which]
        mean = values.mean([d for d in values.dims if d != "input"])
        result[f"{name} ({which.replace('_', '-')})"] = {
            str(i): float(v) if v == v else None
            for i, v in zip(mean["input"].values, mean.values, strict=True)
        }
    return {"sensitivity": result, "ranked_samples": used}


def _percent(share: dict[str, float]) -> str:
    return (
        f"{100 * share['fraction']:.1f} % ({100 * share['low']:.1f} to "
        f"{100 * share['high']:.1f} % with 95 % confidence)"
    )


def _page(record: dict[str, Any], called: str) -> list[str]:
    shape = " x ".join(f"{name} {n}" for name, n in record["dimensions"].items())
    ended = ", ".join(f"{word} {n:,}" for word, n in record["ended"].items())
    lines = [f"{record['model']}: {record['flights']:,} {called} ({shape})", f"  ended: {ended}"]
    if "successes" in record:
        lines.append(f"  came off: {_percent(record['successes'])}")
    for name, row in record["reported"].items():
        unit = "" if row["unit"] == "1" else f" {row['unit']}"
        lines.append(
            f"  {name}: median {row['median']:.4g}{unit}, 5 % below {row['5%']:.4g}, "
            f"5 % above {row['95%']:.4g}"
        )
    if "within_tolerance" in record:
        share = record["within_tolerance"]
        lines.append(f"  landing error within {share['tolerance']:g} rad: {_percent(share)}")
    some = ""
    if record.get("ranked_samples", size := record["dimensions"].get("sample")) != size:
        some = f" (from {record['ranked_samples']:,} of {size:,} samples)"
    for name, row in record.get("sensitivity", {}).items():
        known = [f"{who} {value:.2f}" for who, value in row.items() if value is not None]
        quantity, which = name.removesuffix(")").rsplit(" (", 1)
        lines.append(
            f"  {which} Sobol' indices of {quantity}{some}: {', '.join(known) or 'not determined'}"
        )
    names = ("dataset", "picture", "landings")
    return lines + written_lines({name: record[name] for name in names if name in record})
