"""Histories against time, drawn once, with a line that goes along them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault.history import History
from somersault.view import style as look
from somersault.view._lettering import lines_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_IN_A_COLUMN = 6  # labels
_STYLES = ("-", ":", "-.", (0, (1, 3)), (0, (6, 3)))  # of lines that have the same colour
_STILL = 5e-3  # rad or m: joints that move less are left out
_NAMES_SIZE = 8  # points
_NAMES_SHARE = 0.68  # of the width, for the words in a line above the charts
_DOTS = 100  # an inch, where the picture is 720 pixels high


class Timeline:
    """A picture (height, width, 4) of a history's angles and joints; others are dashed.

    Parameters
    ----------
    histories : sequence of History
        The first in colours.
    labels : sequence of str
        What they are called; nothing needs to be said of one alone.
    width, height : int
        Pixels.
    """

    def __init__(
        self, histories: Sequence[History], labels: Sequence[str], width: int, height: int
    ) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
        from matplotlib.layout_engine import ConstrainedLayoutEngine

        dots = _DOTS * (min(height, 1.6 * width) / 720) ** 0.6  # letters shrink less than the rest
        with look.style():
            figure = Figure(
                (width / dots, height / dots),
                dots,
                facecolor=look.LIGHT["back"],
                layout=ConstrainedLayoutEngine(w_pad=0.12, h_pad=0.12),
            )
            axes = _drawn(figure, histories)
            if len(histories) > 1:
                _name_lines(axes[0], labels, width, dots)
            canvas = FigureCanvasAgg(figure)
            canvas.draw()
            self.picture: Array = np.array(canvas.buffer_rgba())
            boxes = [ax.get_window_extent() for ax in axes]
        self._limits = axes[0].get_xlim()
        self._left, self._right = boxes[0].x0, boxes[0].x1
        self._rows = [(round(height - box.y1), round(height - box.y0)) for box in boxes]
        self._thick = max(1, round(height / 480))

    def mark(self, picture: Array, moment: float) -> None:
        """Draw the line of a moment on a copy of the picture."""
        first, last = self._limits
        share = (moment - first) / (last - first)
        x = self._left + share * (self._right - self._left) - self._thick / 2
        start = int(np.floor(x))
        color = np.array(look.rgb(look.LIGHT["ink"])) * 255
        for column in range(start, start + self._thick + 1):
            cover = min(column + 1, x + self._thick) - max(column, x)
            if 0 <= column < picture.shape[1] and cover > 0:
                for top, bottom in self._rows:
                    line = picture[top:bottom, column, :3]
                    line[:] = line + cover * (color - line)


def _drawn(figure: Figure, histories: Sequence[History]) -> list[Axes]:
    first = histories[0]
    rows: list[tuple[str, list[tuple[str, str]]]] = []
    if first.model.free:
        rows = [
            ("somersault (turns)", [("somersault", look.LINES[0])]),
            ("tilt (°)", [("tilt", look.LINES[1])]),
            ("twist (turns)", [("twist", look.LINES[2])]),
        ]
    joints = _moving(histories)
    slides = [n for n in joints if _kind(first, n) == "slide"]
    turning = [n for n in joints if n not in slides and _kind(first, n) != "ball"]
    for words, names in (("joints (°)", turning), ("slides (m)", slides)):
        if names:
            rows.append(
                (words, [(n, look.LINES[k % len(look.LINES)]) for k, n in enumerate(names)])
            )
    axes = list(figure.subplots(len(rows) or 1, sharex=True, squeeze=False)[:, 0])
    times = first.times
    for ax, (words, lines) in zip(axes, rows, strict=False):
        for name, color in lines:
            for other in histories[:0:-1]:
                if name in _known(other):
                    ax.plot(other.times, _values(other, name), "--", color=color, lw=1, alpha=0.7)
            again = [n for n, other in lines if other == color].index(name)
            ax.plot(
                times, _values(first, name), ls=_STYLES[again % len(_STYLES)], color=color, lw=1.6,
                label=_worded(name),
            )  # fmt: skip
        if len(lines) > 1:
            columns = 1 + (len(lines) - 1) // _IN_A_COLUMN
            ax.legend(
                frameon=False, fontsize=7 if columns == 1 else 6, loc="best", handlelength=1.2,
                labelspacing=0.2, ncols=columns, columnspacing=1.0,
            )  # fmt: skip
        ax.set_ylabel(words if len(lines) > 1 else _alone(words, lines[0][0]), fontsize=9)
        ax.set_facecolor("white")
        ax.tick_params(labelsize=8.5)
        ax.margins(x=0)
    last = max(float(h.times[-1]) for h in histories)
    start = min(float(h.times[0]) for h in histories)
    axes[0].set_xlim(start, last if last > start else start + 1)
    axes[-1].set_xlabel("time (s)", fontsize=9)
    figure.align_ylabels(axes)
    return axes


def _name_lines(ax: Axes, labels: Sequence[str], width: int, dots: float) -> None:
    """Say above the first chart whose lines are drawn through, and whose are dashed: beside one
    another where there is room, else one below the other."""
    from matplotlib.lines import Line2D

    first, *others = labels
    kinds = [
        Line2D([], [], color=look.GREY, lw=1.6),
        Line2D([], [], color=look.GREY, lw=1, ls="--"),
    ]
    names = [first, others[0] if len(set(others)) == 1 else "the others"]
    half = [
        lines_of(name, _points(_NAMES_SIZE, dots), _NAMES_SHARE * width / 2, 1) for name in names
    ]
    beside = [line for (line,) in half] == names
    lines = [
        "\n".join(lines_of(name, _points(_NAMES_SIZE, dots), _NAMES_SHARE * width, 2))
        for name in names
    ]
    said = [look.literal(name) for name in (names if beside else lines)]
    ax.legend(
        kinds, said, frameon=False, fontsize=_NAMES_SIZE, ncols=2 if beside else 1,
        loc="lower left", bbox_to_anchor=(0, 1), borderaxespad=0.1, handlelength=2,
    )  # fmt: skip


def _points(size: float, dots: float) -> float:
    """Letters of so many points, in pixels."""
    return size * dots / 72


def _alone(words: str, name: str) -> str:
    """What stands beside a chart of one line: its name, with the unit of the others."""
    return f"{_worded(name)} {words[words.index('(') :]}"


def _worded(name: str) -> str:
    return look.literal(name.replace("_", " "))


def _moving(histories: Sequence[History]) -> list[str]:
    """The first one's joints that move in any; all, if none does and there is nothing else."""
    model = histories[0].model
    moving = {
        name
        for history in histories
        for name, values in zip(history.model.coordinates, history.joint_coordinates.T, strict=True)
        if np.ptp(values) > _STILL
    }
    shown = [name for name in model.coordinates if name in moving]
    return shown if shown or model.free else list(model.coordinates)


def _known(history: History) -> tuple[str, ...]:
    return ("somersault", "tilt", "twist", *history.model.coordinates)


def _kind(history: History, coordinate: str) -> str:
    """Of the joint that a coordinate is of."""
    model = history.model
    place = model.coordinates.index(coordinate)
    for joint in model.joints:
        where = model.coordinate_slice(joint.name)
        if where.start <= place < where.stop:
            return joint.kind
    raise AssertionError(coordinate)


def _values(history: History, name: str) -> Array:
    """A quantity as people read it: turns, degrees, metres."""
    if name == "tilt":
        return np.degrees(history.angles[:, 1])
    if name in ("somersault", "twist"):
        return history.angles[:, 0 if name == "somersault" else 2] / (2 * np.pi)
    values = history.joint_coordinates[:, history.model.coordinates.index(name)]
    return values if _kind(history, name) == "slide" else np.degrees(values)
