"""A history against time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from somersault._core.checks import text
from somersault.view import style as look
from somersault.view._look import several

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from somersault.history import History

_MOST_LABELS = 14


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
    for column, (name, color) in enumerate(zip(("tilt", "twist"), look.LINES, strict=False), 1):
        axes[1].plot(time, angles[:, column], color=color)
        axes[1].annotate(f" {name}", (time[-1], angles[-1, column]), color=color, va="center")
    axes[1].set_ylabel("tilt, twist (rad)")
    for index, name in enumerate(joints):
        color = look.LINES[index % len(look.LINES)]
        values = history.joint_coordinates[:, index]
        axes[2].plot(time, values, color=color)
        if len(joints) <= _MOST_LABELS:
            axes[2].annotate(f" {name}", (time[-1], values[-1]), color=color, va="center")
    if joints:
        axes[2].set_ylabel("joints (rad, m)")
    for ax in axes:
        ax.spines[["top", "right"]].set_visible(False)
    axes[-1].set_xlabel("time (s)")
    axes[0].set_title(title or history.model.name, loc="left")
    return picture
