"""What is asked of a plan, checked and put in numbers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import by_name, name_list, shown
from somersault._core.degrees import MOST_TURNS, note_degrees
from somersault._core.errors import SomersaultError
from somersault._core.numbers import as_floats, number
from somersault.model import LIMIT_SLACK, Joint, Model, pose, sides, spread
from somersault.planning._joints import Moving
from somersault.planning._task import ANGLES, RATES, Range

MOST_TILT = 1.5  # rad: the angles have no meaning at π/2

Ranged = float | Sequence[float] | Array


def ranged(what: str, value: Any) -> Range:
    """A number, or the two ends of a range; SomersaultError naming `what`."""
    if isinstance(value, int | float | np.number):
        one = number(what, value)
        return one, one
    ends = as_floats(value)
    if ends is None or ends.shape != (2,) or np.any(np.isnan(ends)):
        raise SomersaultError(
            f"{what} must be a number or two, the least and the greatest, and is {shown(value)}"
        )
    low, high = ends.tolist()
    if low > high:
        raise SomersaultError(
            f"{what} goes from {low:g} to {high:g}, which is empty; give the lesser end first"
        )
    return low, high


def moving_joints(
    model: Model,
    joints: Iterable[str] | Mapping[str, Ranged] | None,
    start: Mapping[str, Ranged],
    torque: Ranged | Mapping[str, Ranged],
    fastest: float | Mapping[str, float] | None,
) -> Moving:
    """The joints that move, and their bounds."""
    ranges = joints if isinstance(joints, Mapping) else {}
    if joints is None:
        named = [j.name for j in model.joints if j.kind != "ball" and j.follows is None]
    else:
        named = [*by_name("joints", joints)] if ranges else [*name_list("joints", joints)]
    meant = spread(model, dict.fromkeys(named, 0.0), mirrored=False)
    for name in meant:
        if name in model.speeds and name not in {joint.name for joint in model.joints}:
            raise SomersaultError(f"joint {name} is of a ball, which no plan moves; leave it out")
        model.joint(name)  # refuses what is none
    chosen = [joint.name for joint in model.joints if joint.name in meant]
    for joint in (model.joint(name) for name in chosen):
        if joint.follows is not None:
            raise SomersaultError(
                f"joint {joint.name} follows {joint.follows.leader}; name that one instead"
            )
    if not chosen:
        raise SomersaultError("no joint moves, so there is nothing to plan; name at least one")
    own = bounds(model, "joints", ranges)
    limits = [_range(model.joint(name), own.get(name)) for name in chosen]
    torques = _each("torque", torque, model, chosen)
    if not np.all((torques[:, 0] < torques[:, 1]) & (torques[:, 0] <= 0) & (torques[:, 1] >= 0)):
        raise SomersaultError(
            "torque must be a positive number, or two on either side of zero, N m (N); and is "
            f"{shown(torque)}"
        )
    rates = np.full(len(chosen), np.inf)
    if fastest is not None:
        rates = _each("fastest", fastest, model, chosen)[:, 1]
        if not np.all(rates > 0):
            raise SomersaultError(f"fastest must be a positive rate, and is {shown(fastest)}")
    exact = {n: v for n, v in start.items() if isinstance(v, int | float | np.number)}
    still = pose(model, exact)
    low, high = np.array(limits).T
    return Moving(model, tuple(chosen), still, low, high, torques[:, 0], torques[:, 1], rates)


def _range(joint: Joint, own: Range | None) -> Range:
    low, high = joint.limits or (-np.inf, np.inf)
    if own is None:
        return low, high
    if own[0] < low - LIMIT_SLACK or own[1] > high + LIMIT_SLACK:
        raise SomersaultError(
            f"joints: {joint.name} from {own[0]:g} to {own[1]:g} goes beyond its limits, {low:g} "
            f"to {high:g}; stay within"
        )
    if own[0] == own[1]:
        raise SomersaultError(
            f"joints: {joint.name} has no range in which to move; leave it out, or give it one"
        )
    return own


def _each(what: str, value: Any, model: Model, joints: Sequence[str]) -> Array:
    """Two numbers for each joint, of one for all or some by name; one is ± that."""
    if not isinstance(value, Mapping):
        return np.tile(_symmetric(what, value), (len(joints), 1))
    given = {name: _symmetric(f"{what} {name}", one) for name, one in by_name(what, value).items()}
    rows = {
        joint: sorted((factor * low, factor * high))
        for name, (low, high) in given.items()
        for joint, (factor, _) in sides(model, name).items()
    }
    for name in rows:
        if name not in joints:
            raise SomersaultError(f"{what}: joint {name} does not move; leave it out")
    for name in joints:
        if name not in rows:
            raise SomersaultError(f"{what} of joint {name} is missing; give every joint's, or one")
    return np.array([rows[name] for name in joints])


def _symmetric(what: str, value: Any) -> Range:
    low, high = ranged(what, value)
    return (-high, high) if low == high else (low, high)


def bounds(model: Model, what: str, values: Mapping[str, Ranged]) -> dict[str, Range]:
    """Ranges by joint, of those by joint or pair, whose right side is mirrored."""
    ends = {name: ranged(f"{what} {name}", value) for name, value in values.items()}
    rows = spread(model, {name: np.array(end) for name, end in ends.items()}, mirrored=True)
    return {name: (float(np.min(row)), float(np.max(row))) for name, row in rows.items()}


def at_end(moving: Moving, what: str, values: Mapping[str, Ranged]) -> dict[str, Range]:
    """Where joints that move are at an end, within their ranges."""
    result = bounds(moving.model, what, values)
    for name, (low, high) in result.items():
        if name not in moving.joints:
            continue
        k = moving.joints.index(name)
        least, most = moving.low[k], moving.high[k]
        if low < least - LIMIT_SLACK or high > most + LIMIT_SLACK:
            where = f"{low:g}" if low == high else f"{low:g} to {high:g}"
            raise SomersaultError(
                f"{what} {name}={where} is outside its range, {least:g} to {most:g}; move it inside"
            )
    return result


def attitude(what: str, values: Mapping[str, Ranged], usual: Array, extra: Sequence[str]) -> Array:
    """Ranges (3, 2) of somersault, tilt and twist, those that are `usual` where none is given."""
    result = usual.copy()
    for name, value in values.items():
        if name in extra:
            continue
        if name not in ANGLES:
            known = ", ".join((*ANGLES, *extra))
            raise SomersaultError(f"{what} {shown(name)} is nothing there is; there are {known}")
        result[ANGLES.index(name)] = ranged(f"{what} {name}", value)
        for end in result[ANGLES.index(name)]:
            if np.isfinite(end) and what != "aloft":
                note_degrees(f"{what} {name}", end, 1 if name == "tilt" else MOST_TURNS)
    return result


def takeoff_rates(values: Mapping[str, Any]) -> tuple[Array | None, Array | None]:
    """Ranges (3, 2) of the angles' rates at takeoff, or of the angular momentum."""
    if "momentum" in values:
        given = [name for name in RATES if name in values]
        if given:
            raise SomersaultError(
                f"takeoff gives {' and '.join(given)} and momentum; give one or the other"
            )
        rows = values["momentum"]
        if isinstance(rows, str) or not hasattr(rows, "__len__") or len(rows) != 3:
            raise SomersaultError(
                "takeoff momentum must be three numbers or ranges, along the inertial axes, and "
                f"is {shown(rows)}"
            )
        return None, np.array([ranged(f"takeoff momentum {k + 1}", rows[k]) for k in range(3)])
    usual: dict[str, Any] = {"spin": (-np.inf, np.inf), "tilt_rate": 0.0, "twist_rate": 0.0}
    return np.array([ranged(f"takeoff {n}", values.get(n, usual[n])) for n in RATES]), None
