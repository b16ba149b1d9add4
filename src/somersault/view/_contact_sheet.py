"""Contact sheets: a motion as rows of pictures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import shown, text, truth, whole_number
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number, numbers
from somersault.attitude import matrix_from_quaternion
from somersault.view import _figure as parts
from somersault.view import style as look
from somersault.view._lettering import tidy
from somersault.view._look import several

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from somersault.history import History

_MOST_COLUMNS = 100
_VIEW = (35.0, 12.0)  # degrees: from the front, a little to the left and above


def contact_sheet(
    history: History,
    times: Sequence[float] | Array,
    columns: int = 8,
    view: tuple[float, float] = _VIEW,
    title: str = "",
) -> Figure:
    """Pictures of a motion at some times, in rows, each with its time and its angles.

    The centre of mass stands still.

    Parameters
    ----------
    history : History
        A flight, a swing, a recording.
    times : sequence of float
        s; each picture is of the sample nearest to the time asked for.
    columns : int
        Pictures in a row.
    view : (float, float)
        Azimuth and elevation of the camera in degrees, from the front towards the left and up, as
        the model's `axes` have them with no turn of the base.
    title : str, optional

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    SomersaultError
        For what is none of these, with what to give.

    Examples
    --------
    >>> import somersault as so
    >>> from somersault.view import contact_sheet
    >>> flight = so.arm_tilt().fly()
    >>> picture = contact_sheet(flight, [0.0, 0.2, 0.4], columns=3)
    """
    (history,) = several("history", history, 1, 1)
    times = _moments(times)
    columns = whole_number("columns", columns, 1, _MOST_COLUMNS)
    azimuth, elevation = numbers("view", view, 2).tolist()
    rows = -(-len(times) // columns)
    made = look.figure(1.15 * columns, 1.75 * rows + 0.3)
    grid = made.subplots(rows, 1, squeeze=False)[:, 0]
    size = _size(history, times)
    for row, ax in enumerate(grid):
        part = times[row * columns : (row + 1) * columns]
        strip(ax, history, part, columns, (azimuth, elevation), size=size)
    if text("title", title):
        made.suptitle(look.literal(title), fontsize=10)
    return made


def strip(
    ax: Axes,
    history: History,
    times: Sequence[float] | Array,
    columns: int | None = None,
    view: tuple[float, float] = _VIEW,
    words: bool = True,
    size: float | None = None,
) -> None:
    """One row of pictures of a motion on axes of their own.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
    history, times, view
        As in `contact_sheet`.
    columns : int, optional
        Pictures that the row has room for: as many as there are times, if it is not given.
    words : bool
        Whether the time and the angles stand below each.
    size : float, optional
        Room for each, in m from its centre of mass: as far as any of them reaches, if it is not
        given.

    Raises
    ------
    SomersaultError
        For what is none of these, with what to give.

    Examples
    --------
    >>> import somersault as so
    >>> from matplotlib.figure import Figure
    >>> flight, axes = so.fly("furrer", so.Takeoff(spin=8.6), 0.5), Figure().subplots()
    >>> so.view.strip(axes, flight, [0.0, 0.25, 0.5])
    """
    _require_axes(ax)
    (history,) = several("history", history, 1, 1)
    times = _moments(times)
    truth("words", words)
    model = history.model
    size = _size(history, times) if size is None else number("size", size)
    if size <= 0:
        raise SomersaultError(f"size {size:g} m is no room; give a positive distance")
    azimuth, elevation = numbers("view", view, 2).tolist()
    seen = parts.camera(azimuth, elevation, model.axes)
    count = len(times) if columns is None else whole_number("columns", columns, 1, _MOST_COLUMNS)
    for place, moment in enumerate(times):
        k = _nearest(history, moment)
        turn = matrix_from_quaternion(history.base_quaternion[k])
        x = 1.7 * size * place
        parts.draw_pose(ax, model, history.joint_coordinates[k], turn, seen, (x, 0.0))
        if words:
            text = _words(history, k)
            look.label(ax, x, -1.12 * size, text, look.GREY, ha="center", va="top", fontsize=7.5)
    ax.set(xlim=(-0.95 * size, (1.7 * count - 0.75) * size))
    ax.set_ylim(-(1.9 if words else 1.1) * size, 1.1 * size)
    ax.set_aspect("equal")
    ax.axis("off")


def _require_axes(ax: object) -> None:
    from matplotlib.axes import Axes

    if not isinstance(ax, Axes):
        raise SomersaultError(f"ax must be the axes of a Matplotlib figure, and is {shown(ax)}")


def _moments(times: Sequence[float] | Array) -> Array:
    """Times to draw, at least one."""
    moments = numbers("times", times)
    if not moments.size:
        raise SomersaultError("times are none; give at least one of the motion")
    return moments


def _words(history: History, k: int) -> str:
    """The time and, of what is free in the air, the turns."""
    time = f"{tidy(history.times[k])} s"
    if not history.model.free:
        return time
    somersault, _, twist = history.angles[k]
    turns, degrees = tidy(somersault / (2 * np.pi)), tidy(np.degrees(twist), 0)
    return f"{time}\n{turns} turns\ntwist {degrees}°"


def _nearest(history: History, moment: float) -> int:
    """The sample nearest to a time."""
    return int(np.argmin(np.abs(history.times - moment)))


def _size(history: History, times: Sequence[float] | Array) -> float:
    """How far the model reaches from its centre of mass at most in its poses at some times, m."""
    q = history.joint_coordinates[[_nearest(history, t) for t in times]]
    return max(
        float(np.linalg.norm(points, axis=-1).max()) + radius
        for _, points, radius in parts.hulls(history.model, q)
    )
