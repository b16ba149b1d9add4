"""Pictures of what `somersault.stability` returns, for any model."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.checks import shown
from somersault._core.errors import SomersaultError
from somersault.view.charts import filled, locus, resonance_curves, stroboscopic
from somersault.view.style import BLUE, GREEN, figure, label, literal, style

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


def stability_chart(chart: xr.Dataset) -> Figure:
    """The stable region of a `stability.chart`; where the energy is definite, and curves on which
    modes are in resonance, if they were asked for.

    Thick curves are explosive resonances of order three, which leave nothing stable; dashed ones
    explosive ones of higher order; dotted grey ones only exchange energy between modes.

    Parameters
    ----------
    chart : xarray.Dataset

    Returns
    -------
    matplotlib.figure.Figure

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import somersault as so
    >>> arms, springs = ("pose.shoulder", [0.5, 1.3]), ("stiffness.shoulder", [0.5, 1.2])
    >>> chart = so.stability.chart("furrer", arms, springs)
    >>> with TemporaryDirectory() as folder:
    ...     so.view.stability_chart(chart).savefig(f"{folder}/chart.svg")
    """
    _require("chart", chart, "stable")
    y_name, x_name = (str(name) for name in chart.stable.dims)
    x, y = chart[x_name].values, chart[y_name].values
    with style():
        picture = figure()
        axes = picture.subplots()
        axes.set(xlabel=_axis(chart, x_name), ylabel=_axis(chart, y_name))
        axes.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
        whole = "" if chart.attrs["subsystem"] == "all" else f", part of {chart.attrs['subsystem']}"
        title = f"Spins of {chart.attrs['model']} about axis {chart.attrs['axis']}{whole}"
        axes.set_title(literal(title))
        _region(axes, x, y, chart.stable.values, BLUE, "stable", "nowhere stable")
        if "definite" in chart:
            survives, does_not = (
                "definite: survives damping",
                "nowhere definite: damping destroys it",
            )
            _region(axes, x, y, chart.definite.values, GREEN, survives, does_not)
        if "detuning" in chart:
            resonance_curves(axes, chart)
            if axes.get_legend_handles_labels()[0]:
                axes.legend(loc="upper right", fontsize=8, frameon=False)
        picture.draw_without_rendering()
    return picture


def _region(
    axes: Any, x: Any, y: Any, inside: Any, color: str, somewhere: str, nowhere: str
) -> None:
    if inside.all():
        axes.set_facecolor("#dfe9f3")
    elif inside.any():
        filled(axes, x, y, inside, color=color, edge=color, alpha=0.35)
    column = int(np.argmax(inside.sum(0))) if inside.any() else len(x) // 2
    rows = np.flatnonzero(inside[:, column])
    row = rows[len(rows) // 2] if rows.size else len(y) // 2
    along = (x[column] - x[0]) / (x[-1] - x[0])  # words stay within the frame
    side = "left" if along < 0.25 else "right" if along > 0.75 else "center"
    label(axes, x[column], y[row], somewhere if rows.size else nowhere, color, ha=side)


def root_loci(loci: xr.Dataset) -> Figure:
    """The roots of a `stability.root_locus`, darker as the quantity rises.

    Parameters
    ----------
    loci : xarray.Dataset

    Returns
    -------
    matplotlib.figure.Figure

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import somersault as so
    >>> along = ("stiffness.shoulder", [0.5, 1.0, 1.5])
    >>> loci = so.stability.root_locus("furrer", along, pose={"shoulder": 1.3})
    >>> with TemporaryDirectory() as folder:
    ...     so.view.root_loci(loci).savefig(f"{folder}/roots.svg")
    """
    _require("root_locus", loci, "growth")
    (name,) = (str(n) for n in loci.coords)
    values = loci[name].values
    roots = loci.growth.values + 1j * loci.frequency.values
    with style():
        picture = figure(6.2, 5.4)
        axes = picture.subplots()
        dots = locus(axes, values, roots)
        stroboscopic(axes)
        picture.colorbar(dots, label=_axis(loci, name), shrink=0.7)
        title = f"Roots of {loci.attrs['model']} about axis {loci.attrs['axis']}"
        axes.set_title(literal(title))
        picture.draw_without_rendering()
    return picture


def _axis(data: xr.Dataset, name: str) -> str:
    kind, _, rest = name.partition(".")
    return literal(f"{kind} of {rest.replace('_', ' ')} ({data[name].attrs['units']})")


def _require(made_by: str, data: Any, variable: str) -> None:
    """SomersaultError for what is not a dataset of that function's."""
    import xarray as xr

    if not isinstance(data, xr.Dataset) or variable not in data:
        raise SomersaultError(
            f"what is drawn must be what somersault.stability.{made_by} gives, not {shown(data)}"
        )
