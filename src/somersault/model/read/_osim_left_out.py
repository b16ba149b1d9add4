"""What a `.osim` file holds that a `Model` does not, in words."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from somersault._core.notes import listed
from somersault.model._strange import Strange
from somersault.model.read._osim_functions import Curve
from somersault.model.read._osim_gears import Gears
from somersault.model.read._osim_joints import Links
from somersault.model.read._xml import Element

_SETS = {
    "MarkerSet": "marker",
    "ContactGeometrySet": "contact shape",
    "ControllerSet": "controller",
    "ProbeSet": "probe",
}
_FORCES = {  # a part of an element's tag, and what to call such a force
    "Muscle": "muscle",
    "Ligament": "ligament",
    "Actuator": "actuator",
    "LimitForce": "joint limit force",
    "Contact": "contact force",
    "HuntCrossley": "contact force",
    "ElasticFoundation": "contact force",
    "SphereHalfSpace": "contact force",
}


def no_part_in_flight(model: Element) -> list[str]:
    """What would change no flight, with how many of each there are."""
    said = ["gravity"] if model.first("gravity") else []
    counts = {kind: len(model.below(tag, "objects")) for tag, kind in _SETS.items()}
    return said + [_counted(kind, n) for kind, n in counts.items() if n]


def add_left_out(strange: Strange, model: Element, links: Sequence[Links], gears: Gears) -> None:
    """Note all that a flight is without, or has otherwise than the file."""
    forces: Counter[str] = Counter()
    for element in model.below("ForceSet", "objects"):
        if element.tag != "SpringGeneralizedForce":
            forces[_force(element.tag)] += 1
    for kind, n in forces.items():
        strange.add(_WITHOUT, _counted(kind, n))
    if gears.constraints:
        n = len(gears.constraints)
        strange.add(_WITHOUT, f"{_counted('constraint', n)} ({listed(gears.constraints, 4)})")
    for link in links:
        if held := _held(link, gears):
            strange.add(_HELD, held)
        for move in link.moves:
            if move.coordinate is not None and move.coordinate.locked:
                strange.add(_UNLOCKED, move.coordinate.name)
            if move.coordinate is not None and move.coordinate.prescribed:
                strange.add(_UNPRESCRIBED, move.coordinate.name)
    for name, by in gears.geared:
        strange.add(_SCALED, f"{by.leader} ({by.factor:.6g} {name})")


_WITHOUT = "acting in the file, but left out of flights"
_HELD = "held where the default pose has them, as lines are carried and curves are not"
_UNLOCKED = "locked in the file, and here at their default values unless a flight moves them"
_UNPRESCRIBED = "prescribed motions in the file, left out"
_SCALED = "joints whose value is only proportional to the file's coordinate"


def _counted(kind: str, n: int) -> str:
    return f"{n} {kind}{'s' if n > 1 else ''}"


def _force(tag: str) -> str:
    return next((kind for part, kind in _FORCES.items() if part in tag), tag)


def _held(link: Links, gears: Gears) -> str:
    """The joint with curves, and how far it is off within the range of what moves it at most."""
    off = {True: 0.0, False: 0.0}
    for move in link.moves:
        if isinstance(move.function, Curve) and move.coordinate is not None:
            name = move.coordinate.name
            at = move.function(gears.defaults[name])
            low, high = move.function.over(gears.ranges[name])
            off[move.turns] = max(off[move.turns], at - low, high - at)
    units = {True: "rad", False: "m"}
    errors = [f"{far:.3g} {units[turns]}" for turns, far in off.items() if far]
    return f"{link.name} (at most {' and '.join(errors)} off)" if errors else ""
