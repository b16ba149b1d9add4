"""A picture of a trade-off: the front with its intervals, and what is chosen along it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault.view import style as look

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_MOST_LINES = 7


def plot_front(data: xr.Dataset, first: xr.Dataset, searched: Array, parts: Array) -> Figure:
    """The first objective against each of the others, and then what is chosen.

    `searched` (N, objectives) are the figures of all candidates on the starts of the search,
    `parts` (points, chosen) where the front is between the bounds.
    """
    others = range(1, data.sizes["objective"])
    lines = parts.shape[1] <= _MOST_LINES
    columns = len(others) + lines
    with look.style():
        picture = look.figure(4.3 * columns, 3.9)
        axes = np.ravel(picture.subplots(1, columns, squeeze=False))
        figures, beaten = data["figure"].values, data["beaten"].values
        off = np.abs(np.stack([data["low"].values, data["high"].values]) - figures)
        for k, ax in zip(others, axes, strict=False):
            ax.plot(searched[:, k], searched[:, 0], ".", ms=3, color=look.LIGHT_TO_DARK[1],
                    label="candidates, starts of the search")  # fmt: skip
            for which, fill, words in (
                (~beaten, look.BLUE, "front, other starts"), (beaten, "white", "beaten there"),
            ):  # fmt: skip
                if which.any():
                    ax.errorbar(
                        figures[which, k], figures[which, 0], off[:, which, 0], off[:, which, k],
                        "o", ms=4, lw=1, color=look.BLUE, mfc=fill, label=words,
                    )  # fmt: skip
            at_first = first["figure"].values
            ax.plot(at_first[k], at_first[0], "s", ms=5, color=look.ORANGE, label="at first")
            ax.set(xlabel=_named(data, k), ylabel=_named(data, 0))
            ax.margins(0.08)
        axes[0].legend(fontsize=7, frameon=False)
        if lines:
            order = [k for k in np.argsort(figures[:, 1]) if not beaten[k]]
            for name, row, color in zip(data["quantity"].values, parts.T, look.LINES, strict=False):
                axes[-1].plot(
                    figures[order, 1], 100 * row[order], "o-", ms=3, lw=1, color=color, label=name
                )
            axes[-1].set(
                xlabel=_named(data, 1), ylabel="chosen, % of the way between the bounds",
                ylim=(-4, 104),
            )  # fmt: skip
            axes[-1].legend(fontsize=8, frameon=False)
        return picture


def _named(data: xr.Dataset, k: int) -> str:
    words, unit = str(data["objective"].values[k]), str(data["units"].values[k])
    return look.literal(f"{words} ({unit})" if unit not in ("", "1") else words)
