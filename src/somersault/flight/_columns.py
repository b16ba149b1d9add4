"""The numbers of a takeoff by name, one for a flight or one for each of many.

A name is ("takeoff", "tilt"), ("angle", joint), ("times", joint, 2), ("mass.left_arm",) …: what
can differ between flights that share their equations. `numbers` are those of one takeoff;
with arrays (N,) in the place of some they are those of N flights.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from somersault._core.array import Array
from somersault.flight._takeoff import JointPlan, Takeoff
from somersault.model import LIMIT_SLACK
from somersault.model._types import Joint
from somersault.motion._path import Path, increasing, moves, polynomial

Name = tuple[str | int, ...]
Numbers = Mapping[Name, "float | Array"]


def numbers(takeoff: Takeoff, plans: tuple[JointPlan, ...]) -> dict[Name, float | Array]:
    """All the numbers of one takeoff."""
    found: dict[Name, float | Array] = {}
    if takeoff.quaternion is None:
        found |= {("takeoff", n): getattr(takeoff, n) for n in ("somersault", "tilt", "twist")}
    if takeoff.angular_velocity is not None:
        found |= {("angular_velocity", k + 1): x for k, x in enumerate(takeoff.angular_velocity)}
    elif takeoff.angular_momentum is not None:
        found |= {("angular_momentum", k + 1): x for k, x in enumerate(takeoff.angular_momentum)}
    else:
        spin = 0.0 if takeoff.spin is None else takeoff.spin
        found[("takeoff", "spin")] = spin
        found |= {("takeoff", n): getattr(takeoff, n) for n in ("tilt_rate", "twist_rate")}
    for plan in plans:
        found |= _of_joint(plan)
    return found


def _of_joint(plan: JointPlan) -> dict[Name, float | Array]:
    name = plan.joint.name
    found: dict[Name, float | Array] = {}
    if plan.on_path:
        found |= {("times", name, k + 1): t for k, t in enumerate(plan.times)}
        found |= {("angles", name, k + 1): a for k, a in enumerate(plan.angles)}
        if plan.motion == "compliant":
            found |= {("stiffness", name): plan.stiffness, ("damping", name): plan.damping}
        return found
    if plan.joint.kind == "ball":
        found |= {("angle", name, k + 1): x for k, x in enumerate(rotation_vector(plan))}
        found |= {("rate", name, k + 1): x for k, x in enumerate(plan.rate)}
    else:
        found |= {("angle", name): plan.position[0], ("rate", name): plan.rate[0]}
    if plan.motion == "sprung":
        found[("stiffness", name)] = plan.stiffness
        if not plan.hold and plan.joint.kind != "ball":
            found[("rest", name)] = plan.rest
    if plan.motion == "locked":
        return {key: x for key, x in found.items() if key[0] == "angle"}
    found[("damping", name)] = plan.damping
    if plan.joint.kind != "ball":
        found[("pretension", name)] = plan.pretension
    return found


def rotation_vector(plan: JointPlan) -> list[float]:
    """A ball's angle at takeoff."""
    w, *vector = plan.position
    length = float(np.linalg.norm(vector))
    ratio = 2.0 if length == 0 else 2 * float(np.arctan2(length, w)) / length
    return [ratio * x for x in vector]


def row(values: Numbers, names: list[Name], count: int) -> Array:
    """The numbers of these names side by side, (count, names)."""
    result = np.empty((count, len(names)))
    for k, name in enumerate(names):
        result[:, k] = values[name]
    return result


def position(plan: JointPlan, values: Numbers, count: int) -> tuple[Array, Array]:
    """A joint's coordinates (count, c) and speeds (count, s) at takeoff."""
    name = plan.joint.name
    if plan.joint.kind == "ball":
        turn = row(values, [("angle", name, k) for k in (1, 2, 3)], count)
        half = 0.5 * np.sqrt(turn[:, 0] ** 2 + turn[:, 1] ** 2 + turn[:, 2] ** 2)
        vector = 0.5 * np.sinc(half / np.pi)[:, None] * turn
        q = np.concatenate([np.cos(half)[:, None], vector], 1)
        if plan.motion == "locked":
            return q, np.zeros((count, 3))
        return q, row(values, [("rate", name, k) for k in (1, 2, 3)], count)
    if plan.on_path:
        since, coefficients = path(plan, values, count).at(np.zeros((count, 1)))
        angle, rate, _ = polynomial(-since, list(np.moveaxis(coefficients, -1, 0)))
        shape = (count, 1)
        return np.broadcast_to(angle, shape), np.broadcast_to(rate, shape)
    q = row(values, [("angle", name)], count)
    u = np.zeros((count, 1)) if plan.motion == "locked" else row(values, [("rate", name)], count)
    return q, u


def path(plan: JointPlan, values: Numbers, count: int) -> Path:
    """A joint's path, for each flight or one for all where they are alike."""
    if plan.given is not None:
        return plan.given
    name, k = plan.joint.name, len(plan.times)
    names: list[Name] = [(what, name, j + 1) for what in ("times", "angles") for j in range(k)]
    alike = not any(isinstance(values[n], np.ndarray) for n in names)
    both = row(values, names, 1 if alike else count)
    return moves(both[:, :k], both[:, k:])


def sound(plans: tuple[JointPlan, ...], values: Numbers, count: int) -> Array:
    """Whether each of the flights is one that could be asked for by itself, (count,)."""
    good = np.ones(count, bool)
    for plan in plans:
        name, k = plan.joint.name, len(plan.times)
        if k:
            good &= increasing(row(values, [("times", name, j + 1) for j in range(k)], count))
        for key in (("angle", name), *(("angles", name, j + 1) for j in range(k))):
            if key in values:
                good &= _within(plan.joint, np.asarray(values[key]))
        good &= np.asarray(values.get(("damping", name), 0.0)) >= 0
    if ("takeoff", "spin") in values and isinstance(values["takeoff", "spin"], np.ndarray):
        good &= values["takeoff", "spin"] != 0
    for key, x in values.items():
        if str(key[0]).startswith("mass."):
            good &= np.asarray(x) > 0
    return good


def _within(joint: Joint, angle: Array) -> Array:
    if joint.limits is None:
        return np.isfinite(angle)
    least, most = joint.limits
    return (angle >= least - LIMIT_SLACK) & (angle <= most + LIMIT_SLACK)
