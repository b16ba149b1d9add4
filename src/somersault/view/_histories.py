"""A history against time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import text
from somersault.view import style as look
from somersault.view._look import several

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from somersault.history import History

_MOST_LABELS = 12
_STILL = 5e-3  # rad or m: joints that move less go without a name
_LINE = 0.09  # of the height of a chart, for a name


def time_histories(history: History, title: str = "") -> Figure:
    """Somersaults, tilt and twist, and joint angles against time.

    Parameters
    ----------
    history : History
        A flight, a swing, a recording.
    title : str, optional
        The model's name, if it is not given.

    Returns
    -------
    matplotlib.figure.Figure
        Its `.savefig(file)` writes it.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import somersault as so
    >>> flight = so.fly("furrer", so.Takeoff(spin=8.6, tilt=0.05), 0.5)
    >>> with TemporaryDirectory() as folder:
    ...     so.view.time_histories(flight).savefig(f"{folder}/flight.svg")
    """
    from matplotlib.figure import Figure

    (history,) = several("history", history, 1, 1)
    title = text("title", title)
    time, angles, joints = history.times, history.angles, history.model.coordinates
    rows = 3 if joints else 2
    picture = Figure(figsize=(7.2, 1.2 + 1.9 * rows), layout="constrained")
    axes = picture.subplots(rows, sharex=True)
    axes[0].plot(time, angles[:, 0] / (2 * np.pi), color=look.LINES[0])
    axes[0].set_ylabel("somersaults")
    for column, color in enumerate(look.LINES[:2], 1):
        axes[1].plot(time, angles[:, column], color=color)
    _name_ends(axes[1], ("tilt", "twist"), angles[-1, 1:], look.LINES[:2])
    axes[1].set_ylabel("tilt, twist (rad)")
    if joints:
        colors = [look.LINES[k % len(look.LINES)] for k in range(len(joints))]
        for values, color in zip(history.joint_coordinates.T, colors, strict=True):
            axes[2].plot(time, values, color=color)
        moving = np.ptp(history.joint_coordinates, axis=0) > _STILL
        named = np.flatnonzero(moving if moving.any() else ~moving)[:_MOST_LABELS]
        _name_ends(
            axes[2],
            [joints[k].replace("_", " ") for k in named],
            history.joint_coordinates[-1, named],
            [colors[k] for k in named],
        )
        axes[2].set_ylabel("joints (rad, m)")
    for ax in axes:
        ax.spines[["top", "right"]].set_visible(False)
    axes[-1].set_xlabel("time (s)")
    axes[0].set_title(look.literal(title or history.model.name), loc="left")
    return picture


def _name_ends(ax: Axes, names: Sequence[str], ends: Array, colors: Sequence[str]) -> None:
    """Name lines behind their ends, no name on another."""
    low, high = ax.get_ylim()
    heights = _apart((ends - low) / (high - low), _LINE)
    for name, height, color in zip(names, heights, colors, strict=True):
        ax.text(1.01, height, look.literal(name), color=color, va="center", transform=ax.transAxes)


def _apart(heights: Array, least: float) -> Array:
    """Heights moved as little as it takes, in their order, to be `least` apart."""
    order = np.argsort(heights, kind="stable")
    # How far each may be from the first that it pushes: a rising line through the rest.
    rest = heights[order] - least * np.arange(len(heights))
    placed = np.empty_like(heights)
    placed[order] = _rising(rest) + least * np.arange(len(heights))
    return placed


def _rising(values: Array) -> Array:
    """The nearest values, by least squares, that never fall: neighbours that do are averaged."""
    blocks: list[list[float]] = []  # sum and count
    for value in values:
        blocks.append([value, 1])
        while len(blocks) > 1 and blocks[-2][0] * blocks[-1][1] > blocks[-1][0] * blocks[-2][1]:
            total, count = blocks.pop()
            blocks[-1] = [blocks[-1][0] + total, blocks[-1][1] + count]
    return np.array([total / count for total, count in blocks for _ in range(int(count))])
