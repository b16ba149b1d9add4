"""Angles in rad that look like degrees."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from somersault._core.notes import note

_TURN = 2 * math.pi
MOST_TURNS = 4  # that a body may well make in a flight
_ROUND = 0.5  # degrees are written as multiples of it, radians beyond a turn hardly ever


def look_like_degrees(angles: Any, turns: int = 1) -> bool:
    """Whether angles in rad reach beyond some turns and are all as round as degrees are."""
    sizes = np.abs(np.asarray(angles, float))
    beyond = sizes.max(initial=0.0) > turns * _TURN
    return bool(beyond and np.all(sizes % _ROUND == 0))


def degrees_hint(angle: float) -> str:
    """What to say of a refused angle in rad that looks like degrees; nothing of any other."""
    if not look_like_degrees(angle):
        return ""
    return f" (angles are in rad, and {angle:g}° are {math.radians(angle):.4g} rad)"


def note_degrees(what: str, angles: Any, turns: int = 1) -> None:
    """Note accepted angles in rad, called `what`, that look like degrees.

    What may well make `turns` turns and be a round number is not noted.
    """
    if look_like_degrees(angles, turns):
        row = np.ravel(angles)
        angle = float(row[np.argmax(np.abs(row))])
        note(
            f"{what} is {angle:g} rad, which looks like degrees: {angle:g}° are "
            f"{math.radians(angle):.4g} rad"
        )
