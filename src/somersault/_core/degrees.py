"""Angles in rad that look like degrees."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from somersault._core.notes import note

_TURN = 2 * math.pi
MOST_TURNS = 4  # that a body may well make in a flight
_MOST_TURNS_A_SECOND = 10  # of anything that flies: skaters make six, cats and dolls fewer
_MOST_TURNS_OF_A_JOINT = 2  # beyond which its limits mean that there are none
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


def note_degrees_per_second(what: str, rates: Any) -> None:
    """Note accepted rates in rad/s, called `what`, that look like degrees per second."""
    if look_like_degrees(rates, _MOST_TURNS_A_SECOND):
        rate = _largest(rates)
        note(
            f"{what} is {rate:g} rad/s, which looks like degrees per second: {rate:g}°/s are "
            f"{math.radians(rate):.4g} rad/s"
        )


def limits_in_degrees(limits: tuple[float, float]) -> bool:
    """Whether the limits of a hinge, in rad, look like degrees."""
    beyond = max(map(abs, limits)) > _MOST_TURNS_OF_A_JOINT * 360
    return look_like_degrees(limits) and not beyond


def _largest(angles: Any) -> float:
    row = np.ravel(angles)
    return float(row[np.argmax(np.abs(row))])


def note_degrees(what: str, angles: Any, turns: int = 1) -> None:
    """Note accepted angles in rad, called `what`, that look like degrees.

    What may well make `turns` turns and be a round number is not noted.
    """
    if look_like_degrees(angles, turns):
        angle = _largest(angles)
        note(
            f"{what} is {angle:g} rad, which looks like degrees: {angle:g}° are "
            f"{math.radians(angle):.4g} rad"
        )
