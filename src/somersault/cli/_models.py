"""`somersault models`: what ships, and what was understood of a file."""

from __future__ import annotations

import argparse
import math
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from somersault._core.errors import SomersaultError, SomersaultWarning
from somersault.cli._outputs import require_other

if TYPE_CHECKING:
    from somersault.model import Joint, Model

EXAMPLES = """examples:
  somersault models
  somersault models my_robot.urdf
  somersault models my_robot.xml --json
  somersault models my_robot.urdf --out my_robot.xml
  somersault models --athlete height=1.75 mass=70 sex=female --out me.xml
  somersault models --athlete measurements=me.txt --out me.xml

--athlete takes the keys of [athlete] in a SPEC: height (m) and mass (kg), or a file of measurements
in yeadon's format; sex, densities, shoulders, knees, ankles, name: see docs/athletes.md."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument(
        "models", nargs="*", metavar="MODEL", help="model files or names; none: all that ship"
    )
    parser.add_argument(
        "--athlete", nargs="+", metavar="KEY=X", help="an athlete instead of a model that is there"
    )
    parser.add_argument(
        "--out", type=Path, metavar="FILE.xml", help="write the model as MJCF, whatever it was"
    )
    parser.add_argument("--json", action="store_true", help="print JSON for programs")


def run(chosen: argparse.Namespace) -> None:
    """Print the table of what ships, or a page for each model that is named."""
    import json

    from somersault.model import load, shipped, write_mjcf

    asked: list[str | Model] = list(chosen.models)
    if chosen.athlete is not None:
        asked.append(_athlete(chosen.athlete))
    if chosen.out is not None and len(asked) != 1:
        raise SomersaultError(f"--out writes one model, and {len(asked)} are named; name one")
    if chosen.out is not None:
        require_other(chosen.out, map(Path, chosen.models))
    records = [_record(one) for one in asked or shipped()]
    if chosen.out is not None:
        with warnings.catch_warnings():  # which are notes of the page
            warnings.simplefilter("ignore", SomersaultWarning)
            write_mjcf(load(asked[0]), chosen.out)
        records[0]["written"] = str(chosen.out)
    if chosen.json:
        print(json.dumps(records))
    elif asked:
        print("\n\n".join("\n".join(_page(record)) for record in records))
    else:
        print("\n".join(_table(records)))


def _athlete(items: Sequence[str]) -> Model:
    """The athlete of KEY=X arguments: numbers and truth values as in TOML, and texts."""
    from somersault.model import AthleteKeys
    from somersault.spec import structured

    table: dict[str, Any] = {}
    for item in items:
        key, equals, text = item.partition("=")
        if not equals:
            raise SomersaultError(f"--athlete takes KEY=X, and {item!r} is not that")
        try:
            table[key] = float(text)
        except ValueError:
            table[key] = {"true": True, "false": False}.get(text, text)
    return structured(table, AthleteKeys, of="--athlete").model()


def _record(name: str | Model) -> dict[str, Any]:
    from somersault.model import load
    from somersault.stability import principal_inertias

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("ignore")
        warnings.simplefilter("always", SomersaultWarning)
        model = load(name)
    return {
        "name": model.name,
        "mass": model.mass,
        "principal_inertias": principal_inertias(model).tolist() if model.free else None,
        "free": model.free,
        "plane": model.plane,
        "joints": list(model.speeds),
        "bodies": _bodies(model),
        "joint_details": [
            _joint(joint, body.name) for body in model.bodies for joint in body.joints
        ],
        "left_out": list(model.ignored),
        "notes": list(dict.fromkeys(str(warning.message) for warning in caught)),
    }


def _bodies(model: Model) -> list[dict[str, Any]]:
    return [
        {
            "name": body.name,
            "parent": model.bodies[body.parent].name if body.parent >= 0 else None,
            "mass": body.mass,
            "com": list(body.com),
            "inertia": [list(row) for row in body.inertia],
            "inertia_from": body.inertia_from,
        }
        for body in model.bodies
    ]


def _joint(joint: Joint, body: str) -> dict[str, Any]:
    follows = joint.follows
    return {
        "name": joint.name,
        "kind": joint.kind,
        "moves": body,
        "range": list(joint.limits) if joint.limits is not None else None,
        "home": list(joint.home),
        "stiffness": joint.stiffness,
        "damping": joint.damping,
        "armature": joint.armature,
        "follows": follows
        and {"joint": follows.leader, "factor": follows.factor, "offset": follows.offset},
    }


# ------------------------------------------------------------------------------ what is printed


def _table(records: list[dict[str, Any]]) -> list[str]:
    heads = ("model", "mass kg", "principal inertias 1, 2, 3, kg m²", "joints")
    return _columns(
        heads,
        [
            (
                record["name"],
                f"{record['mass']:.4g}",
                _inertias(record),
                ", ".join(record["joints"]) or "none (rigid)",
            )
            for record in records
        ],
    )


def _inertias(record: dict[str, Any]) -> str:
    numbers = record["principal_inertias"]
    return ", ".join(f"{x:.4g}" for x in numbers) if numbers else "none (fixed base)"


def _page(record: dict[str, Any]) -> list[str]:
    """All that was understood of one model."""
    base = "free in the air" if record["free"] else "its base fixed to the ground"
    if record["plane"] is not None:
        base = f"free in the plane across its axis {record['plane']}"
    lines = [f"{record['name']}: {record['mass']:.6g} kg, {base}"]
    if record["plane"] is not None:
        inertia = record["principal_inertias"][record["plane"] - 1]
        lines.append(f"  inertia about that axis: {inertia:.4g} kg m²")
    elif record["free"]:
        lines.append(f"  principal inertias 1, 2, 3: {_inertias(record)} kg m²")
    lines += _indented(
        ("body", "on", "mass kg", "mass and inertia from"),
        [
            (body["name"], body["parent"] or "", f"{body['mass']:.6g}", body["inertia_from"])
            for body in record["bodies"]
        ],
    )
    if record["joint_details"]:
        lines += _indented(
            ("joint", "kind", "moves", "range rad (m)", "otherwise"),
            [
                (
                    joint["name"],
                    joint["kind"],
                    joint["moves"],
                    _range(joint["range"]),
                    _otherwise(joint),
                )
                for joint in record["joint_details"]
            ],
        )
    lines += [f"  note: {note}" for note in record["notes"]]
    return lines + ([f"  written to {record['written']}"] if "written" in record else [])


def _range(limits: Sequence[float] | None) -> str:
    return "" if limits is None else f"{limits[0]:.4g} to {limits[1]:.4g}"


def _otherwise(joint: dict[str, Any]) -> str:
    """What else there is to say of a joint."""
    said = []
    if joint["kind"] != "ball" and not math.isclose(joint["home"][0], 0.0, abs_tol=1e-12):
        said.append(f"stands at {joint['home'][0]:.4g}")
    said += [
        f"{what} {joint[what]:.4g}" for what in ("stiffness", "damping", "armature") if joint[what]
    ]
    if joint["follows"]:
        leader = joint["follows"]
        offset = f" {leader['offset']:+.4g}" if leader["offset"] else ""
        said.append(f"follows {leader['factor']:.4g} × {leader['joint']}{offset}")
    return ", ".join(said)


def _indented(heads: tuple[str, ...], rows: list[tuple[str, ...]]) -> list[str]:
    return [f"  {line}" for line in _columns(heads, rows)]


def _columns(heads: tuple[str, ...], rows: list[tuple[str, ...]]) -> list[str]:
    """Rows under their heads, numbers' columns as wide as their widest entry."""
    widths = [max(len(row[k]) for row in (heads, *rows)) for k in range(len(heads))]
    return [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in (heads, *rows)
    ]
