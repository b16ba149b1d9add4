"""Flights described in a TOML file."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from somersault._errors import SomersaultError
from somersault.flight._numbers import number
from somersault.flight._takeoff import JointTakeoff, Takeoff

_MOST_BYTES = 10 * 2**20
_NUMBER, _NUMBERS, _TEXT, _YES, _TABLE = (
    "a number",
    "a list of numbers",
    "a text",
    "true or false",
    "a table",
)
_EITHER = "a number, or three for a ball"

_TOP = {
    "model": _TEXT, "duration": _NUMBER, "gravity": _NUMBERS, "accuracy": _NUMBER,
    "samples": _NUMBER, "until": _TEXT, "takeoff": _TABLE, "joints": _TABLE,
}  # fmt: skip
_TAKEOFF = {
    "somersault": _NUMBER, "tilt": _NUMBER, "twist": _NUMBER, "quaternion": _NUMBERS,
    "spin": _NUMBER, "angular_velocity": _NUMBERS, "angular_momentum": _NUMBERS,
    "velocity": _NUMBERS,
}  # fmt: skip
_JOINT = {
    "motion": _TEXT, "angle": _EITHER, "rate": _EITHER, "stiffness": _NUMBER,
    "damping": _NUMBER, "rest": _NUMBER, "hold": _YES, "times": _NUMBERS, "angles": _NUMBERS,
}  # fmt: skip


@dataclass(frozen=True)
class FlightSpec:
    """What a SPEC file asks for; `options` are keyword arguments of `fly`."""

    model: str
    duration: float
    takeoff: Takeoff
    options: dict[str, Any]


def read_spec(path: Path) -> FlightSpec:
    """The flight in a TOML file; SomersaultError, naming the key, for what does not fit.

    A relative model file is looked for beside the SPEC.
    """
    if not path.is_file():
        raise SomersaultError(f"there is no SPEC file {str(path)!r}; check the path")
    if path.stat().st_size > _MOST_BYTES:
        raise SomersaultError(f"{path.name} is larger than 10 MB, which no SPEC is; check the file")
    try:
        given = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise SomersaultError(f"{path.name} is not TOML: {error}; correct the file") from None
    return parse_spec(given, path.parent)


def parse_spec(given: Mapping[str, Any], beside: Path) -> FlightSpec:
    """The flight in a SPEC's tables."""
    _check("", given, _TOP)
    if "model" not in given:
        raise SomersaultError("model is missing; give a shipped model's name or a file")
    takeoff, joints = given.get("takeoff", {}), given.get("joints", {})
    _check("takeoff.", takeoff, _TAKEOFF)
    for name, joint in joints.items():
        if not isinstance(joint, Mapping):
            raise SomersaultError(f"joints.{name} must be a table; write [joints.{name}]")
        _check(f"joints.{name}.", joint, _JOINT)
    samples = given.get("samples")
    if isinstance(samples, float):
        if not samples.is_integer():
            raise SomersaultError(f"samples must be a whole number, and is {samples}")
        samples = int(samples)
    return FlightSpec(
        _model(given["model"], beside),
        number("duration", given.get("duration", 1.0)),
        Takeoff(**takeoff, joints={name: JointTakeoff(**joint) for name, joint in joints.items()}),
        {
            "gravity": given.get("gravity", (0.0, 0.0, 0.0)),
            "accuracy": number("accuracy", given.get("accuracy", 1e-9)),
            "samples": samples,
            "until": given.get("until"),
        },
    )


def _model(name: str, beside: Path) -> str:
    file = beside / name
    return str(file) if Path(name).suffix and file.is_file() else name


def _check(where: str, given: Mapping[str, Any], known: Mapping[str, str]) -> None:
    """Every key known, every value of its kind."""
    for key, value in given.items():
        if key not in known:
            raise SomersaultError(
                f"{where}{key} is no key of a SPEC; here it takes {', '.join(known)}"
            )
        if not _fits(value, known[key]):
            raise SomersaultError(f"{where}{key} must be {known[key]}, and is {value!r}")


def _fits(value: Any, kind: str) -> bool:
    if kind == _TEXT:
        return isinstance(value, str)
    if kind == _YES:
        return isinstance(value, bool)
    if kind == _TABLE:
        return isinstance(value, Mapping)
    if kind == _EITHER:
        return _fits(value, _NUMBER) or _fits(value, _NUMBERS)
    if kind == _NUMBERS:
        return isinstance(value, list) and all(_fits(item, _NUMBER) for item in value)
    return isinstance(value, int | float) and not isinstance(value, bool)
