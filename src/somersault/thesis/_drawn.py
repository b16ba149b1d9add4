"""The numbers that a picture shows, read from the picture itself."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.array import Array
from somersault.view import style as look

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_HEADER = ("panel", "x axis", "y axis", "drawn as", "name", "x", "y", "value")
_Series = tuple[str, str, Array]  # what it is drawn as, its name, and rows x, y and value


def drawn(figure: Figure) -> str | None:
    """What stands on a picture's axes as CSV, a point a row; None where no numbers do.

    Lines, dots, bands, bars, regions and maps count. Words, arrows and bodies do not, nor lines
    that go from edge to edge.
    """
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(_HEADER)
    some = False
    for place, ax in enumerate(figure.axes, 1):
        if not ax.axison or ax.get_label() == "<colorbar>":
            continue
        panel = ax.get_title("left") or ax.get_title() or str(place)
        axes = [plain(words) for words in (panel, ax.get_xlabel(), ax.get_ylabel())]
        for kind, name, rows in _series(ax):
            shown = rows[~np.isnan(rows[:, :2]).any(1)]
            some |= bool(len(shown))
            table.writerows([*axes, kind, plain(name), *map(_number, row)] for row in shown)
    return text.getvalue() if some else None


def plain(words: str) -> str:
    """Words of a picture without the signs of mathematical type, on one line."""
    for sign in ("$", "{", "}", "\\"):
        words = words.replace(sign, "")
    return " ".join(words.split())


def _series(ax: Axes) -> Iterator[_Series]:
    from matplotlib.contour import ContourSet

    for line in ax.get_lines():
        if line.get_transform() == ax.transData and len(np.atleast_1d(line.get_xdata())) > 0:
            x, y = line.get_data()
            yield "line", _name(line), _rows(_numbers(x), _numbers(y))
    for bars in ax.containers:
        for bar in getattr(bars, "patches", ()):
            yield "bar", _name(bars), _rows([bar.get_x() + bar.get_width() / 2], [bar.get_height()])
    for part in ax.collections:
        yield from _of_contours(part) if isinstance(part, ContourSet) else _of_collection(ax, part)


def _of_collection(ax: Axes, part: Any) -> Iterator[_Series]:
    from matplotlib.collections import LineCollection, PathCollection, PolyCollection, QuadMesh

    values = None if part.get_array() is None else np.ma.filled(part.get_array(), np.nan).ravel()
    numbers: Any  # of any shape, says matplotlib
    if isinstance(part, PathCollection):
        numbers = np.ma.filled(part.get_offsets(), np.nan)
        yield "dots", _name(part), _rows(numbers[:, 0], numbers[:, 1], values)
    elif isinstance(part, QuadMesh):
        numbers = part.get_coordinates()
        middles = ((numbers[:-1, :-1] + numbers[1:, 1:]) / 2).reshape(-1, 2)
        yield "map", _name(part), _rows(middles[:, 0], middles[:, 1], values)
    elif isinstance(part, PolyCollection | LineCollection) and part.get_transform() == ax.transData:
        for path in part.get_paths():
            kind, numbers = "edge of a band", path.vertices
            if isinstance(part, LineCollection):
                kind = "line"
            yield kind, _name(part), _rows(numbers[:, 0], numbers[:, 1])


def _of_contours(part: Any) -> Iterator[_Series]:
    kind = "edge of a region" if part.filled else "contour"
    levels = part.layers if part.filled else part.levels
    for level, path in zip(levels, part.get_paths(), strict=True):
        for corners in path.to_polygons(closed_only=False):
            values = np.full(len(corners), float(level))
            yield kind, _name(part), _rows(corners[:, 0], corners[:, 1], values)


def _name(artist: Any) -> str:
    """What its legend calls it; its colour, where it has no other name."""
    label = str(artist.get_label())
    if label and not label.startswith("_"):
        return label
    color = getattr(artist, "get_color", lambda: "")()
    return look.NAMES.get(color, color) if isinstance(color, str) else ""


def _numbers(values: Any) -> Array:
    return np.asarray(values, float).ravel()


def _rows(x: Any, y: Any, values: Any = None) -> Array:
    given = (
        np.full(np.size(x), np.nan) if values is None or np.size(values) != np.size(x) else values
    )
    return np.stack([np.asarray(column, float) for column in (x, y, given)], -1)


def _number(value: float) -> str:
    """Six digits, which is more than a picture shows; nothing where there is none."""
    return "" if value != value else f"{value + 0.0:.6g}"
