"""Pictures of an ensemble: a map over two grids, a band over one, a histogram over none."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.errors import SomersaultError
from somersault.ensembles._plan import OVER_TIME, SAMPLE
from somersault.ensembles._summary import quantiles, reported
from somersault.simulation import LANDING_ERROR
from somersault.view import style as look

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_MOST_BINS = 60


def plot(data: xr.Dataset, name: str | None = None) -> Figure:
    """A picture of a reported quantity (landing_error, or the first, where none is named)."""
    if name is None:
        names = [str(n) for n, v in data.data_vars.items() if v.dtype.kind == "f" and n != "time"]
        name = LANDING_ERROR if LANDING_ERROR in names else names[0]
    values = reported(data, name)
    grids = [str(d) for d in values.dims if d not in (SAMPLE, OVER_TIME)]
    if OVER_TIME in values.dims or len(grids) > 2:
        raise SomersaultError(
            f"{name} is over {', '.join(map(str, values.dims))}: draw a part of it"
        )
    with look.style():
        picture = look.figure(6.4, 4.4)
        ax = picture.subplots()
        if len(grids) == 2:
            _map(picture, ax, data, values, grids)
        elif grids:
            _band(ax, data, values, grids[0])
        else:
            _histogram(ax, values)
    return picture


def _named(values: xr.DataArray) -> str:
    unit = values.attrs.get("units", "")
    plain = str(values.name).replace("_", " ")
    return look.literal(f"{plain} ({unit})" if unit not in ("", "1") else plain)


def _map(picture: Any, ax: Any, data: xr.Dataset, values: xr.DataArray, grids: list[str]) -> None:
    across, up = grids
    if SAMPLE in values.dims:
        values = values.median(SAMPLE, keep_attrs=True)
    shown = ax.pcolormesh(
        data[across],
        data[up],
        values.transpose(up, across),
        cmap=look.darkening(),
        shading="nearest",
    )
    ax.set(xlabel=_named(data[across]), ylabel=_named(data[up]))
    more = ", median" if SAMPLE in data[str(values.name)].dims else ""
    picture.colorbar(shown, ax=ax).set_label(_named(values) + more)


def _band(ax: Any, data: xr.Dataset, values: xr.DataArray, along: str) -> None:
    at = data[along].values
    if SAMPLE in values.dims:
        low, middle, high = quantiles(data, str(values.name))[str(values.name)].values
        ax.fill_between(at, low, high, color=look.BLUE, alpha=0.2, linewidth=0)
        ax.set_title("median, and from 5 % to 95 %")
    else:
        middle = values.values
    ax.plot(at, middle, color=look.BLUE, marker="o" if len(at) < 40 else None, markersize=3)
    ax.set(xlabel=_named(data[along]), ylabel=_named(values))


def _histogram(ax: Any, values: xr.DataArray) -> None:
    flat = values.values.ravel()
    flat = flat[~np.isnan(flat)]
    if not flat.size:
        raise SomersaultError(f"no flight has a {values.name}; all failed")
    bins = int(np.clip(np.sqrt(flat.size), 5, _MOST_BINS))
    ax.hist(flat, bins=bins, color=look.BLUE, edgecolor="white", linewidth=0.4)
    ax.set(xlabel=_named(values), ylabel="flights")
