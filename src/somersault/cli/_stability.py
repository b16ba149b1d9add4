"""`somersault stability MODEL`: is this spin stable, and why."""

from __future__ import annotations

import argparse
import math
import sys
from typing import TYPE_CHECKING, Any

from somersault.cli._assignments import assignments

if TYPE_CHECKING:
    from somersault.stability import LinearSpin

EXAMPLES = """examples:
  somersault stability furrer --pose shoulder=1.4 --stiffness shoulder=1.2
  somersault stability furrer --pose left_shoulder=1.4 right_shoulder=-1.4 --lock all
  somersault stability my_robot.urdf --axis intermediate --json

A left-right pair may be named once (shoulder for left_shoulder and right_shoulder).
Angles in rad; stiffness k/(Ω² I) and damping b/(Ω I) without dimension, I the inertia
outboard of the joint about its axis."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("model", metavar="MODEL", help="a shipped model's name or a model file")
    parser.add_argument(
        "--axis",
        help="minor, intermediate, major, or 1, 2, 3: the principal axis nearest that body "
        "axis (default 2, the somersault; of a planar model the axis across its plane)",
    )
    for option, what in (
        ("--pose", "joint angles in rad (m for slides); the rest stand as the file draws them"),
        ("--stiffness", "non-dimensional joint springs k/(Ω² I)"),
        ("--damping", "non-dimensional joint dampers b/(Ω I)"),
    ):
        parser.add_argument(
            option, nargs="+", action="extend", default=[], metavar="JOINT=X", help=what
        )
    parser.add_argument(
        "--lock",
        nargs="+",
        action="extend",
        default=[],
        metavar="JOINT",
        help="joints that are rigid; all: every joint",
    )
    parser.add_argument(
        "--rate",
        type=float,
        metavar="RAD/S",
        help="the spin's rate, with which the model's own springs and dampers count",
    )
    parser.add_argument("--json", action="store_true", help="print JSON for programs")


def run(chosen: argparse.Namespace) -> None:
    """Print the verdict."""
    import json

    from somersault.stability import spin

    steady = spin(chosen.model, chosen.axis, assignments("--pose", chosen.pose))
    model, axis = steady.model, chosen.axis or str(steady.axis)
    if chosen.rate is None and any(j.stiffness or j.damping for j in model.joints):
        print(
            f"note: the springs and dampers that {model.name} has of its own are left out; "
            "give --rate to count them",
            file=sys.stderr,
        )
    system = steady.linear(
        assignments("--stiffness", chosen.stiffness),
        assignments("--damping", chosen.damping),
        chosen.lock,
        chosen.rate,
    )
    if chosen.json:
        print(json.dumps(_record(system, axis)))
    else:
        print("\n".join(_page(system, axis)))


def _record(system: LinearSpin, axis: str) -> dict[str, Any]:
    steady = system.spin
    pose = dict(zip(steady.model.coordinates, steady.pose.tolist(), strict=True))
    return {
        "model": steady.model.name,
        "axis": axis,
        "pose": pose,
        "principal_inertias": steady.principal_inertias.tolist(),
        "inertia_ratios": {
            name: None if math.isnan(ratio) else ratio
            for name, ratio in steady.inertia_ratios.items()
        },
        "coordinates": list(system.coordinates),
        "M": system.M.tolist(),
        "G": system.G.tolist(),
        "D": system.D.tolist(),
        "K": (system.K + system.K_springs).tolist(),
        "holding_torques": dict(steady.holding_torques),
        "roots": [[root.real, root.imag] for root in system.roots.tolist()],
        "stable": system.stable,
        "growth_per_somersault": system.growth_per_somersault,
        "energy_signature": system.energy_signature,
        "modes": [
            {"name": mode.name, "root": [mode.root.real, mode.root.imag], "energy": mode.energy}
            for mode in system.modes
        ],
        "resonances": [
            {
                "frequencies": [mode.root.imag for mode in found.modes],
                "counts": list(found.counts),
                "order": found.order,
                "detuning": found.detuning,
                "explosive": found.explosive,
            }
            for found in system.resonances()
        ],
    }


_WHY = {
    "definite": "it is an extremum among motions of the same angular momentum",
    "gyroscopic": "only gyroscopic coupling holds the spin, so damping would destroy it",
    "neutral": "some deviation leaves it as it is, so nothing restores that",
    "unstable": "neither a minimum of energy nor gyroscopic coupling holds the spin",
}
_DAMPED = {
    True: "only gyroscopic coupling holds the spin; its dampers do not act on what it holds",
    False: "gyroscopic coupling alone would hold the spin, and its dampers destroy it",
}


def _why(system: LinearSpin) -> str:
    if system.energy_signature == "gyroscopic" and system.D.any():
        return _DAMPED[system.stable]
    return _WHY[system.energy_signature]


def _page(system: LinearSpin, axis: str) -> list[str]:
    steady = system.spin
    ratios = steady.inertia_ratios
    verdict = "stable" if system.stable else "unstable"
    about, inertias = _axis(axis, steady.axis), steady.principal_inertias.tolist()
    said = (
        f"principal inertias {_numbers(inertias)} kg m²,"
        f" k1 {ratios['k1']:.3f}, k3 {ratios['k3']:.3f}"
    )
    if steady.model.plane is not None:
        about = f"axis {steady.axis}, across its plane"
        said = f"inertia {inertias[steady.axis - 1]:.4g} kg m²"
    lines = [
        f"{steady.model.name}, spinning about its {about}: {verdict}",
        f"  {system.growth_in_words}",
        f"  energy: {system.energy_signature}, {_why(system)}",
        f"  {said}",
    ]
    if steady.holding_torques:
        held = ", ".join(f"{name} {value:.4g}" for name, value in steady.holding_torques.items())
        lines.append(f"  holding torques over Ω²: {held}")
    lines.append("  modes (roots in units of the spin rate Ω):")
    width = min(48, max(len(mode.name) for mode in system.modes))
    sign = {1: "positive energy", -1: "negative energy", 0: ""}
    for mode in system.modes:
        real, imaginary = mode.root.real + 0.0, round(mode.root.imag, 4)
        root = f"{real:+.4f}" if real == 0 or abs(real) >= 5e-5 else f"{real:+.0e}"
        root += f" ± {imaginary:.4f} i" if imaginary else ""
        lines.append(f"    {mode.name:<{width}}  {root}  {sign[mode.energy]}".rstrip())
    near = system.resonances()
    if near:
        lines.append("  near resonances (order of their terms in the energy):")
    for found in near:
        what = "explosive" if found.explosive else "exchanges energy between modes"
        lines.append(f"    {found.words} ({found.order})  {what}")
    return lines


def _axis(asked: str, number: int) -> str:
    ways = {1: "front", 2: "left", 3: "head"}
    name = "" if asked in ("1", "2", "3") else f"{asked} axis, "
    return f"{name}principal axis nearest {number} ({ways[number]})"


def _numbers(values: list[float]) -> str:
    return ", ".join(f"{value:.4g}" for value in values)
