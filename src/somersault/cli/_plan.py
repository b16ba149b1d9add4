"""`somersault plan SPEC.toml`: a maneuver that is found."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from somersault.cli._outputs import (
    Writing,
    add_views,
    check_apart,
    check_views,
    write_views,
    written_lines,
)

if TYPE_CHECKING:
    from somersault.planning import Plan

EXAMPLES = """examples:
  somersault plan examples/plan_twist.toml
  somersault plan examples/plan_twist.toml --out twist.toml --page twist.html
  somersault fly twist.toml

A SPEC:
  model = "furrer"              # or as in a SPEC of somersault fly: a file, [athlete]
  [plan]
  somersaults = 1               # turns
  twists = "most"               # or turns
  torque = 60.0                 # N m, either way
  duration = [0.5, 1.5]         # s
  nodes = 40
  starts = 4
  [plan.joints]
  shoulder = [0.2, 2.8]         # rad; a pair, or joints one by one
  [plan.start]
  shoulder = 2.8                # rad
and more, all in docs/planning.md."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("spec", type=Path, metavar="SPEC.toml", help="what is asked")
    parser.add_argument(
        "--out", type=Path, metavar="FILE.toml",
        help="write the maneuver that was found, a SPEC for somersault fly",
    )  # fmt: skip
    add_views(parser)
    parser.add_argument(
        "--processes", type=int, metavar="N", help="searched at once (default: all cores)"
    )
    parser.add_argument("--json", action="store_true", help="print JSON for programs")


def run(chosen: argparse.Namespace) -> None:
    """Search, write what is asked for, print what was found."""
    import json

    from somersault.planning import read_plan

    _check_outputs(chosen)
    found = read_plan(chosen.spec).run(chosen.processes)
    writing, written = Writing(), dict[str, str]()
    record = _record(found)
    if chosen.out is not None:
        with writing:
            found.maneuver.save(chosen.out)
            written["maneuver"] = str(chosen.out)
    if chosen.video is not None or chosen.page is not None:
        write_views(found.fly(), chosen, writing, written, charts=True, vectors=("momentum",))
    print(json.dumps(record) if chosen.json else "\n".join(_page(record) + written_lines(written)))
    writing.finish()


def _check_outputs(chosen: argparse.Namespace) -> None:
    from somersault._core.places import check_file

    if chosen.out is not None:
        check_file(chosen.out, (".toml",))
    check_views(chosen)
    check_apart(chosen.spec, chosen.out, chosen.video, chosen.page)


def _record(found: Plan) -> dict[str, Any]:
    return {
        "model": found.model.name,
        "duration": found.duration,
        "turns": found.rotations,
        "greatest_torques": {
            str(joint): float(abs(found.torques.sel(joint=joint)).max())
            for joint in found.torques.joint.values
        },
        "departure": found.departure,
        "ended": found.ended,
        "starts": [
            {"ended": one.ended, "iterations": one.iterations, "solved": one.solved,
             "objective": one.objective}
            for one in found.attempts
        ],
        "seconds": found.seconds,
    }  # fmt: skip


def _page(record: dict[str, Any]) -> list[str]:
    turns = ", ".join(f"{name} {turn:.4f}" for name, turn in record["turns"].items())
    count, solved = len(record["starts"]), sum(one["solved"] for one in record["starts"])
    torques = ", ".join(f"{name} {most:.4g}" for name, most in record["greatest_torques"].items())
    return [
        f"{record['model']}, {record['duration']:.4g} s, turns: {turns}",
        f"  greatest torques at the nodes, N m (N): {torques}",
        f"  {solved} of {count} starts come to a plan, in {record['seconds']:.3g} s",
        f"  its flight departs from it by {record['departure']:.1g} rad",
    ]
