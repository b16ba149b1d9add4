"""From solved flights to what is reported of them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from somersault._core.array import Array
from somersault.engine import Solution
from somersault.flight._batch import Begun
from somersault.flight._course import Course
from somersault.flight._report import ENDINGS, TURNS, Report, landing_error
from somersault.flight._system import System, reader
from somersault.flight._watch import ANGLES, watched
from somersault.simulation import ENDED, LANDING_ERROR

_KEPT = ("time", "steps")  # of a flight that failed: when and how it gave up
_FIRST_FAILED = min(ENDINGS.code(word) for word in ENDINGS.failed)


def watch_from_takeoff(report: Report, begun: Begun) -> None:
    """Set the extremes of flights as they are at takeoff."""
    system, angles = begun.batch.system, begun.starts.angles
    states, rows = np.split(begun.rows, [system.layout.state], 1)
    if report.extremes:
        zero = np.zeros((len(states), 1))
        parameters = begun.course.parameters(zero, states[:, None])[:, 0]
        at = np.concatenate([angles, states, zero, parameters], 1)
        rows[:, angles.shape[1] :] = np.repeat(reader(report.extremes, system)(at), 2, 1)


def reported(
    report: Report, target: Mapping[str, float], begun: Begun, solution: Solution, times: Array
) -> dict[str, Array]:
    """The variables of N flights and how they ended; `times` are those of a history."""
    system, course, angles = begun.batch.system, begun.course, begun.starts.angles
    plain = [name for name in report.quantities if name not in (*TURNS, LANDING_ERROR)]
    landed = _read(
        tuple(dict.fromkeys([*plain, *target])), system, course,
        solution.watched_final[:, None, :3], solution.final[:, None], solution.end[:, None],
    )  # fmt: skip
    landed = {name: x[:, 0] for name, x in landed.items()}
    rows: dict[str, Array] = {"time": solution.end}
    for name in report.quantities:
        if name in TURNS:
            which = ANGLES.index(TURNS[name])
            rows[name] = (solution.watched_final[:, which] - angles[:, which]) / (2 * np.pi)
        elif name == LANDING_ERROR:
            rows[name] = landing_error(target, landed)
        else:
            rows[name] = landed[name]
    extremes = watched(report.extremes)[len(ANGLES) :]
    rows |= zip(extremes, solution.watched_final[:, len(ANGLES) :].T, strict=True)
    if report.history:
        when = np.broadcast_to(times, (len(solution.end), len(times)))
        seen = _read(
            report.history, system, course, solution.watched[..., :3], solution.states, when
        )
        in_the_air = times[None, :] <= solution.end[:, None]
        rows |= {f"{n}_history": np.where(in_the_air, seen[n], np.nan) for n in report.history}
    rows["steps"] = solution.steps.astype("i4")
    rows[ENDED] = solution.status.astype("u1")
    lost = rows[ENDED] >= _FIRST_FAILED
    if lost.any():
        rows |= {
            name: np.where(lost.reshape(-1, *[1] * (x.ndim - 1)), np.nan, x)
            for name, x in rows.items()
            if name not in (*_KEPT, ENDED)
        }
    return rows


def _read(
    names: tuple[str, ...], system: System, course: Course, angles: Array, states: Array,
    times: Array,
) -> dict[str, Array]:  # fmt: skip
    """Quantities (N, K) at angles (N, K, 3), states (N, K, n) and times (N, K)."""
    read = dict(zip(ANGLES, np.moveaxis(angles, -1, 0), strict=True))
    others = tuple(name for name in names if name not in ANGLES)
    if others:
        at = np.concatenate([angles, states, times[..., None], course.parameters(times, states)], 2)
        read |= zip(others, np.moveaxis(reader(others, system)(at), -1, 0), strict=True)
    return read
