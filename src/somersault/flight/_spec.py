"""A maneuver as a TOML file: what its keys mean, and how they are written.

Reading gives the fields of a `Maneuver`, writing takes one; neither needs to know more of it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, cast

import numpy as np

from somersault._core.errors import SomersaultError
from somersault.flight._replay import Replay
from somersault.flight._spec_motion import Compliance, OffNominal, Recording
from somersault.flight._takeoff import Takeoff
from somersault.flight.behaviours import Angle, JointTakeoff
from somersault.model import AthleteKeys, Base, Model, load, mjcf, shipped, write_mjcf
from somersault.motion import Path as Quintics
from somersault.spec import (
    Misplaced,
    Unfit,
    model_beside,
    plain,
    plain_fields,
    read_as,
    require_table,
    structured,
    structured_within,
    written_as,
)

Samples = int | Sequence[float] | None
_AXES = "1, 2 and 3 in some order (the body's axes of somersault, tilt and twist)"


@dataclass(frozen=True)
class Keys:
    """The keys of a SPEC of a flight; what is None is as `Maneuver` has it by default."""

    model: str | None = None
    athlete: AthleteKeys | None = None  # instead of a model
    axes: tuple[int, ...] | None = None
    base: str | None = None  # as `load` takes it
    duration: float | None = None
    gravity: Sequence[float] | None = None
    accuracy: float | None = None
    samples: Samples = None
    steps: int | None = None
    until: str | None = None
    takeoff: Takeoff = field(default_factory=Takeoff)
    joints: Mapping[str, JointTakeoff] = field(default_factory=dict)
    replay: Replay | None = None
    motion: Recording | None = None
    compliance: Compliance | None = None
    off_nominal: OffNominal | None = None


_OPTIONS = ("duration", "gravity", "accuracy", "samples", "steps", "until")
KEYS = tuple(Keys.__dataclass_fields__)


def parsed(given: Mapping[str, Any], beside: Path) -> dict[str, Any]:
    """The fields of the maneuver that a SPEC's tables describe.

    Files are looked for in the SPEC's folder. What [joints] says overrides the recording of
    [motion].

    Raises
    ------
    SomersaultError
        Naming the key, for what does not fit.
    """
    require_table(given)
    keys = structured(_found(given, beside), Keys)
    body = load(_body(keys), keys.axes, cast("Base | None", keys.base))
    joints = dict(keys.joints)
    if keys.motion is not None:
        joints = keys.motion.joints(body, keys.duration or 1.0, joints)
    takeoff = replace(keys.takeoff, joints=joints, replay=keys.replay)
    for change in (keys.compliance, keys.off_nominal):
        if change is not None:
            takeoff = change.applied(body, takeoff)
    options = {name: getattr(keys, name) for name in _OPTIONS}
    return {
        "model": body, "takeoff": takeoff,
        **{name: value for name, value in options.items() if value is not None},
    }  # fmt: skip


def _body(keys: Keys) -> str | Model:
    if keys.model is not None and keys.athlete is not None:
        raise SomersaultError("a SPEC has a model or an [athlete], and this one has both")
    if keys.athlete is not None:
        return keys.athlete.model()
    if keys.model is None:
        raise SomersaultError("model is missing; name one, or describe an [athlete]")
    return keys.model


def _found(given: Mapping[str, Any], beside: Path) -> dict[str, Any]:
    """The tables with their files beside the SPEC."""
    tables = dict(given)
    if "model" in tables:
        tables["model"] = model_beside(tables["model"], beside)
    for key, instead in (("joints", "joints.NAME"), ("replay", "replay")):
        if isinstance(tables.get("takeoff"), Mapping) and key in tables["takeoff"]:
            raise SomersaultError(f"takeoff.{key} is no key of a SPEC; write [{instead}]")
    joints = tables.get("joints")
    if isinstance(joints, Mapping):
        tables["joints"] = {name: _beside(joint, beside) for name, joint in joints.items()}
    if "motion" in tables:
        tables["motion"] = _beside(tables["motion"], beside)
    if "athlete" in tables:
        tables["athlete"] = _beside(tables["athlete"], beside, "measurements")
    return tables


def _beside(table: Any, beside: Path, key: str = "file") -> Any:
    if isinstance(table, Mapping) and isinstance(table.get(key), str):
        return {**table, key: str(beside / table[key])}
    return table


# --------------------------------------------------------------------------------- writing


def tables(maneuver: Any, path: Path) -> dict[str, Any]:
    """A maneuver as the tables of a SPEC at `path`.

    A model that does not ship is written beside it, as MJCF.
    """
    model: Model = maneuver.model
    result = _model_keys(model, path)
    if tuple(model.axes) != (2, 1, 3):
        result["axes"] = list(model.axes)
    result |= {k: v for k, v in plain(maneuver).items() if k in _OPTIONS}
    takeoff = plain(maneuver.takeoff)
    result["takeoff"] = takeoff
    for key in ("replay", "joints"):
        result[key] = takeoff.pop(key, {})
    return {name: value for name, value in result.items() if not isinstance(value, dict) or value}


def _model_keys(model: Model, path: Path) -> dict[str, Any]:
    """The name of a shipped model and its base, or of the file that the model is written to."""
    base: Base | None = None if model.plane is None else "planar"
    if model.name in shipped() and load(model.name, model.axes, base) == model:
        return {"model": model.name} if base is None else {"model": model.name, "base": base}
    file = path.with_suffix(".xml")
    if file.exists() and file.read_text(encoding="utf-8", errors="replace") != mjcf(model):
        raise SomersaultError(
            f"{file.name} is there already and is another model; save the maneuver under another "
            "name"
        )
    write_mjcf(model, file)
    return {"model": file.name}


# ------------------------------------------------------------------------ kinds of value


def _joint(table: Any, _: Any) -> JointTakeoff:
    if not isinstance(table, Mapping):
        raise Unfit("a table", table)
    given = dict(table)
    motion = given.pop("motion", None)
    if motion is not None and not isinstance(motion, str):
        raise Unfit("the name of a motion", motion)
    kind = JointTakeoff.kind_of(motion)
    try:
        keys = kind.keys_of(given)
    except SomersaultError as mistake:
        raise Misplaced(str(mistake)) from None
    return structured_within(keys, kind)


def _joint_table(joint: JointTakeoff) -> dict[str, Any]:
    table = plain_fields(joint)
    return {"motion": joint.motion, **table} if joint.is_named() else table


def _angle(value: Any, _: Any) -> Any:
    one = isinstance(value, int | float) and not isinstance(value, bool)
    many = isinstance(value, list | tuple) and all(
        isinstance(x, int | float) and not isinstance(x, bool) for x in value
    )
    if value is not None and not one and not many:
        raise Unfit("a number, or three for a ball", value)
    return value


def _samples(value: Any, _: Any) -> Any:
    if isinstance(value, list):
        return structured_within(value, Sequence[float])
    return None if value is None else structured_within(value, int)


def _body_axes(value: Any, _: Any) -> tuple[int, ...]:
    whole = isinstance(value, list) and all(type(item) is int for item in value)
    if not whole or sorted(value) != [1, 2, 3]:
        raise Unfit(_AXES, value)
    return tuple(value)


def _quintics(table: Any, _: Any) -> Quintics:
    try:
        knots = np.array(table["knots"], float)
        coefficients = np.array(table["coefficients"], float)
        first, last = table.get("known", (-np.inf, np.inf))
    except (KeyError, TypeError, ValueError):
        raise Unfit("a table of knots (s) and coefficients", table) from None
    if knots.ndim != 1 or not knots.size or coefficients.shape != (len(knots) + 1, 6):
        raise Unfit("a table of K knots (s) and K + 1 rows of 6 coefficients", table)
    return Quintics(knots, coefficients, (float(first), float(last)))


def _quintics_table(path: Quintics) -> dict[str, Any]:
    table = {"knots": path.knots.tolist(), "coefficients": path.coefficients.tolist()}
    if np.all(np.isfinite(path.known)):
        table["known"] = list(path.known)
    return table


read_as(JointTakeoff, _joint)
read_as(Angle, _angle)
read_as(Samples, _samples)
read_as(tuple[int, ...], _body_axes)
read_as(Quintics, _quintics)
written_as(JointTakeoff, _joint_table)
written_as(Quintics, _quintics_table)
