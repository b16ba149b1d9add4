"""From what a user asks of a plan to a task."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Literal

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import by_name, shown, truth
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.model import Model
from somersault.planning._asked import (
    MOST_TILT,
    Ranged,
    at_end,
    attitude,
    moving_joints,
    ranged,
    takeoff_rates,
)
from somersault.planning._task import ANGLES, RATES, Task

_TILT = 1.0  # rad to either side, unless more or less is asked for
_MOST_TURNED = 1e3  # rad, of an angle on the way

Turns = float | Literal["most"]


def requested(
    model: Model,
    somersaults: Turns,
    twists: Turns,
    torque: Ranged | Mapping[str, Ranged],
    duration: Ranged,
    joints: Iterable[str] | Mapping[str, Ranged] | None,
    start: Mapping[str, Ranged] | None,
    end: Mapping[str, Ranged] | None,
    rest_at_end: bool,
    takeoff: Mapping[str, Any] | None,
    landing: Mapping[str, Ranged] | None,
    aloft: Mapping[str, Ranged] | None,
    fastest: float | Mapping[str, float] | None,
    effort: float,
) -> Task:
    """What is asked, checked; arguments as those of `plan`."""
    if not model.free or model.plane is not None:
        raise SomersaultError(
            f"{model.name} is not free in space, and a plan flies there; it needs a free base"
        )
    begin = by_name("start", start)
    moving = moving_joints(model, joints, begin, torque, fastest)
    first = at_end(moving, "start", begin)
    last = at_end(moving, "end", by_name("end", end))
    for name in last:
        if name not in moving.joints:
            raise SomersaultError(f"end {name}: that joint does not move; name it in joints")
    home = dict(zip(model.coordinates, moving.still.tolist(), strict=True))
    at_start = [first.get(name, (home[name],) * 2) for name in moving.joints]
    ranges = zip(moving.joints, moving.low.tolist(), moving.high.tolist(), strict=True)
    at_landing = [last.get(name, (low, high)) for name, low, high in ranges]
    most, turns = _turns(somersaults, twists)
    ahead = by_name("takeoff", takeoff)
    begins = attitude("takeoff", ahead, np.zeros((3, 2)), (*RATES, "momentum"))
    usual = begins[[0, 1, 2], [0, 0, 0]][:, None] + turns
    lands = attitude("landing", by_name("landing", landing), usual, ())
    everywhere = np.array([[-_MOST_TURNED, _MOST_TURNED]] * 3)
    everywhere[1] = -_TILT, _TILT
    flies = attitude("aloft", by_name("aloft", aloft), everywhere, ())
    _check_attitudes(begins, lands, flies)
    rates, momentum = takeoff_rates(ahead)
    shortest, longest = ranged("duration", duration)
    if shortest <= 0 or not np.isfinite(longest):
        raise SomersaultError(f"duration must be positive and finite, and is {shown(duration)}")
    if number("effort", effort) < 0:
        raise SomersaultError(f"effort must not be negative, and is {effort:g}")
    return Task(
        model, moving, begins, lands, flies, rates, momentum, np.array(at_start),
        np.array(at_landing), truth("rest_at_end", rest_at_end), (shortest, longest), most,
        effort if most is not None else 1.0,
    )  # fmt: skip


def _turns(somersaults: Turns, twists: Turns) -> tuple[int | None, Array]:
    """Which angle is to be great, and how far each turns, (3, 2)."""
    most = None
    result = np.zeros((3, 2))
    for name, place, turns in (("somersaults", 0, somersaults), ("twists", 2, twists)):
        if isinstance(turns, str):
            if turns != "most":
                raise SomersaultError(f"{name} must be a number or 'most', and is {shown(turns)}")
            if most is not None:
                raise SomersaultError(
                    "somersaults and twists cannot both be the most; give a number for one"
                )
            most = place
            result[place] = -np.inf, np.inf
        else:
            result[place] = 2 * np.pi * number(name, turns)
    return most, result


def _check_attitudes(begins: Array, lands: Array, flies: Array) -> None:
    for k, name in enumerate(ANGLES):
        least, most = flies[k]
        if name == "tilt" and (least < -MOST_TILT or most > MOST_TILT):
            raise SomersaultError(
                f"aloft tilt from {least:g} to {most:g} comes to π/2, where somersault and twist "
                f"have no meaning; keep it within {MOST_TILT:g}"
            )
        for what, (low, high) in (("takeoff", begins[k]), ("landing", lands[k])):
            if high < least or low > most:
                where = f"{low:g}" if low == high else f"{low:g} to {high:g}"
                raise SomersaultError(
                    f"{what} {name} is {where} rad, outside of {least:g} to {most:g} aloft"
                )
