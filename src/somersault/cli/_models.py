"""`somersault models`: what ships, with mass and principal inertias."""

from __future__ import annotations

import argparse
import json
from typing import Any

NAME = "models"
HELP = "The models that ship, with mass and principal inertias in the pose they are drawn in."
EXAMPLES = """examples:
  somersault models
  somersault models my_robot.xml --json"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument(
        "models", nargs="*", metavar="MODEL", help="model files or names; none: all that ship"
    )
    parser.add_argument("--json", action="store_true", help="print JSON for programs")


def run(chosen: argparse.Namespace) -> None:
    """Print the table."""
    from somersault.model import load, shipped

    records = [_record(load(name)) for name in chosen.models or shipped()]
    if chosen.json:
        print(json.dumps(records))
        return
    width = max(len(record["name"]) for record in records)
    print(f"{'model':<{width}}  {'mass kg':>8}  {'principal inertias 1, 2, 3, kg m²':<34}  joints")
    for record in records:
        numbers = record["principal_inertias"]
        inertias = ", ".join(f"{x:.4g}" for x in numbers) if numbers else "none (fixed base)"
        joints = ", ".join(record["joints"]) or "none (rigid)"
        print(f"{record['name']:<{width}}  {record['mass']:>8.4g}  {inertias:<34}  {joints}")


def _record(model: Any) -> dict[str, Any]:
    from somersault.stability import principal_inertias

    return {
        "name": model.name,
        "mass": model.mass,
        "principal_inertias": principal_inertias(model).tolist() if model.free else None,
        "free": model.free,
        "joints": list(model.speeds),
    }
