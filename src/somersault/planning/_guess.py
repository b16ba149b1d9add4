"""Where the solver starts: joints that move at random, and an attitude that turns evenly."""

from __future__ import annotations

from functools import cache

import numpy as np

from somersault._core.array import Array
from somersault.dynamics import Equations
from somersault.planning._layout import Layout
from somersault.planning._task import Task, within
from somersault.planning._transcription import Transcription

_KNOTS = 3  # of a joint's random path, between its ends
_WILD = 25  # of one that waves, in every other start where as much as can be is wanted
_REACH = 0.9  # of its range, which it uses
_LEAPS = 12  # places along a path that is moved at random
_LEAP = 0.25  # of a joint's range, by which: standard deviation
_UNBOUNDED = np.pi / 2  # rad to either side of where a joint without limits starts
_TWISTS = (1.0, 6.0)  # that are guessed where as many as can be are wanted


def random_start(
    transcription: Transcription, rng: np.random.Generator, wild: bool = False
) -> Array:
    """Unknowns to start from, in no need to be possible.

    Parameters
    ----------
    transcription : Transcription
    rng : numpy.random.Generator
    wild : bool
        Whether the joints wave.
    """
    from scipy.interpolate import PchipInterpolator

    task, layout = transcription.task, transcription.layout
    knots = _WILD if wild else _KNOTS
    x = np.zeros(layout.unknowns)
    ends = [within(task.takeoff), _landed(task, rng)]
    s = np.arange(layout.nodes) / layout.intervals
    x[layout.angles] = ends[0] + s[:, None] * (ends[1] - ends[0])
    between = (np.arange(layout.intervals)[:, None] + layout.tableau.stages) / layout.intervals
    x[layout.within] = ends[0] + between[..., None] * (ends[1] - ends[0])
    start, end = within(task.start), within(task.end)
    low, high = _reach(task)
    middle, half = (low + high) / 2, _REACH * (high - low) / 2
    places = middle + half * rng.uniform(-1, 1, (knots, task.count))
    last = np.where(np.ptp(task.end, -1) > 0, middle + half * rng.uniform(-1, 1, task.count), end)
    path = PchipInterpolator(
        np.linspace(0, 1, knots + 2), np.concatenate([start[None], places, last[None]])
    )
    x[layout.q], x[layout.v], x[layout.w] = path(s), path(s, 1), path(s, 2)
    x[layout.duration] = np.clip(np.mean(task.duration), *task.duration)
    rate = (ends[1] - ends[0])[0]  # somersault in a duration
    x[layout.momentum] = _momentum(task, float(rate), float(x[layout.duration]))
    return np.clip(x, transcription.program.least, transcription.program.most)


def leap(transcription: Transcription, x: Array, rng: np.random.Generator) -> Array:
    """A solution whose joints are moved at random: beyond what is best near it there may be better.

    Parameters
    ----------
    transcription : Transcription
    x : array
        Its solution.
    rng : numpy.random.Generator
    """
    from scipy.interpolate import CubicSpline

    layout = transcription.layout
    low, high = _reach(transcription.task)
    steps = _LEAP * (high - low) * rng.normal(size=(_LEAPS, len(low)))
    steps[0] = 0.0
    path = CubicSpline(np.linspace(0, 1, _LEAPS), steps)
    s = np.arange(layout.nodes) / layout.intervals
    result = x.copy()
    for order, places in enumerate((layout.q, layout.v, layout.w)):
        result[places] += path(s, order)
    return np.clip(result, transcription.program.least, transcription.program.most)


def _reach(task: Task) -> tuple[Array, Array]:
    """Where each joint may well go."""
    start = within(task.start)
    low = np.maximum(task.moving.low, start - _UNBOUNDED)
    return low, np.minimum(task.moving.high, start + _UNBOUNDED)


def _landed(task: Task, rng: np.random.Generator) -> Array:
    landed = within(task.landing)
    if task.most is not None:
        least = task.landing[task.most, 0]
        first = least if np.isfinite(least) else within(task.takeoff)[task.most]
        landed[task.most] = first + 2 * np.pi * rng.uniform(*_TWISTS)
    return landed


def _momentum(task: Task, rate: float, duration: float) -> Array:
    """A momentum times T: that which is given, or of a body that turns at the rate."""
    if task.momentum is not None:
        return within(task.momentum) * duration
    return rate * _inertia(task)[task.model.axes[0] - 1]


@cache
def _inertia(task: Task) -> Array:
    """Of the body at takeoff."""
    return Equations(task.model).inertia(task.moving.coordinates(within(task.start).tolist()))


def refined(coarse: Transcription, x: Array, fine: Transcription) -> Array:
    """A solution on more intervals.

    Parameters
    ----------
    coarse : Transcription
    x : array
        Its solution.
    fine : Transcription
    """
    a, b = coarse.layout, fine.layout
    result = np.zeros(b.unknowns)
    at = np.arange(b.nodes) / b.intervals
    result[b.angles] = _angles(a, x, at)
    stages = (np.arange(b.intervals)[:, None] + b.tableau.stages) / b.intervals
    result[b.within] = _angles(a, x, stages.ravel()).reshape(*stages.shape, 3)
    for k, places in enumerate((b.q, b.v, b.w)):
        result[places] = _joints(a, x, at, k)
    result[b.momentum], result[b.duration] = x[a.momentum], x[a.duration]
    return np.clip(result, fine.program.least, fine.program.most)


def _where(layout: Layout, at: Array) -> tuple[Array, Array]:
    """Intervals, and places from 0 to 1 within them."""
    interval = np.minimum((at * layout.intervals).astype(int), layout.intervals - 1)
    return interval, at * layout.intervals - interval


def _joints(layout: Layout, x: Array, at: Array, k: int) -> Array:
    interval, c = _where(layout, at)
    places = (layout.q, layout.v, layout.w)
    return sum(
        weight[:, None] * x[places[which][interval + end]]
        for (which, end), weight in layout.along(c)[k].items()
    )


def _angles(layout: Layout, x: Array, at: Array) -> Array:
    """The polynomial through an interval's beginning, stages and end."""
    interval, c = _where(layout, at)
    known = np.concatenate([[0.0], layout.tableau.stages, [1.0]])
    through = np.concatenate(
        [x[layout.angles[:-1, None]], x[layout.within], x[layout.angles[1:, None]]], 1
    )
    powers = np.arange(len(known))
    weights = c[:, None] ** powers @ np.linalg.inv(known[:, None] ** powers)
    return np.einsum("tk,tka->ta", weights, through[interval])
