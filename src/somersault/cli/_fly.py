"""`somersault fly SPEC.toml`: one free flight."""

from __future__ import annotations

import argparse
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

from somersault.cli._outputs import (
    add_motion_outputs,
    check_apart,
    check_motion_outputs,
    write_motion,
    written_lines,
)

if TYPE_CHECKING:
    from somersault.flight import Flight

EXAMPLES = """examples:
  somersault fly examples/layout.toml
  somersault fly examples/layout.toml --out layout.nc --json
  somersault fly examples/layout.toml --video layout.mp4 --page layout.html

A SPEC:
  model = "furrer"              # a shipped name or a file; axes = [1, 2, 3] if its x is lateral;
                                # base = "free" or "planar" to let it go in space or a plane;
                                # or [athlete] height = 1.75, mass = 70: see docs/athletes.md
  duration = 5.8                # s
  [takeoff]
  tilt = 0.01                   # rad
  spin = 8.64                   # rad/s of the nominal steady spin
  [joints.left_shoulder]
  motion = "sprung"             # locked, free, sprung, prescribed, compliant
  angle = 1.4                   # rad
  stiffness = 34.48             # N m/rad
  hold = true                   # pretensioned to balance the nominal spin
or, for all joints, [motion] file = "dive.csv" and [compliance]: see docs/flight.md"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("spec", type=Path, metavar="SPEC.toml", help="the flight")
    add_motion_outputs(parser)
    parser.add_argument("--json", action="store_true", help="print JSON for programs")


def run(chosen: argparse.Namespace) -> None:
    """Fly, write the history, print how it ended."""
    import json

    from somersault._core.errors import SomersaultError
    from somersault.flight import BROKE_OFF, BROKEN, Maneuver, why_broken

    check_motion_outputs(chosen)
    check_apart(chosen.spec, chosen.out, chosen.video, chosen.page)
    maneuver = Maneuver.read(chosen.spec)
    with warnings.catch_warnings():  # that it broke off is the error below
        warnings.filterwarnings("ignore", message=BROKE_OFF)
        flight = maneuver.fly()
    if flight.ended in BROKEN:
        raise SomersaultError(
            f"the flight broke off at {flight.landing.time:g} s: {why_broken(flight)}"
        )
    writing, written = write_motion(flight, chosen, charts=True, vectors=("momentum",))
    if chosen.json:
        print(json.dumps(_record(flight)))
    else:
        print("\n".join([*_page(flight), *written_lines(written)]))
    writing.finish()


def _record(flight: Flight) -> dict[str, Any]:
    end = flight.landing
    return {
        "final": {
            "time": end.time,
            "somersault": end.somersault,
            "tilt": end.tilt,
            "twist": end.twist,
            "quaternion": end.quaternion.tolist(),
            "angular_velocity": end.angular_velocity.tolist(),
            "joints": end.joints,
        },
        "momentum_drift": flight.momentum_drift,
        "energy_drift": flight.energy_drift,
        "steps": flight.steps,
        "ended": end.ended,
    }


def _page(flight: Flight) -> list[str]:
    end = flight.landing
    turn = 6.283185307179586
    drift = flight.energy_drift
    kept = "not kept (damped or driven)" if drift is None else f"kept to {drift:.1e}"
    return [
        f"{flight.system.model.name}, {end.time:.4g} s, ended by {end.ended}, {flight.steps} steps",
        f"  somersault {end.somersault / turn:.4f} turns, tilt {end.tilt:.4f} rad, "
        f"twist {end.twist / turn:.4f} turns",
        *(f"  {name} {value:.4f}" for name, value in end.joints.items()),
        f"  angular momentum kept to {flight.momentum_drift:.1e}, energy {kept}",
    ]
