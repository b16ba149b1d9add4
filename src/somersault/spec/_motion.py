"""The parts of a SPEC that move joints: a motion from a file, and compliance about it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from somersault._core.errors import SomersaultError
from somersault.flight._compliance import compliant, off_nominal
from somersault.flight._plans import by_joint
from somersault.flight._prescribed import prescribed
from somersault.flight._takeoff import Takeoff
from somersault.flight.behaviours import JointTakeoff
from somersault.model import Model, load
from somersault.motion._files import read_motion
from somersault.motion._motion import Motion
from somersault.spec._keys import NUMBER, TABLE, TEXT, YES, check_keys

_MOTION = {
    "file": TEXT, "names": TABLE, "ignore_others": YES, "degrees": YES, "cutoff": NUMBER,
    "rate": NUMBER, "start": NUMBER, "stop": NUMBER, "gap": NUMBER, "slack": NUMBER,
    "mirrored": YES, "scaled": NUMBER, "delayed": NUMBER,
}  # fmt: skip
_READ = ("names", "ignore_others", "degrees", "cutoff", "rate", "start", "stop", "gap", "slack")
_COMPLIANCE = {"natural_frequency": NUMBER, "damping_ratio": NUMBER, "pose": "", "tape": YES,
    "stop_stiffness": NUMBER, "stop_damping": NUMBER,
}  # fmt: skip
_OFF = {"somersault": NUMBER, "tilt": NUMBER, "twist": NUMBER}


def moved(
    given: Mapping[str, Any], model: str | Model, duration: float, beside: Path,
    joints: Mapping[str, JointTakeoff],
) -> dict[str, JointTakeoff]:  # fmt: skip
    """What every joint does that a [motion] table prescribes, or that [joints] names: `joints` go
    before the recording, those of a pair singly or both. The recording is mirrored, scaled and
    delayed in this order. The file is looked for beside the SPEC; `cutoff` = 0 filters nothing."""
    check_keys("motion.", given, _MOTION)
    if "file" not in given:
        raise SomersaultError("motion.file is missing; give a .csv, .mot or .sto file")
    body = load(model)
    options = {key: given[key] for key in _READ if key in given}
    if options.get("cutoff") == 0:
        options["cutoff"] = None
    motion: Motion = read_motion(beside / given["file"], body, **options)
    if given.get("mirrored", False):
        motion = motion.mirrored(body)
    if "scaled" in given:
        motion = motion.scaled(given["scaled"])
    if "delayed" in given:
        motion = motion.delayed(given["delayed"])
    return {**prescribed(body, motion, duration), **by_joint(body, joints)}


def softened(given: Mapping[str, Any], model: str | Model, takeoff: Takeoff) -> Takeoff:
    """The takeoff, compliant about what it prescribes as a [compliance] table says."""
    for key in given:
        if key == "pose":
            continue
        check_keys("compliance.", {key: given[key]}, _COMPLIANCE)
    pose = given.get("pose")
    if "natural_frequency" not in given or not isinstance(pose, str | int | float | Mapping):
        raise SomersaultError(
            "compliance needs natural_frequency (rad/s) and pose: a time of the motion (s), joint "
            'angles by name, "following", or an athlete\'s named pose like "wrap"'
        )
    return compliant(
        model, takeoff, given["natural_frequency"], given.get("damping_ratio", 0.7),
        pose=pose, tape=given.get("tape", True),
        stop_stiffness=given.get("stop_stiffness", 0.0),
        stop_damping=given.get("stop_damping", 0.0),
    )  # fmt: skip


def started_off(given: Mapping[str, Any], model: str | Model, takeoff: Takeoff) -> Takeoff:
    """The takeoff, as far from its attitude as an [off_nominal] table says."""
    check_keys("off_nominal.", given, _OFF)
    return off_nominal(model, takeoff, **given)
