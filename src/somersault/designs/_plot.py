"""A picture of a design: how the search went, and how sharp the optimum is."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault.view import style as look

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from somersault.designs._choose import Choose

_COLUMNS = 3
_SHORT = 5.0  # times as much at its end: too few of 1, 2, 5, 10, … lie along such an axis


def plot(
    history: xr.Dataset, around: xr.Dataset, chosen: Mapping[str, Choose],
    best: Mapping[str, float], figure: float, interval: tuple[float, float],
    polished: float | None,
) -> Figure:  # fmt: skip
    """Left the best figure so far; then the figure along each chosen quantity, the others staying.

    The horizontal line and its band are the best candidate's `figure` on held-out starts and its
    confidence interval. A figure to which the best was `polished` stands after the candidates.
    """
    with look.style():
        names = [str(name) for name in around["quantity"].values]
        columns = min(_COLUMNS, 1 + len(names))
        rows = -(-(1 + len(names)) // columns)
        picture = look.figure(3.1 * columns, 2.7 * rows)
        axes = np.ravel(picture.subplots(rows, columns, squeeze=False))
        judged = np.arange(1, history.sizes["generation"] + 1) * history.sizes["candidate"]
        axes[0].plot(judged, history["best"], color=look.BLUE)
        axes[0].set(xlabel="candidates", title="best so far, starts of the search")
        if polished is not None:
            drop = [float(history["best"][-1]), polished]
            axes[0].plot([judged[-1]] * 2, drop, ":", color=look.BLUE)
            axes[0].plot(judged[-1], polished, "o", ms=4, color=look.BLUE)
            axes[0].annotate(
                "polished", (judged[-1], polished), (-6, 0), textcoords="offset points",
                ha="right", va="center",
            )  # fmt: skip
        for ax, name in zip(axes[1:], names, strict=False):
            row = around.sel(quantity=name)
            ax.plot(row["value"], row["figure"], "o-", ms=3, color=look.BLUE)
            ax.axvline(best[name], color=look.GREY, lw=1, ls="--")
            ax.set(xlabel=_with_unit(name, chosen[name].unit))
            if chosen[name].scale == "log":
                ax.set_xscale("log")
                _spell_out(ax.xaxis)
            else:
                ax.locator_params("x", nbins=4)
        for ax in axes[: 1 + len(names)]:
            ax.axhspan(*interval, color=look.ORANGE, alpha=0.25, lw=0)
            ax.axhline(figure, color=look.ORANGE, lw=1)
        axes[0].set_ylabel(_with_unit(history.attrs["objective"], history["best"].attrs["units"]))
        for ax in axes[1 + len(names) :]:
            ax.set_visible(False)
        return picture


def plot_map(data: xr.Dataset, chosen: Mapping[str, Choose], best: Mapping[str, float]) -> Figure:
    """The figure over two chosen quantities, with the best marked."""
    up, across = (str(name) for name in data["figure"].dims)
    with look.style():
        picture = look.figure(5.4, 4.2)
        ax = picture.subplots()
        shown = ax.contourf(data[across], data[up], data["figure"], 12, cmap=look.darkening())
        ax.plot(best[across], best[up], "o", color=look.ORANGE, ms=7, mec="white")
        ax.set(
            xlabel=_with_unit(across, chosen[across].unit), ylabel=_with_unit(up, chosen[up].unit)
        )
        for name, axis, scaled in (
            (across, ax.xaxis, ax.set_xscale), (up, ax.yaxis, ax.set_yscale),
        ):  # fmt: skip
            if chosen[name].scale == "log":
                scaled("log")
                _spell_out(axis)
        words = _with_unit(data.attrs["objective"], data["figure"].attrs["units"])
        picture.colorbar(shown, ax=ax).set_label(words)
        return picture


def _spell_out(axis: Any) -> None:
    """Numbers along a logarithmic axis as people write them, and few along a short one."""
    from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

    low, high = axis.get_view_interval()
    short = high < _SHORT * low
    axis.set_major_locator(
        MaxNLocator(4, steps=(1, 2, 5, 10)) if short else LogLocator(subs=(1.0, 2.0, 5.0))
    )
    axis.set_major_formatter("{x:g}")
    axis.set_minor_formatter(NullFormatter())


def _with_unit(name: str, unit: str) -> str:
    return f"{name} ({unit})" if unit not in ("", "1") else name
