"""Directions in which a flight may be changed: by numbers of its takeoff, or by its state there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.attitude import quaternion_product
from somersault.flight._batch import Batch, Begun
from somersault.flight._course import Course
from somersault.flight._plane import turning
from somersault.flight._slopes import slopes
from somersault.flight._start import Starts
from somersault.motion import Path
from somersault.simulation import Target


@dataclass(frozen=True, eq=False)
class Directions:
    """How what decides one flight changes along N directions.

    `rows` (N, state) the state at takeoff, `still` (N, …) the lasting parameters, `paths` the knots
    (N, K) and coefficients (N, K + 1, …) of all that changes on the way.
    """

    rows: Array
    still: Array
    paths: Sequence[tuple[Array, Array]]

    def now(self, course: Course, phases: Array) -> Array:
        """How the parameters that change do so, at phases (K,) of the course and a little after,
        (N, K, …)."""
        parts = [np.empty((len(self.rows), len(phases), 0))]
        for path, (knots, coefficients) in zip(course.changing, self.paths, strict=True):
            place = np.searchsorted(np.ravel(path.knots), phases, side="right")
            parts += [knots[:, np.maximum(place - 1, 0), None], coefficients[:, place]]
        return np.concatenate(parts, 2)


def sizes(batch: Batch, meant: Sequence[tuple[Target, ...]]) -> Array:
    """How much of the numbers that each name means is a step to go along: as much as there is of
    them, or 1, so that what changes is of the order of the states."""
    there = batch.values
    every = [[abs(float(np.ravel(there[one.name])[0])) for one in targets] for targets in meant]
    return np.array([max(1.0, *one) for one in every])


def of_numbers(
    begun: Begun, paths: Sequence[str], meant: Sequence[tuple[Target, ...]], by_so_much: Array
) -> Directions:
    """Along the numbers that each name means, by steps (N,).

    SomersaultError for a number with respect to which the start has no derivative. What is recorded
    of the nominal flight stays as it is.
    """
    batch, given = begun.batch, begun.batch.values

    def changed(which: Array, by: Array) -> list[Array]:
        values = dict(given)
        for k, targets in enumerate(meant):
            along = np.where(which == k, by_so_much[k] * by, 0.0)
            for target in targets:
                values[target.name] = values[target.name] + target.factor * along
        return _decided(batch, batch.begun(values, len(which)).starts)

    derivatives, good = slopes(changed, len(meant))
    for path, fine in zip(paths, good, strict=True):
        if not fine:
            raise SomersaultError(
                f"the start of the flight has no derivative with respect to {path} where it is, as "
                "with a knot at takeoff; change it a little, or name another number"
            )
    return _directions(begun, derivatives)


def of_state(begun: Begun) -> Directions:
    """Along all that `moving_names` has, with the same parameters."""
    batch, starts = begun.batch, begun.starts
    ways = turning(batch.model)
    moving = [slot.joint for slot in batch.system.layout.slots if slot.kind.in_state]
    count = 2 * len(ways) + 2 * sum(joint.speeds for joint in moving)

    def changed(which: Array, by: Array) -> list[Array]:
        names = ("quaternion", "angles", "omega", "q", "u", "bodies")
        new: dict[str, Any] = {n: np.repeat(getattr(starts, n), len(which), 0) for n in names}
        k = iter(range(count))
        small = {way: by * (which == next(k)) for way in ways}
        new["quaternion"] = _turned(new["quaternion"], small)
        for way in ways:
            new["omega"][:, way] += by * (which == next(k))
        for joint in moving:
            at = batch.model.coordinate_slice(joint.name)
            small = {way: by * (which == next(k)) for way in range(joint.speeds)}
            if joint.kind == "ball":
                new["q"][:, at] = _turned(new["q"][:, at], small)
            else:
                new["q"][:, at.start] += small[0]
        for joint in moving:
            at = batch.model.speed_slice(joint.name)
            for column in range(at.start, at.stop):
                new["u"][:, column] += by * (which == next(k))
        return _decided(batch, replace(starts, **new))

    return _directions(begun, slopes(changed, count)[0])


def _decided(batch: Batch, starts: Starts) -> list[Array]:
    """All that follows from takeoffs: states, lasting parameters, paths."""
    course = Course(batch.system, batch.joints, starts, batch.duration)
    rows = Begun(batch, starts).rows[:, : batch.system.layout.state]
    return [rows, course.still, *(part for path in course.changing for part in parts(path))]


def _directions(begun: Begun, derivatives: list[Array]) -> Directions:
    """What `_decided` gives of directions, with what is recorded of the nominal flight alike."""
    rows, still, *known = derivatives
    for path in begun.course.changing[len(known) // 2 :]:
        known += [np.zeros((len(rows), *part.shape[1:])) for part in parts(path)]
    return Directions(rows, still, list(zip(known[::2], known[1::2], strict=True)))


def parts(path: Path) -> tuple[Array, Array]:
    """Knots (N, K) and coefficients (N, K + 1, …) of a path."""
    coefficients = path.coefficients
    return np.atleast_2d(path.knots), coefficients if coefficients.ndim > 2 else coefficients[None]


def _turned(quaternion: Array, turn: dict[int, Array]) -> Array:
    """Quaternions (N, 4) and half their product with small turns about their own axes, whose
    length is 1 to first order."""
    half = np.zeros_like(quaternion)
    for way, by in turn.items():
        half[:, 1 + way] = by / 2
    return quaternion + quaternion_product(quaternion, half)
