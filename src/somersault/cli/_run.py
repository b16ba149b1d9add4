"""`somersault run MODEL`: a robot that runs, and somersaults on the way."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from somersault._core.errors import SomersaultError
from somersault.cli._assignments import assignments
from somersault.cli._outputs import (
    add_motion_outputs,
    check_motion_outputs,
    write_motion,
    written_lines,
)

if TYPE_CHECKING:
    from somersault.robot import Run, Runs

EXAMPLES = """examples:
  somersault run biped
  somersault run biped --flip at=5 --video flip.mp4
  somersault run biped --flip at=5 attitude=6.0 --duration 12 --json
  somersault run biped_weighted --half-twist at=5 --video half_twist.mp4
  somersault run SPEC.toml --out run.nc --page run.html

A SPEC, of which all but the robot may be left out:
  robot = "biped"               # a shipped robot or a file
  duration = 15.0               # s
  [running]
  speed = 1.0                   # m/s
  [flip]
  at = 5.0                      # s
  torque = 105.0                # N m
  [push]
  at = 2.0                      # s
  sideways = 100.0              # N
All its numbers are in docs/robots.md."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument(
        "model", metavar="MODEL", help="a shipped robot, a file of one (.xml), or a SPEC (.toml)"
    )
    maneuver = parser.add_mutually_exclusive_group()
    maneuver.add_argument(
        "--flip", nargs="+", metavar="KEY=NUMBER",
        help="somersault: at=SECONDS, and other numbers of [flip]",
    )  # fmt: skip
    maneuver.add_argument(
        "--half-twist", nargs="+", metavar="KEY=NUMBER",
        help="the same, with half a twist, which the model biped_weighted can do",
    )  # fmt: skip
    parser.add_argument(
        "--duration", type=float, metavar="S", help="s (default: 20, or the SPEC's)"
    )
    add_motion_outputs(parser)
    parser.add_argument("--json", action="store_true", help="print JSON for programs")


def run(chosen: argparse.Namespace) -> None:
    """Run, write what is asked for, print how it ended."""
    import json

    from somersault.robot import run_of

    check_motion_outputs(chosen)
    ran = run_of(_asked_for(chosen))
    writing, written = write_motion(ran, chosen)
    if chosen.json:
        print(json.dumps(_record(ran)))
    else:
        print("\n".join([*_page(ran), *written_lines(written)]))
    writing.finish()


def _asked_for(chosen: argparse.Namespace) -> Runs:
    from dataclasses import replace

    from somersault.robot import Flip, Robot, Runs, maneuver, read_runs, usual
    from somersault.spec import structured

    if chosen.model.endswith(".toml"):
        if chosen.half_twist:
            raise SomersaultError(
                '--half-twist is for a model; write maneuver = "half_twist" in the SPEC instead'
            )
        runs = read_runs(Path(chosen.model))
    else:
        numbers = maneuver("half_twist") if chosen.half_twist else usual(chosen.model)
        runs = Runs(Robot(chosen.model), numbers)
    control, duration = runs.control, runs.duration
    if chosen.duration is not None:
        duration = chosen.duration
    option = "--half-twist" if chosen.half_twist else "--flip"
    if said := chosen.half_twist or chosen.flip:
        given = assignments(option, said, "KEY", "at=5")
        structured(given, Flip, "flip", option)  # refuses what is none of its numbers
        control = replace(control, flip=replace(control.flip, **given))
        if control.flip.at >= Flip.at:
            raise SomersaultError(
                f"{option} does not say when; give it the time in seconds, for example "
                f"{option} at=5 {said[0]}"
            )
    return replace(runs, control=control, duration=duration)


def _record(ran: Run) -> dict[str, Any]:
    return {
        "model": ran.model.name,
        "ended": ran.ended,
        "fell": ran.fell,
        "duration": float(ran.outcome["time"]),
        "distance": float(ran.positions[-1, 0] - ran.positions[0, 0]),
        "speed": float(ran.speed.mean()),
        "steps": int(ran.kept["steps"][-1]),
        "somersaults": int(ran.kept["turns"][-1]),
        "outcome": {k: None if v != v else v for k, v in ran.outcome.items()},
        "events": [[round(event.time, 6), event.state] for event in ran.events],
    }


_OF_LANDING = (
    ("lift_off_speed", "lift-off at", "m/s", 1.0),
    ("flight_time", "in the air for", "s", 1.0),
    ("landing_somersault", "landed at a somersault of", "°", 57.29577951308232),
    ("landing_tilt", "tilt", "°", 57.29577951308232),
    ("landing_inclination", "legs inclined by", "°", 57.29577951308232),
)


def _page(ran: Run) -> list[str]:
    record = _record(ran)
    lines = [
        f"{record['model']}, {record['duration']:.4g} s, {record['steps']} steps, "
        f"{record['speed']:.2f} m/s: {record['ended']}"
    ]
    if record["somersaults"]:
        parts = [
            f"{words} {factor * ran.outcome[name]:.4g}{'' if unit == '°' else ' '}{unit}"
            for name, words, unit, factor in _OF_LANDING
        ]
        lines.append(f"  somersault: {', '.join(parts)}")
        lines.append(f"  {int(ran.outcome['steps_after'])} steps after it")
    return lines
