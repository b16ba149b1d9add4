"""Names under which a motion gives the paths of joints: their own, or their pair's."""

from __future__ import annotations

from collections.abc import Iterable

from somersault._core.errors import SomersaultError
from somersault.model import Model, Pair, named_pairs, sides


def nameable(model: Model) -> set[str]:
    """Names under which a motion may be given: joints, and pairs by what they share."""
    return {joint.name for joint in model.joints} | set(_pairs(model))


def spread(model: Model, names: Iterable[str]) -> dict[str, tuple[str, float, float]]:
    """For each joint that is meant: the name it was given by, and its own angle from that name's.

    The angle is offset + factor · the one given; (name, factor, offset). Raises SomersaultError
    for unknown joints and those given twice.
    """
    pairs = _pairs(model)
    joints: dict[str, tuple[str, float, float]] = {}
    for name in names:
        meant = sides(model, name) if name in pairs else {name: (1.0, 0.0)}
        for joint, (factor, offset) in meant.items():
            model.joint(joint)
            if joint in joints:
                raise SomersaultError(f"joint {joint} is given twice, alone and with its pair")
            joints[joint] = (name, factor, offset)
    return joints


def _pairs(model: Model) -> dict[str, Pair]:
    """Pairs of hinges or slides of either side, by the name that they share."""
    joints = {joint.name for joint in model.joints if joint.kind != "ball"}
    return {n: pair for n, pair in named_pairs(model).items() if model.speeds[pair.left] in joints}
