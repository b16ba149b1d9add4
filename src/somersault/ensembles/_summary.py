"""What many flights add up to. Flights that failed are counted, and never averaged over."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import name_list, shown
from somersault._core.errors import SomersaultError
from somersault._core.intervals import of_share
from somersault._core.numbers import number, numbers
from somersault.ensembles._chunks import chunked
from somersault.ensembles._endings import (
    ending_words,
    failed,
    failure_codes,
    run_already,
    success_codes,
)
from somersault.ensembles._plan import OVER_TIME, SAMPLE
from somersault.ensembles._selection import quantiles as selected
from somersault.simulation import ENDED, LANDING_ERROR, NOT_RUN

if TYPE_CHECKING:
    import xarray as xr


_CONFIDENCE = 0.95
_BLOCK = 2**20  # flights that are read at once


def within(data: xr.Dataset, tolerance: float | None) -> xr.DataArray:
    """Whether landings were good: whether the landing error is at most so much.

    Parameters
    ----------
    data : xarray.Dataset
        Of an ensemble that reports "landing_error".
    tolerance : float
        rad.

    Returns
    -------
    xarray.DataArray of bool

    Raises
    ------
    SomersaultError
        Where there are no landing errors, or the tolerance is not positive.
    """
    most = _tolerance(data, tolerance)
    return data[LANDING_ERROR] <= most


def _tolerance(data: xr.Dataset, tolerance: float | None) -> float:
    """A positive one; SomersaultError unless there are landing errors to hold against it."""
    require_dataset(data)
    if LANDING_ERROR not in data:
        raise SomersaultError(
            "this ensemble reports no landing_error; say against what landings are measured, or "
            "which flights are good"
        )
    most = number("tolerance", tolerance)
    if most <= 0:
        raise SomersaultError(f"tolerance must be a positive number of radians, and is {tolerance}")
    return most


def fraction(
    good: xr.DataArray,
    ended: xr.DataArray | None = None,
    over: str | Sequence[str] = SAMPLE,
    confidence: float = _CONFIDENCE,
) -> xr.Dataset:
    """The share of good flights, with its confidence interval (Clopper and Pearson).

    Parameters
    ----------
    good : xarray.DataArray of bool
        For each flight.
    ended : xarray.DataArray, optional
        `dataset["ended"]` of the ensemble: a flight that failed was not good, and one that is
        still to come does not count. Without it all count.
    over : str or sequence of str
        The dimensions over which flights are counted; by default that of the samples.
    confidence : float
        That the interval holds the true share, between 0 and 1.

    Returns
    -------
    xarray.Dataset
        `fraction`, `low`, `high`, and `flights`, how many counted, over the dimensions left.

    Raises
    ------
    SomersaultError
        For what does not fit.

    Examples
    --------
    >>> import numpy as np
    >>> import xarray as xr
    >>> from somersault.ensembles import fraction
    >>> share = fraction(xr.DataArray(np.arange(20) < 14, dims="sample"))
    >>> [round(float(share[name]), 2) for name in ("fraction", "low", "high")]
    [0.7, 0.46, 0.88]
    """
    if getattr(getattr(good, "dtype", None), "kind", "") != "b":
        raise SomersaultError("good must be true or false for each flight, like data.tilt < 0.1")
    if ended is None:
        return share(good, good | True, over, confidence)
    return share(good & ~failed(ended), run_already(ended), over, confidence)


def share(
    good: xr.DataArray, counted: xr.DataArray, over: str | Sequence[str], confidence: float
) -> xr.Dataset:
    """The share of those counted that are good, as `fraction` gives it."""
    import xarray as xr

    check_confidence(confidence)
    dims = _over(counted, over)
    n = counted.sum(dims)
    hits = (good & counted).sum(dims)
    low, high = (hits.copy(data=x) for x in of_share(hits.values, n.values, confidence))
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


def quantiles(
    data: xr.Dataset,
    name: str,
    q: Sequence[float] = (0.05, 0.5, 0.95),
    over: str | Sequence[str] = SAMPLE,
) -> xr.Dataset:
    """Quantiles of a reported quantity, with its mean and standard deviation.

    Parameters
    ----------
    data : xarray.Dataset
        Of an ensemble.
    name : str
        One of its variables.
    q : sequence of float
        From 0 to 1.
    over : str or sequence of str
        The dimensions over which flights are gathered; by default that of the samples.

    Returns
    -------
    xarray.Dataset
        The variable NAME over `quantile` and the dimensions left, `mean`, `deviation`, `flights`
        that they are of, and `failed`, which are left out.

    Raises
    ------
    SomersaultError
        For what does not fit.

    Examples
    --------
    >>> import somersault as so
    >>> vary = {"tilt_at_takeoff": so.Vary("takeoff.tilt", uniform=[-0.1, 0.1])}
    >>> found = so.ensemble("furrer", so.Takeoff(spin=8.64), 0.2, vary, size=50, report=["tilt"])
    >>> so.ensembles.quantiles(found.dataset, "tilt", [0.5])["tilt"].dims
    ('quantile',)
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
            "failed": failed(data[ENDED]).sum(dims),
        }
    )


def reported(data: xr.Dataset, name: str) -> xr.DataArray:
    """A reported quantity; SomersaultError with those there are."""
    require_dataset(data)
    there = [str(n) for n, v in data.data_vars.items() if v.dtype.kind == "f"]
    if not isinstance(name, str) or name not in there:
        raise SomersaultError(f"this ensemble reports no {shown(name)}; it has {', '.join(there)}")
    return data[name]


def require_dataset(data: xr.Dataset) -> None:
    import xarray as xr

    if not isinstance(data, xr.Dataset):
        raise SomersaultError(f"an ensemble's dataset is an xarray.Dataset, and not {shown(data)}")


def _over(values: xr.DataArray, over: str | Sequence[str]) -> list[str]:
    dims = [over] if isinstance(over, str) else list(name_list("over", over))
    if not dims:
        raise SomersaultError("over names no dimension; name one, or leave it out for the samples")
    for dim in dims:
        if dim not in values.dims:
            there = ", ".join(str(d) for d in values.dims)
            raise SomersaultError(f"no dimension {shown(dim)} can be gone over; there are {there}")
    return dims


def summary(data: xr.Dataset, tolerance: float | None = None) -> dict[str, Any]:
    """The whole ensemble in a few numbers.

    They are exact, and are read a million flights at a time, however many there are.

    Parameters
    ----------
    data : xarray.Dataset
        Of an ensemble.
    tolerance : float, optional
        Of the landing error, rad.

    Returns
    -------
    dict
        "flights", how many; "ended", how many ended how; "reported", the 5, 50 and 95 % quantiles
        of each quantity with its unit; and with a tolerance "within_tolerance", the share of
        landings within it; and where runs are attempts "successes", the share that came off.
    """
    require_dataset(data)
    ended = data[ENDED]
    row: dict[str, Any] = {"flights": int(ended.size), "ended": endings(data)}
    if good := success_codes(ended):
        row["successes"] = _succeeded(data, good)
    table = {}
    for name, values in data.data_vars.items():
        if values.dtype.kind != "f" or OVER_TIME in values.dims:
            continue
        low, middle, high = selected(partial(_blocks, values), (0.05, 0.5, 0.95)).tolist()
        if not np.isnan(middle):
            unit = values.attrs.get("units", "")
            table[str(name)] = {"5%": low, "median": middle, "95%": high, "unit": unit}
    row["reported"] = table
    if tolerance is not None:
        row["within_tolerance"] = _landed_within(data, _tolerance(data, tolerance), tolerance)
    return row


def endings(data: xr.Dataset) -> dict[str, int]:
    """How many flights ended in each way, those that none ended in left out."""
    counts = np.zeros(NOT_RUN + 1, int)
    for codes in _blocks(data[ENDED]):
        counts += np.bincount(codes, minlength=NOT_RUN + 1)
    words = ending_words(data[ENDED])
    return {word: int(counts[k]) for k, word in enumerate(words) if counts[k]}


def _succeeded(data: xr.Dataset, good: Sequence[int]) -> dict[str, float]:
    """The share of attempts that came off, of those that there have been."""
    hits = counted = 0
    for codes in _blocks(data[ENDED]):
        hits += int(np.isin(codes, good).sum())
        counted += int((codes != NOT_RUN).sum())
    return _share(hits, counted)


def _landed_within(data: xr.Dataset, most: float, tolerance: float) -> dict[str, float]:
    """The share of landings with an error of at most `most`, rad."""
    lost = [*failure_codes(data[ENDED]), NOT_RUN]
    hits = counted = 0
    for error, codes in zip(_blocks(data[LANDING_ERROR]), _blocks(data[ENDED]), strict=True):
        hits += int(((error <= most) & ~np.isin(codes, lost)).sum())
        counted += int((codes != NOT_RUN).sum())
    return {"tolerance": tolerance, **_share(hits, counted)}


def _share(hits: int, counted: int) -> dict[str, float]:
    """A share with its confidence interval."""
    low, high = of_share(np.array(hits), np.array(counted), _CONFIDENCE)
    row = (hits / counted, float(low), float(high)) if counted else (np.nan,) * 3
    return dict(zip(("fraction", "low", "high"), row, strict=True))


def _blocks(values: xr.DataArray) -> Iterator[Array]:
    """All values, in order, in flat blocks that are read one at a time."""
    blocks = chunked({str(dim): length for dim, length in values.sizes.items()}, _BLOCK)
    for k in range(len(blocks)):
        yield values[blocks.region(k)].values.ravel()
