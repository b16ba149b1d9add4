"""Stability charts, root loci and the square of inertia ratios."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault.view.style import (
    BLACK,
    BLUE,
    GREY,
    ORANGE,
    PURPLE,
    SKY,
    VERMILION,
    darkening,
    label,
)

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes


def chart_axes(ax: Axes, title: str = "") -> None:
    """The frame of a chart of arm angle against shoulder stiffness."""
    ax.set(xlim=(0, 3), ylim=(-2, 4), xlabel="arm angle Γ (rad)", title=title)
    ax.set_ylabel("shoulder stiffness $K_{sh}$ = k/(Ω² $I_{sh}$)")
    ax.axhline(0, color=GREY, lw=0.6, zorder=0)
    for angle, name in ((0.0, "hands at thighs"), (np.pi / 2, "arms straight out")):
        label(ax, angle + 0.03, -1.88, name, GREY, fontsize=8)
    ax.axvline(np.pi / 2, color=GREY, lw=0.6, ls=":", zorder=0)


def filled(
    ax: Axes,
    x: ArrayLike,
    y: ArrayLike,
    stable: ArrayLike,
    color: str = SKY,
    edge: str | None = BLUE,
    alpha: float = 0.55,
) -> None:
    """A region of points that are true, filled and outlined.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
    x, y : array_like
    stable : array_like of bool, (y, x)
    color, edge : str, optional
        Of the region and its outline; no outline for None.
    alpha : float
        Opacity.
    """
    values = np.asarray(stable, float)
    ax.contourf(x, y, values, levels=[0.5, 1.5], colors=[color], alpha=alpha, zorder=1)
    if edge is not None:
        ax.contour(x, y, values, levels=[0.5], colors=[edge], linewidths=1.2, zorder=2)


def band(
    ax: Axes,
    x: Array,
    low: Array,
    high: Array,
    color: str = SKY,
    edge: str | None = BLUE,
    alpha: float = 0.55,
) -> None:
    """The region between two edges.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
    x, low, high : ndarray
        Where there is none, the edges are NaN.
    color, edge : str, optional
        Of the region and its edges; no edges for None.
    alpha : float
        Opacity.
    """
    ax.fill_between(x, low, high, color=color, alpha=alpha, lw=0, zorder=1)
    if edge is not None:
        for line in (low, high):
            ax.plot(x, line, color=edge, lw=1.2, zorder=2)


def resonance_curves(ax: Axes, chart: xr.Dataset, exchange: bool = True) -> None:
    """Where modes are in resonance, on a `stability.chart` that was asked for it.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
    chart : xarray.Dataset
        With `detuning` and `explosive`.
    exchange : bool
        Whether to draw those, too, that only exchange energy between modes.
    """
    y, x = (chart[name].values for name in chart.stable.dims)
    colors = {True: cycle([VERMILION, BLACK]), False: cycle([ORANGE, PURPLE, GREY])}
    said = False
    for k, name in enumerate(chart.resonance.values.tolist()):
        off, bursts = chart.detuning.values[k], chart.explosive.values[k]
        cubic = int(chart.order[k]) == 3
        way, width = ("-", 2.2) if cubic else ("--", 1.2)
        where = np.where(bursts, off, np.nan)
        if _crosses(where) and _zeros(ax, x, y, where, color := next(colors[cubic]), way, width):
            ax.plot([], [], way, color=color, lw=width, label=name)
        if exchange and _zeros(ax, x, y, np.where(bursts, np.nan, off), GREY, ":", 0.9):
            ax.plot([], [], ":", color=GREY, lw=0.9, label=None if said else "exchange only")
            said = True


def _zeros(ax: Axes, x: Array, y: Array, off: Array, color: str, way: str, width: float) -> bool:
    """The curves on which a quantity (y, x) is zero; False if there are none."""
    if not _crosses(off):
        return False
    made = ax.contour(x, y, off, [0.0], colors=[color], linewidths=width, linestyles=way, zorder=3)
    return any(np.size(path.vertices) for path in made.get_paths())


def _crosses(off: Array) -> bool:
    known = off[np.isfinite(off)]
    return bool(known.size and known.min() <= 0 <= known.max())


def locus(
    ax: Axes,
    values: Array,
    roots: Array,
    *,
    size: float = 6.0,
    arrows: tuple[float, ...] = (),
) -> Any:
    """Roots as dots that darken as a value rises.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
    values : ndarray, (values,)
    roots : ndarray, (values, roots)
        Complex, in units of Ω.
    size : float
        Of the dots.
    arrows : tuple of float
        Values at which arrow heads show which way the roots move.

    Returns
    -------
    matplotlib mappable
        For a colour bar.
    """
    shade = np.broadcast_to(values[:, None], roots.shape)
    ax.axvline(0, color=GREY, lw=0.8, zorder=0)
    ax.axhline(0, color=GREY, lw=0.8, zorder=0)
    made = ax.scatter(
        roots.real.ravel(),
        roots.imag.ravel(),
        c=shade.ravel(),
        s=size,
        cmap=darkening(),
        linewidths=0,
        zorder=3,
        rasterized=True,
    )
    ax.set(xlabel="real part (growth), units of Ω", ylabel="imaginary part, units of Ω")
    ax.set_aspect("equal", adjustable="datalim")
    for value in arrows:
        _arrows(ax, values, roots, value)
    return made


def _arrows(ax: Axes, values: Array, roots: Array, value: float) -> None:
    """Arrow heads that show which way the roots move as the parameter passes a value."""
    here = int(np.argmin(np.abs(values - value)))
    for root in roots[here]:
        later = roots[here + 1][np.argmin(np.abs(roots[here + 1] - root))]
        step = later - root
        if not 1e-6 < abs(step) < 0.2:
            continue
        tip = root + 0.05 * step / abs(step)
        ax.annotate(
            "",
            (tip.real, tip.imag),
            (root.real, root.imag),
            arrowprops={"arrowstyle": "-|>", "color": BLACK, "lw": 1.0, "mutation_scale": 11},
            zorder=6,
        )


def stroboscopic(ax: Axes, offset: float = 0.12, text: str = "") -> None:
    """Rings around the roots at ±i."""
    ax.plot([0, 0], [1, -1], "o", mfc="none", mec=BLACK, ms=9, zorder=7)
    for y in (1, -1):
        label(ax, offset, y, text or f"{'+' if y > 0 else '−'}i: stroboscopic mode, does not move")


def square(ax: Axes, title: str = "") -> None:
    """The square of inertia ratios, with its quadrants' lines."""
    ax.set(xlim=(-1, 1), ylim=(-1, 1), title=title)
    ax.set_aspect("equal")
    ax.set_xticks([-1, 0, 1])
    ax.set_yticks([-1, 0, 1])
    ax.axhline(0, color=GREY, lw=0.8, zorder=3)
    ax.axvline(0, color=GREY, lw=0.8, zorder=3)


def growth_curves(ax: Axes, angles: tuple[float, ...], where: tuple[float, ...]) -> None:
    """Curves of constant Φ = ln 10/√(−k1 k3) in the quadrant k1 > 0, k3 < 0, labelled.

    `where` holds each label's k1.
    """
    for angle, k1 in zip(angles, where, strict=True):
        product = (np.log(10) / angle) ** 2
        x = np.linspace(max(product, 1e-3), 1, 200)
        ax.plot(x, -product / x, color=GREY, lw=0.9, zorder=1)
        label(ax, k1, -product / k1, f"{angle:g}", GREY, fontsize=8, ha="center")
