"""Flights described in a TOML file."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.flight._maneuver import STEPS
from somersault.flight._takeoff import Takeoff
from somersault.flight.behaviours import JointTakeoff
from somersault.model import Model, load
from somersault.spec._keys import (
    BODY_AXES,
    EITHER,
    NUMBER,
    NUMBERS,
    TABLE,
    TEXT,
    WHOLE,
    YES,
    check_keys,
)
from somersault.spec._motion import moved, softened, started_off

_MOST_BYTES = 10 * 2**20
TOP = {
    "model": TEXT, "axes": BODY_AXES, "duration": NUMBER, "gravity": NUMBERS,
    "accuracy": NUMBER, "samples": WHOLE, "steps": WHOLE, "until": TEXT, "takeoff": TABLE,
    "joints": TABLE, "motion": TABLE, "compliance": TABLE, "off_nominal": TABLE,
}  # fmt: skip
_TAKEOFF = {
    "somersault": NUMBER, "tilt": NUMBER, "twist": NUMBER, "quaternion": NUMBERS,
    "spin": NUMBER, "tilt_rate": NUMBER, "twist_rate": NUMBER, "angular_velocity": NUMBERS,
    "angular_momentum": NUMBERS, "velocity": NUMBERS, "tape": NUMBERS,
}  # fmt: skip
_JOINT = {
    "motion": TEXT, "angle": EITHER, "rate": EITHER, "stiffness": NUMBER,
    "damping": NUMBER, "rest": NUMBER, "pretension": NUMBER, "hold": YES,
    "times": NUMBERS, "angles": NUMBERS, "following": YES,
    "stop_stiffness": NUMBER, "stop_damping": NUMBER,
}  # fmt: skip


@dataclass(frozen=True)
class FlightSpec:
    """What a SPEC file asks for; `options` are keyword arguments of `fly`.

    `model` is the name or file that it gives, or, where it gives axes too, the model with them.
    """

    model: str | Model
    duration: float
    takeoff: Takeoff
    options: dict[str, Any]


def read_spec(path: Path) -> FlightSpec:
    """The flight in a TOML file; SomersaultError, naming the key, for what does not fit.

    A relative model file is looked for beside the SPEC.
    """
    return parse_spec(read_toml(path), path.parent)


def read_toml(path: Path) -> dict[str, Any]:
    """The tables of a TOML file; SomersaultError for a file that is none."""
    if not path.is_file():
        raise SomersaultError(f"there is no SPEC file {str(path)!r}; check the path")
    if path.stat().st_size > _MOST_BYTES:
        raise SomersaultError(f"{path.name} is larger than 10 MB, which no SPEC is; check the file")
    try:
        return tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise SomersaultError(f"{path.name} is not TOML: {error}; correct the file") from None


def parse_spec(given: Mapping[str, Any], beside: Path) -> FlightSpec:
    """The flight in a SPEC's tables."""
    check_keys("", given, TOP)
    if "model" not in given:
        raise SomersaultError("model is missing; give a shipped model's name or a file")
    takeoff, joints = given.get("takeoff", {}), given.get("joints", {})
    check_keys("takeoff.", takeoff, _TAKEOFF)
    for name, joint in joints.items():
        if not isinstance(joint, Mapping):
            raise SomersaultError(f"joints.{name} must be a table; write [joints.{name}]")
        check_keys(f"joints.{name}.", joint, _JOINT)
    samples = given.get("samples")
    model: str | Model = _model(given["model"], beside)
    if "axes" in given:
        model = load(model, given["axes"])
    duration = number("duration", given.get("duration", 1.0))
    setups = {name: JointTakeoff(**joint) for name, joint in joints.items()}
    if "motion" in given:
        setups = moved(given["motion"], model, duration, beside, setups)
    begun = Takeoff(**takeoff, joints=setups)
    if "compliance" in given:
        begun = softened(given["compliance"], model, begun)
    if "off_nominal" in given:
        begun = started_off(given["off_nominal"], model, begun)
    return FlightSpec(
        model,
        duration,
        begun,
        {
            "gravity": given.get("gravity", (0.0, 0.0, 0.0)),
            "accuracy": number("accuracy", given.get("accuracy", 1e-9)),
            "samples": None if samples is None else int(samples),
            "until": given.get("until"),
            "steps": int(given.get("steps", STEPS)),
        },
    )


def _model(name: str, beside: Path) -> str:
    file = beside / name
    return str(file) if Path(name).suffix and file.is_file() else name
