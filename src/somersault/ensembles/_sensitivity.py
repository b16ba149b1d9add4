"""Which of the drawn quantities the scatter of a result comes from."""

from __future__ import annotations

import json
import warnings
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.checks import name_list, whole_number
from somersault._core.errors import SomersaultError
from somersault.ensembles._plan import OVER_TIME, SAMPLE
from somersault.ensembles._summary import check_confidence, reported, require_dataset
from somersault.ensembles._vary import DISTRIBUTIONS

if TYPE_CHECKING:
    import xarray as xr

_FEWEST = 64
_RESAMPLES = 100  # that confidence half-widths are from
_QUICK = 2**20  # samples, over inputs and rankings, that are ranked in a third of a second
_WORDS = {
    "first_order": "first-order Sobol' index",
    "first_order_confidence": "half-width of the first-order Sobol' index",
    "total": "total Sobol' index",
    "total_confidence": "half-width of the total Sobol' index",
}


def sensitivity(data: xr.Dataset, name: str, confidence: float = 0.95, seed: int = 0) -> xr.Dataset:
    """Sobol' indices: how much of the scatter of a result comes from each drawn quantity.

    From a saltelli sequence by its own estimator, else by random balance designs (RBD-FAST), both
    of SALib, at each point of the grids there are.

    Parameters
    ----------
    data : xarray.Dataset
        Of an ensemble.
    name : str
        The reported quantity.
    confidence : float
        Of the half-widths, between 0 and 1.
    seed : int
        Of the resampling that the half-widths are from.

    Returns
    -------
    xarray.Dataset
        Over `input`, the drawn quantities, those that matter most first: `first_order`, the share
        of the variance that would go if this quantity alone were known; from a saltelli sequence
        `total`, the share that would stay if all others were; and the half-widths
        `first_order_confidence` and `total_confidence`.

    Raises
    ------
    SomersaultError
        Where nothing is drawn, or there are too few samples.

    Examples
    --------
    >>> import somersault as so
    >>> vary = {
    ...     "leant": so.Vary(adds_to="takeoff.tilt", normal=[0.0, 0.02]),
    ...     "turned": so.Vary(adds_to="takeoff.somersault", normal=[0.0, 0.02]),
    ... }
    >>> found = so.ensemble("furrer", so.Takeoff(spin=8.64), 0.2, vary, size=128, report=["tilt"])
    >>> ranking = so.ensembles.sensitivity(found.dataset, "tilt")
    >>> str(ranking["input"].values[0])
    'leant'
    """
    check_confidence(confidence)
    seed = whole_number("seed", seed, 0, 2**32 - 1)
    return _ranked(data, name, confidence, seed, _RESAMPLES)


def quick_sensitivity(data: xr.Dataset, names: Sequence[str]) -> tuple[dict[str, xr.Dataset], int]:
    """As `sensitivity`, for several quantities, in about a second however many samples there are.

    Of too many samples some are taken at random: evenly spaced points of a sobol or halton sequence
    miss whole parts of the space, and the first of listed samples may be alike. The estimator of a
    saltelli sequence is quick, and takes all.

    Parameters
    ----------
    data : xarray.Dataset
        Of an ensemble.
    names : sequence of str
        Of reported quantities.

    Returns
    -------
    rankings : dict of str to xarray.Dataset
        As `sensitivity` returns them, without half-widths.
    used : int
        How many samples each of them is from.
    """
    names = name_list("names", names)
    require_dataset(data)
    specification = json.loads(data.attrs["specification"])
    size = data.sizes[SAMPLE]
    rankings = sum(reported(data, name).size // size for name in names)
    most = max(_QUICK // max(rankings * len(_inputs(specification)), 1), _FEWEST)
    used = size if specification["sample"]["sequence"] == "saltelli" else min(size, most)
    half_widths = [key for key in _WORDS if key.endswith("_confidence")]
    ranked = {
        # One resample, as SALib's estimator of a saltelli sequence cannot do without.
        name: _ranked(data, name, 0.95, 0, 1, used).drop_vars(half_widths, errors="ignore")
        for name in names
    }
    return ranked, used


def _inputs(specification: Mapping[str, Any]) -> list[str]:
    drawn = specification["vary"].items()
    return [name for name, v in drawn if any(d in v for d in DISTRIBUTIONS)]


def _ranked(
    data: xr.Dataset, name: str, confidence: float, seed: int, resamples: int,
    most: int | None = None,
) -> xr.Dataset:  # fmt: skip
    """Indices from `most` of the samples (all), half-widths from so many `resamples`."""
    import xarray as xr

    values = reported(data, name)
    specification = json.loads(data.attrs["specification"])
    inputs = _inputs(specification)
    if not inputs:
        raise SomersaultError("nothing is drawn in this ensemble, so nothing can be ranked")
    if SAMPLE not in values.dims or OVER_TIME in values.dims:
        raise SomersaultError(f"{name} has no single value for each sample to rank")
    if values.sizes[SAMPLE] < _FEWEST:
        raise SomersaultError(
            f"{values.sizes[SAMPLE]} samples rank nothing; sample.size must be {_FEWEST} at least"
        )
    x = np.stack([data[n].values for n in inputs], 1)
    ordered = values.transpose(..., SAMPLE)
    design = specification["sample"]["sequence"] == "saltelli"
    rows = ordered.values.reshape(-1, ordered.sizes[SAMPLE])
    if most is not None and most < len(x):
        taken = np.sort(np.random.default_rng(seed).choice(len(x), most, replace=False))
        x, rows = x[taken], rows[:, taken]
    indices = [_indices(inputs, x, y, design, confidence, seed, resamples) for y in rows]
    lead = [str(d) for d in ordered.dims if d != SAMPLE]
    shape = [ordered.sizes[d] for d in lead]
    result = xr.Dataset(
        {
            key: (
                (*lead, "input"),
                np.array([row[key] for row in indices]).reshape(*shape, len(inputs)),
                {"units": "1", "long_name": _WORDS[key]},
            )
            for key in indices[0]
        },
        {"input": inputs, **{d: data[d] for d in lead if d in data.coords}},
        {"quantity": name, "confidence": confidence},
    )
    by = result["total" if design else "first_order"]
    if lead:
        by = by.mean(lead)
    return result.isel(input=np.argsort(-by.values, kind="stable"))


def _indices(
    inputs: list[str], x: Any, y: Any, design: bool, confidence: float, seed: int, resamples: int
) -> dict[str, Any]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        from SALib.analyze import rbd_fast, sobol

        problem = {"num_vars": len(inputs), "names": inputs, "bounds": [[0.0, 1.0]] * len(inputs)}
        blank = np.full(len(inputs), np.nan)
        names = ["first_order", "first_order_confidence"]
        names += ["total", "total_confidence"] if design else []
        if design:
            y = y.reshape(-1, len(inputs) + 2)
            y = y[~np.isnan(y).any(1)].ravel()  # a point whose flight failed goes with its group
        else:
            flown = ~np.isnan(y)
            x, y = x[flown], y[flown]
        if len(y) < _FEWEST or np.ptp(y) == 0:
            return dict.fromkeys(names, blank)
        if design:
            result = sobol.analyze(
                problem, y, calc_second_order=False, num_resamples=resamples,
                conf_level=confidence, seed=seed + 1,  # it takes 0 for none
            )  # fmt: skip
            keys = ["S1", "S1_conf", "ST", "ST_conf"]
        else:
            result = rbd_fast.analyze(
                problem, x, y, num_resamples=resamples, conf_level=confidence, seed=seed
            )
            keys = ["S1", "S1_conf"]
    return {name: np.asarray(result[key]) for name, key in zip(names, keys, strict=True)}
