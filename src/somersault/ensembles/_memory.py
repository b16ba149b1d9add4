"""Ensembles in memory, for those that are small enough."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.array import Array
from somersault.ensembles._chunks import Chunks
from somersault.ensembles._labels import attributes, coordinate_attributes, variable_attributes
from somersault.ensembles._plan import OVER_TIME, SAMPLE, Plan
from somersault.ensembles._run import Put
from somersault.ensembles._store import as_block

if TYPE_CHECKING:
    import xarray as xr


def empty_dataset(plan: Plan, chunks: Chunks) -> tuple[xr.Dataset, Put]:
    """A dataset in which no run has come yet, and what puts the rows of a chunk into it."""
    import xarray as xr

    dims, shape, times = tuple(plan.dims), tuple(plan.dims.values()), plan.simulation.times
    variables: dict[str, Any] = {}
    for name, v in plan.variables.items():
        whole = np.full((*shape, len(times)) if v.over_time else shape, v.fill, v.dtype)
        over = (*dims, OVER_TIME) if v.over_time else dims
        variables[name] = (over, whole, variable_attributes(plan, name))
    coords: dict[str, Any] = {}
    drawn = plan.drawn(np.arange(plan.dims.get(SAMPLE, 0)))
    for name, vary in plan.vary.items():
        dim, values = (SAMPLE, drawn[name]) if vary.grid is None else (name, vary.grid)
        coords[name] = (dim, values, coordinate_attributes(vary))
    if len(times):
        coords[OVER_TIME] = (OVER_TIME, times, {"units": "s"})
    data = xr.Dataset(variables, coords, attributes(plan))

    def put(k: int, rows: Mapping[str, Array]) -> None:
        region = chunks.region(k)
        for name, values in rows.items():
            variables[name][1][region] = as_block(values, region)

    return data, put


def run_bytes(plan: Plan) -> int:
    """Of memory, for what is reported of a run."""
    samples = len(plan.simulation.times)
    return 8 * (1 + sum(samples if v.over_time else 1 for v in plan.variables.values()))
