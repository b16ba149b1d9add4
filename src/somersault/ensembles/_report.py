"""What is told of each flight of an ensemble."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import by_name, name_list, whole_number
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.engine import STATUS, Kernel, Solution
from somersault.flight._course import Course
from somersault.flight._system import System
from somersault.flight._watch import ANGLES, RATES, VELOCITIES, values, watched

TURNS = {"somersaults": "somersault", "twists": "twist"}
ERROR = "landing_error"
ENDINGS = (*STATUS.values(), "no takeoff")
UNFLOWN = 255
_NO_TAKEOFF = ENDINGS.index("no takeoff")
FAILED = ENDINGS.index("too many steps")  # from here on
_MOST_SAMPLES = 100_000


@dataclass(frozen=True)
class Report:
    """What is told of each flight, beside when and how it ended and in how many steps.

    `quantities` at the end: "somersault", "tilt", "twist" (rad, unwrapped) and their rates
    ("tilt_rate" …), "angular_velocity_1" (2, 3; body axes), joint coordinates by name and their
    rates ("NAME_rate"); "somersaults" and "twists", turns since takeoff; "landing_error" from
    `target`. `extremes`: of which of them the least and the greatest on the way are told.
    `history`: which of them at `samples` evenly spaced times. `target` gives angles wanted at
    landing, of the body and of joints; the error is e of Playter (1994), section 6.3.2:
    e² = ¼ (ΔΦ² + ΔΘ² + ΔΨ² + the mean of the joints' Δq²).
    """

    quantities: tuple[str, ...] = ANGLES
    extremes: tuple[str, ...] = ()
    history: tuple[str, ...] = ()
    samples: int = 0
    target: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for what in ("quantities", "extremes", "history"):
            object.__setattr__(self, what, name_list(f"report.{what}", getattr(self, what)))
        whole_number("report.samples", self.samples, 0, _MOST_SAMPLES)
        object.__setattr__(self, "target", by_name("target", self.target))
        for name, angle in self.target.items():
            number(f"target.{name}", angle)

    @property
    def at_the_end(self) -> tuple[str, ...]:
        """Quantities that must be read from the last states: those told, and the target's."""
        plain = [q for q in self.quantities if q not in TURNS and q != ERROR]
        return tuple(dict.fromkeys([*plain, *self.target]))

    def times(self, duration: float) -> Array:
        """Sample times (K,), s; the end at least."""
        if not self.history:
            return np.array([duration])
        return np.linspace(0.0, duration, self.samples)


def check(report: Report, system: System) -> None:
    """SomersaultError for anything that cannot be told of this model."""
    model = system.model
    known = [*ANGLES, *RATES, *VELOCITIES, *model.coordinates, *(f"{s}_rate" for s in model.speeds)]
    for where, names, more in (
        ("report.quantities", report.quantities, [*TURNS, ERROR]),
        ("report.extremes", report.extremes, []),
        ("report.history", report.history, []),
        ("target", report.target, []),
    ):
        there = [*ANGLES, *model.coordinates] if where == "target" else [*known, *more]
        for name in names:
            if name not in there:
                raise SomersaultError(
                    f"{where}: {name!r} is nothing that is known of {model.name}; "
                    f"there are {', '.join(there)}"
                )
        if len(set(names)) < len(tuple(names)):
            raise SomersaultError(f"{where} names the same thing twice; leave one out")
    if ERROR in report.quantities and not report.target:
        raise SomersaultError("report.quantities has landing_error, which needs a target")
    if report.history and not 2 <= report.samples <= _MOST_SAMPLES:
        raise SomersaultError(
            f"report.samples must be a whole number from 2 to {_MOST_SAMPLES} for a history, "
            f"and is {report.samples}"
        )


@dataclass(frozen=True)
class Variable:
    """One variable of the dataset: what it is over beside the flights, its kind and unit."""

    unit: str
    dtype: str = "f8"
    over_time: bool = False
    words: str = ""

    @property
    def fill(self) -> float | int:
        """What stands where nothing is flown yet."""
        return {"f8": np.nan, "u1": UNFLOWN}.get(self.dtype, 0)


def variables(report: Report, system: System) -> dict[str, Variable]:
    """All variables, in order; `ended` last: a chunk that has it is complete."""
    unit = _units(system)
    found = {"time": Variable("s", words="when the flight ended")}
    for name in report.quantities:
        found[name] = Variable("1" if name in TURNS else "rad" if name == ERROR else unit[name])
    for name in report.extremes:
        for which in ("least", "greatest"):
            found[f"{which}_{name}"] = Variable(unit[name])
    for name in report.history:
        found[f"{name}_history"] = Variable(unit[name], over_time=True)
    found["steps"] = Variable("1", "i4", words="steps of the integration")
    found["ended"] = Variable("1", "u1", words="how the flight ended")
    return found


def _units(system: System) -> dict[str, str]:
    found = dict.fromkeys(ANGLES, "rad") | dict.fromkeys((*RATES, *VELOCITIES), "rad/s")
    for joint in system.model.joints:
        unit = {"hinge": "rad", "slide": "m", "ball": "1"}[joint.kind]
        rate = "m/s" if joint.kind == "slide" else "rad/s"
        where = system.model.coordinate_slice(joint.name)
        found |= dict.fromkeys(system.model.coordinates[where], unit)
        where = system.model.speed_slice(joint.name)
        found |= {f"{name}_rate": rate for name in system.model.speeds[where]}
    return found


@lru_cache(maxsize=64)
def reader(names: tuple[str, ...], system: System) -> Kernel:
    """The quantities of (angles, state, time, parameters), compiled; once for a system."""
    axes = system.model.axes
    return Kernel(
        values(names, system.quantities, system.layout.state, system.layout.parameters, axes)
    )


def first_watched(
    report: Report, system: System, angles: Array, first: Array, course: Course
) -> Array:
    """Watched rows at takeoff (N, w): the angles, then each extreme as it is."""
    if not report.extremes:
        return angles
    zero = np.zeros((len(first), 1))
    at = np.concatenate([angles, first, zero, course.parameters(zero)[:, 0]], 1)
    begun = reader(report.extremes, system)(at)
    return np.concatenate([angles, np.repeat(begun, 2, 1)], 1)


def told(
    report: Report, system: System, course: Course, found: Solution, angles: Array, sound: Array,
    times: Array,
) -> dict[str, Array]:  # fmt: skip
    """The variables of N flights.

    `angles` (N, 3) are those at takeoff; `sound` (N,) is false where there was no takeoff.
    """
    last = _read(
        report.at_the_end, system, course, found.watched_final[:, None, :3], found.final[:, None],
        found.end[:, None],
    )  # fmt: skip
    last = {name: x[:, 0] for name, x in last.items()}
    result = {"time": found.end}
    for name in report.quantities:
        if name in TURNS:
            which = ANGLES.index(TURNS[name])
            result[name] = (found.watched_final[:, which] - angles[:, which]) / (2 * np.pi)
        else:
            result[name] = landing_error(report.target, last) if name == ERROR else last[name]
    rows = dict(zip(watched(report.extremes), found.watched_final.T, strict=True))
    result |= {name: rows[name] for name in watched(report.extremes)[3:]}
    if report.history:
        when = np.broadcast_to(times, (len(found.end), len(times)))
        seen = _read(report.history, system, course, found.watched[..., :3], found.states, when)
        flown = times[None, :] <= found.end[:, None]
        result |= {f"{n}_history": np.where(flown, seen[n], np.nan) for n in report.history}
    ended = np.where(sound, found.status, _NO_TAKEOFF).astype("u1")
    lost = ended >= FAILED
    if lost.any():
        result = {
            name: np.where(lost.reshape(-1, *[1] * (x.ndim - 1)), np.nan, x)
            for name, x in result.items()
        }
    result["time"] = np.where(sound, found.end, np.nan)
    result["steps"] = np.where(sound, found.steps, 0).astype("i4")
    result["ended"] = ended
    return result


def _read(
    names: tuple[str, ...], system: System, course: Course, angles: Array, states: Array,
    times: Array,
) -> dict[str, Array]:  # fmt: skip
    """Quantities (N, K) at angles (N, K, 3), states (N, K, n) and times (N, K)."""
    found = dict(zip(ANGLES, np.moveaxis(angles, -1, 0), strict=True))
    others = tuple(name for name in names if name not in ANGLES)
    if others:
        at = np.concatenate([angles, states, times[..., None], course.parameters(times)], 2)
        found |= zip(others, np.moveaxis(reader(others, system)(at), -1, 0), strict=True)
    return found


def landing_error(target: Mapping[str, float], last: Mapping[str, Array | float]) -> Array:
    """The e of `Report` of what was last, by name, against a target."""

    def off(name: str) -> Array:
        return np.asarray(last[name] - target[name]) ** 2

    body = sum((off(n) for n in ANGLES if n in target), np.zeros(()))
    joints = [n for n in target if n not in ANGLES]
    shape = sum((off(n) for n in joints), np.zeros(())) / max(len(joints), 1)
    return np.sqrt((body + shape) / 4)
