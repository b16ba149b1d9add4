"""Which columns of a recording are which joints of a model, and which say where its base is."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import shown
from somersault._core.errors import SomersaultError
from somersault._core.notes import note
from somersault.model import Model
from somersault.motion._names import nameable, spread
from somersault.motion._recorded_base import RecordedBase, from_coordinates, from_numbers
from somersault.motion._tables import Table, split_label, unit_factor

_SHOWN = 6  # columns in a sentence
_ANGLE = "joint_angle "  # before a joint's name in a flight's own CSV
_QUATERNION = tuple(f"quaternion {part}" for part in "wxyz")
_POSITION = tuple(f"base_position {axis}" for axis in (1, 2, 3))
_SPEED = re.compile(r"/.*/speed")  # a state of OpenSim's that follows from the values
_APART = 0.02  # rad or m: how far a recorded follower may be from where its leader has it


@dataclass(slots=True)
class Columns:
    """Samples (T,) in rad or m of joints and pairs by name, times (s), and the base's pose.

    `own` says whether a flight wrote the table.
    """

    times: Array
    rows: dict[str, Array]
    base: RecordedBase | None
    own: bool


@dataclass(slots=True)
class _Found:
    times: Array | None = None
    rows: dict[str, Array] = field(default_factory=dict)
    root: dict[str, Array] = field(default_factory=dict)
    pose: dict[str, Array] = field(default_factory=dict)
    others: list[str] = field(default_factory=list)
    used: set[str] = field(default_factory=set)


def columns_of(
    table: Table,
    model: Model,
    names: Mapping[str, str],
    ignore_others: bool,
    degrees: bool | None,
    source: str,
) -> Columns:
    """What the columns of a table are.

    Raises SomersaultError for columns that are nothing of the model's, unless they may be, and
    for what is missing.
    """
    if not isinstance(names, Mapping):
        raise SomersaultError(f"names map columns to joints, and are {shown(names)}")
    found = _sorted(table, model, names, degrees)
    own = set(_QUATERNION) <= set(found.pose)
    if found.times is None:
        raise SomersaultError("it has no column named time; name the one with the seconds so")
    missing = [name for name in names if name not in found.used]
    if missing:
        raise SomersaultError(
            f"it has no column {missing[0]!r}, which names speaks of; correct names"
        )
    if found.others and not ignore_others and not own:
        raise SomersaultError(
            f"it has columns that are no joints of {model.name}: {_list(found.others)}; map them "
            "with names, or leave them out with ignore_others"
        )
    rows = _led(model, found.rows, found.times, source)
    if not rows:
        raise SomersaultError(
            f"none of its columns is a joint of {model.name}; map columns to joints with names"
        )
    return Columns(found.times, rows, _base(model, found, source), own)


def _sorted(table: Table, model: Model, names: Mapping[str, str], degrees: bool | None) -> _Found:
    """Every column where it belongs."""
    found, known = _Found(), nameable(model)
    root = {joint.name: joint for body in model.file_coordinates.root for joint in body.joints}
    gears = dict(model.file_coordinates.gears)
    for values, label in zip(table.values.T, table.labels, strict=True):
        column, unit = split_label(label)
        if found.times is None and column.lower() == "time":
            found.times = values * unit_factor(label, unit, "time", None)
            continue
        if column in _QUATERNION or column in _POSITION:
            found.pose[column] = values
            continue
        key = next((c for c in (label, column) if c in names), None)
        name = column if key is None else names[key]
        found.used |= {key} if key is not None else set()
        if name.startswith(_ANGLE):
            name, unit = name.removeprefix(_ANGLE), "" if unit == "rad or m" else unit
            if name not in known and name in model.coordinates:
                raise SomersaultError(
                    f"joint {name.rpartition('.')[0]} is a ball, which no motion prescribes; give "
                    "the model hinges"
                )
        if name in root:
            factor = unit_factor(label, unit, root[name].kind, degrees)
            _put(found.root, name, values * factor)
        elif name in gears:  # OpenSim keeps such coordinates in radians, whatever a header says
            gear = gears[name]
            _put(found.rows, gear.leader, gear.factor * values + gear.offset)
        elif name in known or key is not None:
            joint = model.joint(next(iter(spread(model, [name]))))
            factor = 1.0 if unit == "" else unit_factor(label, unit, joint.kind, degrees)
            _put(found.rows, name, values * factor)
        elif not _SPEED.fullmatch(label):
            found.others.append(column)
    return found


def _put(rows: dict[str, Array], name: str, values: Array) -> None:
    if name in rows:
        raise SomersaultError(f"two columns are joint {name}; keep one of them")
    rows[name] = values


def _led(model: Model, rows: dict[str, Array], times: Array, source: str) -> dict[str, Array]:
    """The rows without those of joints that follow others.

    Their leaders' rows are made of theirs where these are not recorded; a follower that is
    recorded far from where its leader has it is noted.
    """
    joints = {joint.name: joint for joint in model.joints}
    leading = {n: row for n, row in rows.items() if n not in joints or joints[n].follows is None}
    for name in rows.keys() - leading.keys():
        follow = joints[name].follows
        assert follow is not None
        if follow.leader not in leading:
            if follow.factor:
                leading[follow.leader] = (rows[name] - follow.offset) / follow.factor
            continue
        off = np.abs(rows[name] - follow.factor * leading[follow.leader] - follow.offset)
        worst = int(np.argmax(off))
        if off[worst] > _APART:
            note(
                f"{source}: joint {name} follows {follow.leader} in the model, and is recorded "
                f"{off[worst]:.3g} from there at {times[worst]:.6g} s; it is taken to follow"
            )
    return leading


def _base(model: Model, found: _Found, source: str) -> RecordedBase | None:
    """The base's recorded pose, by its own numbers or by the file's coordinates of it."""
    assert found.times is not None
    if set(found.pose) == {*_QUATERNION, *_POSITION}:
        quaternions, positions = (
            np.stack([found.pose[name] for name in names], 1) for names in (_QUATERNION, _POSITION)
        )
        return from_numbers(found.times, positions, quaternions, model.axes)
    if not found.root:
        return None
    base, missing = from_coordinates(model, found.times, found.root)
    if missing:
        note(
            f"{source}: the base's {_list(missing)} are not recorded, and taken to stay where the "
            "model has them"
        )
    return base


def _list(names: list[str]) -> str:
    shown = ", ".join(name[:40] for name in names[:_SHOWN])
    return shown + (f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else "")
