"""What many flights add up to. Flights that failed are counted, and never averaged over."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy import special

from somersault._errors import SomersaultError
from somersault.ensembles._plan import SAMPLE
from somersault.ensembles._report import ENDINGS, ERROR, FAILED, UNFLOWN

if TYPE_CHECKING:
    import xarray as xr


def failed(ended: xr.DataArray) -> xr.DataArray:
    """Whether flights ended otherwise than by their duration or an event; not yet flown: no."""
    return (ended >= FAILED) & (ended != UNFLOWN)


def within(data: xr.Dataset, tolerance: float | None) -> xr.DataArray:
    """Whether the landing error is at most so much, rad."""
    if ERROR not in data:
        raise SomersaultError(
            "this ensemble reports no landing_error; give a target, or say which flights are good"
        )
    if tolerance is None or not tolerance > 0:
        raise SomersaultError(f"tolerance must be a positive number of radians, and is {tolerance}")
    return data[ERROR] <= tolerance


def fraction(
    good: xr.DataArray,
    ended: xr.DataArray,
    over: str | Sequence[str] = SAMPLE,
    confidence: float = 0.95,
) -> xr.Dataset:
    """The share of good flights `over` dimensions, with the Clopper–Pearson interval.

    `fraction`, `low`, `high` and `flights`, how many were flown. A flight that failed was not
    good; one not yet flown does not count. Over what is left of the dimensions.
    """
    import xarray as xr

    if not 0 < confidence < 1:
        raise SomersaultError(f"confidence must be between 0 and 1, and is {confidence}")
    if getattr(getattr(good, "dtype", None), "kind", "") != "b":
        raise SomersaultError("good must be true or false for each flight, like data.tilt < 0.1")
    dims = _over(ended, over)
    flown = ended != UNFLOWN
    n = flown.sum(dims)
    hits = (good & flown & ~failed(ended)).sum(dims)
    rest = (1 - confidence) / 2
    low = xr.where(hits > 0, special.betaincinv(hits, n - hits + 1, rest), 0.0)
    high = xr.where(hits < n, special.betaincinv(hits + 1, n - hits, 1 - rest), 1.0)
    return xr.Dataset(
        {
            "fraction": (hits / n).assign_attrs(units="1"),
            "low": low.where(n > 0).assign_attrs(units="1"),
            "high": high.where(n > 0).assign_attrs(units="1"),
            "flights": n,
        },
        attrs={"confidence": confidence, "interval": "Clopper-Pearson"},
    )


def quantiles(
    data: xr.Dataset,
    name: str,
    q: Sequence[float] = (0.05, 0.5, 0.95),
    over: str | Sequence[str] = SAMPLE,
) -> xr.Dataset:
    """Quantiles of a reported quantity `over` dimensions, with its mean and standard deviation.

    Variables NAME (over `quantile` and what is left of the dimensions), `mean`, `deviation`,
    `flights` that they are of, and `failed`, which are left out.
    """
    import xarray as xr

    values = reported(data, name)
    levels = [float(x) for x in q]
    if not levels or not all(0 <= x <= 1 for x in levels):
        raise SomersaultError(f"quantiles are numbers from 0 to 1, and are {list(q)}")
    dims = _over(values, over)
    units = values.attrs.get("units", "1")
    return xr.Dataset(
        {
            name: values.quantile(levels, dims).assign_attrs(units=units),
            "mean": values.mean(dims).assign_attrs(units=units),
            "deviation": values.std(dims, ddof=1).assign_attrs(units=units),
            "flights": values.notnull().sum(dims),
            "failed": failed(data["ended"]).sum(dims),
        }
    )


def reported(data: xr.Dataset, name: str) -> xr.DataArray:
    """A reported quantity; SomersaultError with those there are."""
    there = [str(n) for n, v in data.data_vars.items() if v.dtype.kind == "f"]
    if name not in there:
        raise SomersaultError(f"this ensemble reports no {name!r}; it has {', '.join(there)}")
    return data[name]


def _over(values: xr.DataArray, over: str | Sequence[str]) -> list[str]:
    dims = [over] if isinstance(over, str) else list(over)
    for dim in dims:
        if dim not in values.dims:
            there = ", ".join(str(d) for d in values.dims)
            raise SomersaultError(f"there is no dimension {dim!r} to go over; there are {there}")
    return dims


def summary(data: xr.Dataset, tolerance: float | None = None) -> dict[str, Any]:
    """The whole ensemble in a few numbers: endings, quantiles of what is reported, share of
    landings within tolerance."""
    ended = data["ended"].values
    counts = np.bincount(ended.ravel(), minlength=UNFLOWN + 1)
    found: dict[str, Any] = {
        "flights": int(ended.size),
        "ended": {word: int(counts[k]) for k, word in enumerate(ENDINGS) if counts[k]},
    }
    whole = list(data["ended"].dims)
    table = {}
    for name, values in data.data_vars.items():
        if values.dtype.kind != "f" or "history_time" in values.dims:
            continue
        flat = values.values.ravel()
        flat = flat[~np.isnan(flat)]
        if flat.size:
            low, middle, high = np.quantile(flat, (0.05, 0.5, 0.95), overwrite_input=True)
            table[str(name)] = {
                "5%": float(low), "median": float(middle), "95%": float(high),
                "unit": values.attrs.get("units", ""),
            }  # fmt: skip
    found["reported"] = table
    if tolerance is not None:
        share = fraction(within(data, tolerance), data["ended"], [str(d) for d in whole])
        found["within_tolerance"] = {
            "tolerance": tolerance,
            **{key: float(share[key]) for key in ("fraction", "low", "high")},
        }
    return found
