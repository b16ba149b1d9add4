"""What many flights add up to. Flights that failed are counted, and never averaged over."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy import special

from somersault._core.array import Array
from somersault._core.checks import name_list
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number, numbers
from somersault.ensembles._plan import SAMPLE
from somersault.ensembles._report import ENDINGS, ERROR, FAILED, UNFLOWN
from somersault.ensembles._selection import quantiles as selected
from somersault.ensembles._store import layout

if TYPE_CHECKING:
    import xarray as xr


_CONFIDENCE = 0.95
_BLOCK = 2**20  # flights that are read at once


def failed(ended: xr.DataArray) -> xr.DataArray:
    """Whether flights ended otherwise than by their duration or an event; not yet flown: no."""
    return (ended >= FAILED) & (ended != UNFLOWN)


def within(data: xr.Dataset, tolerance: float | None) -> xr.DataArray:
    """Whether the landing error is at most so much, rad."""
    most = _tolerance(data, tolerance)
    return data[ERROR] <= most


def _tolerance(data: xr.Dataset, tolerance: float | None) -> float:
    """A positive one; SomersaultError unless there are landing errors to hold against it."""
    _require_dataset(data)
    if ERROR not in data:
        raise SomersaultError(
            "this ensemble reports no landing_error; give a target, or say which flights are good"
        )
    most = number("tolerance", tolerance)
    if most <= 0:
        raise SomersaultError(f"tolerance must be a positive number of radians, and is {tolerance}")
    return most


def fraction(
    good: xr.DataArray,
    ended: xr.DataArray,
    over: str | Sequence[str] = SAMPLE,
    confidence: float = _CONFIDENCE,
) -> xr.Dataset:
    """The share of good flights `over` dimensions, with the Clopper–Pearson interval.

    `fraction`, `low`, `high` and `flights`, how many were flown. A flight that failed was not
    good; one not yet flown does not count. Over what is left of the dimensions.
    """
    import xarray as xr

    check_confidence(confidence)
    if getattr(getattr(good, "dtype", None), "kind", "") != "b":
        raise SomersaultError("good must be true or false for each flight, like data.tilt < 0.1")
    dims = _over(ended, over)
    flown = ended != UNFLOWN
    n = flown.sum(dims)
    hits = (good & flown & ~failed(ended)).sum(dims)
    low, high = (hits.copy(data=x) for x in _interval(hits.values, n.values, confidence))
    return xr.Dataset(
        {
            "fraction": (hits / n).assign_attrs(units="1"),
            "low": low.where(n > 0).assign_attrs(units="1"),
            "high": high.where(n > 0).assign_attrs(units="1"),
            "flights": n,
        },
        attrs={"confidence": confidence, "interval": "Clopper-Pearson"},
    )


def check_confidence(confidence: float) -> None:
    """SomersaultError unless it lies between 0 and 1."""
    if not 0 < number("confidence", confidence) < 1:
        raise SomersaultError(f"confidence must be between 0 and 1, and is {confidence}")


def _interval(hits: Array, count: Array, confidence: float) -> tuple[Array, Array]:
    """Both ends of the Clopper–Pearson interval of so many hits in so many."""
    rest = (1 - confidence) / 2
    low = np.where(hits > 0, special.betaincinv(hits, count - hits + 1, rest), 0.0)
    high = np.where(hits < count, special.betaincinv(hits + 1, count - hits, 1 - rest), 1.0)
    return low, high


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
    levels = numbers("quantiles", q)
    if not levels.size or levels.min() < 0 or levels.max() > 1:
        raise SomersaultError(f"quantiles are numbers from 0 to 1, and are {q}")
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
    _require_dataset(data)
    there = [str(n) for n, v in data.data_vars.items() if v.dtype.kind == "f"]
    if not isinstance(name, str) or name not in there:
        raise SomersaultError(f"this ensemble reports no {name!r}; it has {', '.join(there)}")
    return data[name]


def _require_dataset(data: xr.Dataset) -> None:
    import xarray as xr

    if not isinstance(data, xr.Dataset):
        raise SomersaultError(f"an ensemble's dataset is an xarray.Dataset, and not {data!r}")


def _over(values: xr.DataArray, over: str | Sequence[str]) -> list[str]:
    dims = [over] if isinstance(over, str) else list(name_list("over", over))
    if not dims:
        raise SomersaultError("over names no dimension; name one, or leave it out for the samples")
    for dim in dims:
        if dim not in values.dims:
            there = ", ".join(str(d) for d in values.dims)
            raise SomersaultError(f"there is no dimension {dim!r} to go over; there are {there}")
    return dims


def summary(data: xr.Dataset, tolerance: float | None = None) -> dict[str, Any]:
    """The whole ensemble in a few numbers: endings, quantiles of what is reported, share of
    landings within tolerance.

    Exact, and read a million flights at a time however many there are.
    """
    ended = data["ended"]
    counts = np.zeros(UNFLOWN + 1, int)
    for codes in _blocks(ended):
        counts += np.bincount(codes, minlength=UNFLOWN + 1)
    found: dict[str, Any] = {
        "flights": int(ended.size),
        "ended": {word: int(counts[k]) for k, word in enumerate(ENDINGS) if counts[k]},
    }
    table = {}
    for name, values in data.data_vars.items():
        if values.dtype.kind != "f" or "history_time" in values.dims:
            continue
        low, middle, high = selected(partial(_blocks, values), (0.05, 0.5, 0.95)).tolist()
        if not np.isnan(middle):
            unit = values.attrs.get("units", "")
            table[str(name)] = {"5%": low, "median": middle, "95%": high, "unit": unit}
    found["reported"] = table
    if tolerance is not None:
        most = _tolerance(data, tolerance)
        pairs = zip(_blocks(data[ERROR]), _blocks(ended), strict=True)
        hits = sum(int(((error <= most) & (e < FAILED)).sum()) for error, e in pairs)
        flown = int(ended.size - counts[UNFLOWN])
        low, high = _interval(np.array(hits), np.array(flown), _CONFIDENCE)
        row = (hits / flown, float(low), float(high)) if flown else (np.nan,) * 3
        share = dict(zip(("fraction", "low", "high"), row, strict=True))
        found["within_tolerance"] = {"tolerance": tolerance, **share}
    return found


def _blocks(values: xr.DataArray) -> Iterator[Array]:
    """All values, in order, in flat blocks that are read one at a time."""
    cut = layout({str(dim): length for dim, length in values.sizes.items()}, _BLOCK)
    for k in range(len(cut)):
        yield values[cut.region(k)].values.ravel()
