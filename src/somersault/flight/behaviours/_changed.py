"""The numbers of a behaviour in a mirror, in another time, and backwards in time."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np

from somersault.flight.behaviours import _declared
from somersault.model import Joint
from somersault.motion import Path


def mirrored(does: Any, joint: Joint, factor: float, offset: float) -> dict[str, Any]:
    """The fields of the mirrored joint that are numbers; an angle is offset + factor · this one."""
    changes: dict[str, Any] = {}
    for key, what in _declared.declared(does).items():
        value = _declared.checked(f"joint {joint.name}", joint, key, what, getattr(does, key))
        if value is None or what.image == "same":
            continue
        by, about = factor, offset if what.image == "angle" else 0.0
        row = isinstance(value, tuple)
        changes[key] = [about + by * x for x in value] if row else about + by * value
    return changes


def scaled(does: Any, factor: float) -> dict[str, Any]:
    """The fields that change where times are multiplied by a factor."""
    changes: dict[str, Any] = {}
    for one in fields(does):
        value = getattr(does, one.name)
        if isinstance(value, Path):
            changes[one.name] = value.scaled(factor)
        elif one.name == "times":
            changes[one.name] = tuple(factor * np.asarray(value, float))
    return changes


def reversed_(does: Any, end: float) -> dict[str, Any]:
    """The fields that change where t becomes end − t."""
    changes: dict[str, Any] = {}
    rows = [name for name, what in _declared.declared(does).items() if what.row]
    for one in fields(does):
        value = getattr(does, one.name)
        if isinstance(value, Path):
            changes[one.name] = value.reversed(end)
        elif one.name in rows:
            row = np.asarray(value, float)[::-1]
            changes[one.name] = tuple(end - row if one.name == "times" else row)
    return changes
