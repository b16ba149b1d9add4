"""A task as a nonlinear program, by direct collocation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from somersault._core.array import Array
from somersault.planning._entries import Entries
from somersault.planning._gauss import gauss_legendre
from somersault.planning._layout import Layout
from somersault.planning._point import TURNING, Point
from somersault.planning._program import Program
from somersault.planning._task import ANGLES, RATES, Task

STAGES = 3  # of collocation: order six


@dataclass(frozen=True)
class Rows:
    """Constraints of one kind.

    Parameters
    ----------
    what : str
        What they hold.
    places : range
        Where they stand among all.
    names : tuple of str
        For what they are, in turn; none where they are all for the same.
    """

    what: str
    places: range
    names: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Transcription:
    """The program of a task on so many intervals.

    Parameters
    ----------
    task : Task
    layout : Layout
        Where its unknowns stand.
    program : Program
    rows : tuple of Rows
        What its constraints are.
    """

    task: Task
    layout: Layout
    program: Program
    rows: tuple[Rows, ...]


def transcribed(task: Task, point: Point, intervals: int) -> Transcription:
    """The program of a task.

    Parameters
    ----------
    task : Task
    point : Point
        The physics of its model.
    intervals : int
    """
    layout = Layout(intervals, task.count, gauss_legendre(STAGES))
    constraints = _Constraints(layout, point)
    _joints_follow(constraints)
    _attitude_follows(constraints)
    _torques(constraints, task)
    _takeoff(constraints, task)
    _ranges(constraints, task)
    _rates(constraints, task)
    least, most = _bounds(layout, task)
    cost, of_outputs = _costs(layout, point, task)
    linear, nonlinear, low, high = constraints.matrices()
    program = Program(
        point, layout.arguments, linear, nonlinear, low, high, least, most, cost, of_outputs
    )
    return Transcription(task, layout, program, tuple(constraints.rows))


class _Constraints:
    """Constraints as they come."""

    def __init__(self, layout: Layout, point: Point) -> None:
        self.layout, self.point = layout, point
        self.linear, self.nonlinear = Entries(), Entries()
        self.rows: list[Rows] = []
        self._low: list[Array] = []
        self._high: list[Array] = []
        self._count = 0

    def more(
        self, what: str, low: Array | float, high: Array | float, shape: tuple[int, ...],
        names: tuple[str, ...] = (),
    ) -> Array:  # fmt: skip
        """Places of new ones, of that shape."""
        size = int(np.prod(shape))
        places = range(self._count, self._count + size)
        self.rows.append(Rows(what, places, names))
        self._low.append(np.broadcast_to(low, shape).ravel())
        self._high.append(np.broadcast_to(high, shape).ravel())
        self._count += size
        return np.array(places).reshape(shape)

    def output(self, points: Array, which: Array | int) -> Array:
        """Places among all points' outputs."""
        return points * self.point.outputs + which

    def matrices(self) -> tuple[sp.csr_matrix, sp.csr_matrix, Array, Array]:
        """G and N of the program, and its bounds."""
        count, layout = self._count, self.layout
        return (
            self.linear.sparse(count, layout.unknowns),
            self.nonlinear.sparse(count, layout.points * self.point.outputs),
            np.concatenate(self._low),
            np.concatenate(self._high),
        )


def _joints_follow(c: _Constraints) -> None:
    """At the end of an interval joints are where their cubic has them."""
    layout = c.layout
    at_end = layout.along(np.array(1.0))
    for k, places in enumerate((layout.q, layout.v)):
        rows = c.more("joint", 0.0, 0.0, (layout.intervals, layout.joints))
        c.linear.add(rows, places[1:], 1.0)
        for (which, end), weight in at_end[k].items():
            source = (layout.q, layout.v, layout.w)[which]
            c.linear.add(rows, source[end : end + layout.intervals], -weight)


def _attitude_follows(c: _Constraints) -> None:
    """Angles at the stages, and at the end, are those at the beginning and what they turned."""
    layout = c.layout
    step, tableau = 1 / layout.intervals, layout.tableau
    shape = (layout.intervals, layout.stages, TURNING)
    begin = layout.angles[:-1]
    turning = c.output(layout.staged[:, :, None], np.arange(TURNING))  # (intervals, stages, 3)
    rows = c.more("attitude", 0.0, 0.0, shape, ANGLES)
    c.linear.add(rows, layout.within, 1.0)
    c.linear.add(rows, begin[:, None], -1.0)
    inner = tableau.inner[None, :, :, None]
    c.nonlinear.add(rows[:, :, None], turning[:, None], -step * inner)
    rows = c.more("attitude", 0.0, 0.0, (layout.intervals, TURNING), ANGLES)
    c.linear.add(rows, layout.angles[1:], 1.0)
    c.linear.add(rows, begin, -1.0)
    c.nonlinear.add(rows[:, None], turning, -step * tableau.weights[None, :, None])


def _torques(c: _Constraints, task: Task) -> None:
    """They are bounded at nodes and stages."""
    layout, moving = c.layout, task.moving
    low, high = moving.weakest / moving.units, moving.strongest / moving.units
    rows = c.more("torque", low, high, (layout.points, layout.joints), moving.joints)
    places = c.output(np.arange(layout.points)[:, None], TURNING + np.arange(layout.joints))
    c.nonlinear.add(rows, places, 1.0)


def _takeoff(c: _Constraints, task: Task) -> None:
    """Rates of the angles, or the angular momentum, times T."""
    layout = c.layout
    if task.rates is not None:
        places = c.output(np.zeros(1, int), np.arange(TURNING))
        _times_duration(c, "takeoff", task.rates, places, c.nonlinear, RATES)
    if task.momentum is not None:
        axes = ("1", "2", "3")
        _times_duration(c, "momentum", task.momentum, layout.momentum, c.linear, axes)


def _rates(c: _Constraints, task: Task) -> None:
    """Joints' rates, times T."""
    layout, moving = c.layout, task.moving
    bounded = np.flatnonzero(np.isfinite(moving.fastest))
    if bounded.size:
        fastest = np.tile(moving.fastest[bounded], layout.nodes)
        bounds = np.stack([-fastest, fastest], -1)
        names = tuple(moving.joints[k] for k in bounded)
        _times_duration(c, "fastest", bounds, layout.v[:, bounded].ravel(), c.linear, names)


def _times_duration(
    c: _Constraints, what: str, bounds: Array, places: Array, matrix: Entries,
    names: tuple[str, ...],
) -> None:  # fmt: skip
    """low T ≤ x ≤ high T."""
    low, high = bounds.T
    equal = low == high
    for side, chosen in ((low, equal), (low, ~equal), (high, ~equal)):
        chosen = chosen & np.isfinite(side)
        if not chosen.any():
            continue
        least = np.where(equal | (side is low), 0.0, -np.inf)[chosen]
        most = np.where(equal | (side is high), 0.0, np.inf)[chosen]
        own = tuple(names[k % len(names)] for k in np.flatnonzero(chosen))
        rows = c.more(what, least, most, (int(chosen.sum()),), own)
        matrix.add(rows, places[chosen], 1.0)
        c.linear.add(rows, np.array(c.layout.duration), -side[chosen])


def _ranges(c: _Constraints, task: Task) -> None:
    """Joints stay in their ranges between nodes too: a cubic is within the hull of its ends and of
    the points a third of the way along the tangents there (Bézier)."""
    layout, moving = c.layout, task.moving
    bounded = np.flatnonzero(np.isfinite(moving.low) | np.isfinite(moving.high))
    if not bounded.size:
        return
    low, high = moving.low[bounded], moving.high[bounded]
    names = tuple(moving.joints[k] for k in bounded)
    third = 1 / (3 * layout.intervals)
    for chosen, sign in ((slice(None, -1), 1), (slice(1, None), -1)):
        rows = c.more("range", low, high, (layout.intervals, len(bounded)), names)
        c.linear.add(rows, layout.q[chosen][:, bounded], 1.0)
        c.linear.add(rows, layout.v[chosen][:, bounded], sign * third)


def _bounds(layout: Layout, task: Task) -> tuple[Array, Array]:
    """Bounds of the unknowns themselves."""
    least, most = np.full(layout.unknowns, -np.inf), np.full(layout.unknowns, np.inf)

    def bound(places: Array, bounds: Array) -> None:
        least[places], most[places] = np.moveaxis(bounds, -1, 0)

    bound(layout.angles, task.aloft)
    bound(layout.within, task.aloft)
    bound(layout.angles[0], task.takeoff)
    bound(layout.angles[-1], task.landing)
    bound(layout.q, np.stack([task.moving.low, task.moving.high], -1))
    bound(layout.q[0], task.start)
    bound(layout.q[-1], task.end)
    bound(layout.v[0], np.zeros(2))
    if task.rest_at_end:
        bound(layout.v[-1], np.zeros(2))
    bound(np.array(layout.duration), np.array(task.duration))
    return least, most


def _costs(layout: Layout, point: Point, task: Task) -> tuple[Array, Array]:
    """What is to be least: effort, and an angle that is to be great."""
    cost = np.zeros(layout.unknowns)
    of_outputs = np.zeros((layout.points, point.outputs))
    weights = layout.tableau.weights / layout.intervals
    of_outputs[layout.staged, -1] = task.effort * weights
    if task.most is not None:
        cost[layout.angles[-1, task.most]] = -1.0
    return cost, of_outputs.ravel()
