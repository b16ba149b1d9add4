"""A store in which no run has come yet, and what is written anew of one that was damaged."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.files import make_way, temporary_name
from somersault._core.interrupts import unbroken
from somersault.ensembles._chunks import Chunks
from somersault.ensembles._labels import attributes, coordinate_attributes, variable_attributes
from somersault.ensembles._metadata import GROUP, arrays_of, fixed_coordinates, read_metadata, sign
from somersault.ensembles._plan import OVER_TIME, SAMPLE, SEAL, Plan
from somersault.ensembles._seals import SEAL_BYTES

if TYPE_CHECKING:
    import zarr


def create(path: Path, plan: Plan, chunks: Chunks) -> None:
    """An empty store for a plan, there as a whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with unbroken(), _empty(path, plan, chunks) as fresh:
        try:
            os.rename(fresh, path)
        except OSError:
            if not path.is_dir():
                raise  # else another program was quicker


def write_anew(path: Path, plan: Plan, chunks: Chunks, names: list[str] | None) -> None:
    """Write what a store was begun with anew: some arrays of it, or (None) its group as well.

    What has been run since stays.
    """
    with unbroken(), _empty(path, plan, chunks) as fresh:
        metadata = read_metadata(fresh)
        coordinates = fixed_coordinates(metadata)
        for name in arrays_of(metadata) if names is None else names:
            files = [Path(name, GROUP), *([Path(name, "c", "0")] if name in coordinates else [])]
            for file in files:
                _replace(fresh / file, path / file)
        if names is None:
            _replace(fresh / GROUP, path / GROUP)


def _replace(source: Path, target: Path) -> None:
    make_way(target)
    target.parent.mkdir(parents=True, exist_ok=True)
    os.replace(source, target)


@contextmanager
def _empty(path: Path, plan: Plan, chunks: Chunks) -> Iterator[Path]:
    """An empty store beside a path; what is left of it in the end is removed."""
    import zarr

    with temporary_name(path.parent) as fresh:
        group = zarr.create_group(store=str(fresh))
        group.attrs.put(_store_attributes(plan, chunks))
        _create_variables(group, plan, chunks)
        _create_coordinates(group, plan, chunks)
        _create_seals(group, chunks)
        with warnings.catch_warnings():  # that the metadata in one piece are zarr's own addition
            warnings.simplefilter("ignore")
            zarr.consolidate_metadata(group.store)
        sign(fresh)
        yield fresh


def _create_variables(group: zarr.Group, plan: Plan, chunks: Chunks) -> None:
    lengths, samples = tuple(chunks.dims.values()), len(plan.simulation.times)
    for name, v in plan.variables.items():
        dims, shape, chunk = tuple(chunks.dims), lengths, chunks.shape
        if v.over_time:
            dims, shape, chunk = (*dims, OVER_TIME), (*shape, samples), (*chunk, samples)
        array = _create_array(group, name, v.dtype, shape, chunk, dims, v.fill)
        array.attrs.put(variable_attributes(plan, name))


def _create_coordinates(group: zarr.Group, plan: Plan, chunks: Chunks) -> None:
    for name, vary in plan.vary.items():
        dim = name if name in chunks.dims else SAMPLE
        length = chunks.dims[dim]
        chunk = length if vary.grid is not None else chunks.shape[list(chunks.dims).index(dim)]
        array = _create_array(group, name, "f8", (length,), (chunk,), (dim,), np.nan)
        array.attrs.put(coordinate_attributes(vary))
        if vary.grid is not None:
            array[:] = vary.grid
    times = plan.simulation.times
    if len(times):
        shape = times.shape
        array = _create_array(group, OVER_TIME, "f8", shape, shape, (OVER_TIME,), np.nan)
        array.attrs.put({"units": "s"})
        array[:] = times


def _create_seals(group: zarr.Group, chunks: Chunks) -> None:
    dims = (*(f"chunk_of_{dim}" for dim in chunks.dims), "byte")
    one = (*[1] * len(chunks.grid), SEAL_BYTES)
    group.create_array(
        SEAL, shape=(*chunks.grid, SEAL_BYTES), chunks=one, dtype="u1", fill_value=0,
        dimension_names=dims, compressors=None,
    )  # fmt: skip


def _create_array(
    group: zarr.Group, name: str, dtype: str, shape: tuple[int, ...], chunk: tuple[int, ...],
    dims: tuple[str, ...], fill: Any,
) -> zarr.Array:  # fmt: skip
    """An array whose chunks carry checksums, for whoever reads them. Digits do not shrink."""
    from zarr.codecs import Crc32cCodec

    return group.create_array(
        name, shape=shape, chunks=chunk, dtype=dtype, fill_value=fill, dimension_names=dims,
        compressors=[Crc32cCodec()],
    )  # fmt: skip


def _store_attributes(plan: Plan, chunks: Chunks) -> dict[str, Any]:
    along = plan.along_samples
    more: dict[str, Any] = {"coordinates": " ".join(along)} if along else {}
    own = {"variables": list(plan.variables), "chunk": list(chunks.shape)}
    return {**attributes(plan), **own, **more}
