"""`somersault map MODEL`: the momentum sphere of a body held in a pose."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from somersault.cli._assignments import assignments
from somersault.cli._outputs import PICTURE_ENDINGS, PICTURES, Writing, save_picture

if TYPE_CHECKING:
    from somersault._core.array import Array

EXAMPLES = """examples:
  somersault map human_layout --out layout.png
  somersault map furrer --pose shoulder=1.3 --out furrer.svg --energies 9
  somersault map my_robot.urdf --json

Tilt and twist are those of the principal axes about the angular momentum h. Energies are
those of rotation over h², in 1/(kg m²): times h² they are joules."""
_MOST = 200


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("model", metavar="MODEL", help="a shipped model's name or a model file")
    parser.add_argument(
        "--pose",
        nargs="+",
        action="extend",
        default=[],
        metavar="JOINT=X",
        help="joint angles in rad (m for slides); the rest stand as the file draws them",
    )
    parser.add_argument(
        "--out",
        type=Path,
        metavar="FILE",
        help=f"write the map, in 3-D and unrolled: {PICTURE_ENDINGS}",
    )
    parser.add_argument(
        "--energies",
        type=int,
        default=6,
        metavar="N",
        help="curves drawn on each side of the separatrix (default 6)",
    )
    parser.add_argument("--json", action="store_true", help="print JSON for programs")


def run(chosen: argparse.Namespace) -> None:
    """Print the energies and kinds of motion; draw the map if there is a file for it."""
    import json

    from somersault._core.errors import SomersaultError
    from somersault._core.places import check_file
    from somersault.model import load
    from somersault.stability import spin

    if not 1 <= chosen.energies <= _MOST:
        raise SomersaultError(f"--energies is {chosen.energies}; give 1 to {_MOST} curves a side")
    if chosen.out is not None:
        check_file(chosen.out, PICTURES)
    model = load(chosen.model)
    if model.plane is not None:
        raise SomersaultError(
            f"{model.name} moves in a plane, so its map is one point; a map is of bodies that turn "
            "in space"
        )
    steady = spin(model, 2, assignments("--pose", chosen.pose))
    inertias = steady.principal_inertias
    pose = dict(zip(model.coordinates, steady.pose.tolist(), strict=True))
    record = _record(model.name, pose, inertias, steady.inertia_ratios)
    writing = Writing()
    if chosen.out is not None:
        with writing:
            _draw(chosen.out, inertias, chosen.energies, _title(model.name, pose))
            record["picture"] = str(chosen.out)
    print(json.dumps(record) if chosen.json else "\n".join(_page(record)))
    writing.finish()


def _record(
    name: str, pose: dict[str, float], inertias: Array, ratios: dict[str, float]
) -> dict[str, Any]:
    import numpy as np

    from somersault import rigid
    from somersault.view.sphere import twist_text

    least, middle, greatest = rigid.energy_bounds(inertias, 1.0)
    rigid.separatrix(inertias)  # refuses a body that has none
    order = np.argsort(inertias, kind="stable")
    kinds = (("minor", middle, greatest, int(order[0])), ("major", least, middle, int(order[2])))
    return {
        "model": name,
        "pose": pose,
        "principal_inertias": inertias.tolist(),
        "inertia_ratios": ratios,
        "energy_over_h2": {"least": least, "separatrix": middle, "greatest": greatest},
        "motions": [
            {
                "circles": kind,
                "axis": axis + 1,
                "energy_over_h2": [low, high],
                "twist": "monotonic" if axis == 2 else "oscillates",
                "words": f"twist {twist_text(inertias, kind)}",
            }
            for kind, low, high, axis in kinds
            if high > low
        ],
        "separatrix_axis": int(order[1]) + 1,
    }


def _title(name: str, pose: dict[str, float]) -> str:
    held = ", ".join(f"{joint} {angle:.3g}" for joint, angle in list(pose.items())[:6])
    return f"{name} held rigid" + (f" at {held}" if held else "")


def _draw(path: Path, inertias: Array, count: int, title: str) -> None:
    from somersault.view import sphere
    from somersault.view import style as look

    with look.style():
        save_picture(path, sphere.sphere_map(inertias, sphere.energies(inertias, count), title))


_AXES = {1: "1 (front)", 2: "2 (left)", 3: "3 (head)"}


def _page(record: dict[str, Any]) -> list[str]:
    inertias = ", ".join(f"{value:.4g}" for value in record["principal_inertias"])
    energy, ratios = record["energy_over_h2"], record["inertia_ratios"]
    lines = [
        f"{record['model']}, held rigid: principal inertias {inertias} kg m²,"
        f" k1 {ratios['k1']:.3f}, k3 {ratios['k3']:.3f}",
        f"  energy over h² lies between {energy['least']:.6g} and {energy['greatest']:.6g}"
        " 1/(kg m²)",
        f"  separatrix, through axis {_AXES[record['separatrix_axis']]}:"
        f" {energy['separatrix']:.6g} 1/(kg m²)",
    ]
    for motion in record["motions"]:
        side = "above" if motion["circles"] == "minor" else "below"
        lines.append(
            f"  {side} it h circles the {motion['circles']} axis, {_AXES[motion['axis']]}:"
            f" {motion['words']}"
        )
    if "picture" in record:
        lines.append(f"  map: {record['picture']}")
    return lines
