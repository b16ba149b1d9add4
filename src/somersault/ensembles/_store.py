"""Ensembles on disk: a Zarr store that fills chunk by chunk and can be left at any moment.

Every chunk of every variable is a file that is written under another name and then renamed: a
chunk is finished when all its files are there, and whole. Nothing else is kept account of, so
there is nothing that could disagree, and what is lost is run again.
"""

from __future__ import annotations

import json
import math
import os
import shutil
import tempfile
import time
import warnings
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError, SomersaultWarning
from somersault._core.files import umask
from somersault.engine import processor
from somersault.ensembles._chunks import Chunks
from somersault.ensembles._labels import (
    FORMAT,
    attributes,
    coordinate_attributes,
    variable_attributes,
)
from somersault.ensembles._plan import OVER_TIME, SAMPLE, Plan

if TYPE_CHECKING:
    import xarray as xr
    import zarr

_STALE = 60.0  # s after which a half-written file is nobody's


def create(path: Path, plan: Plan, chunks: Chunks) -> None:
    """An empty store for a plan, there as a whole or not at all."""
    import zarr

    path.parent.mkdir(parents=True, exist_ok=True)
    fresh = Path(tempfile.mkdtemp(dir=path.parent, prefix=f".{path.name}."))
    try:
        group = zarr.create_group(store=str(fresh))
        group.attrs.put(_store_attributes(plan, chunks))
        _create_variables(group, plan, chunks)
        _create_coordinates(group, plan, chunks)
        with warnings.catch_warnings():  # that the metadata in one piece are zarr's own addition
            warnings.simplefilter("ignore")
            zarr.consolidate_metadata(group.store)
        fresh.chmod(0o777 & ~umask())
        try:
            os.rename(fresh, path)
        except OSError:
            if not path.is_dir():
                raise
            shutil.rmtree(fresh, ignore_errors=True)  # another program was quicker
    except BaseException:
        shutil.rmtree(fresh, ignore_errors=True)
        raise


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
        length = chunks.shape[list(chunks.dims).index(dim)]
        shape = (chunks.dims[dim],)
        array = _create_array(group, name, "f8", shape, (length,), (dim,), np.nan)
        array.attrs.put(coordinate_attributes(vary))
        if vary.grid is not None:
            array[:] = vary.grid
    times = plan.simulation.times
    if len(times):
        shape = times.shape
        array = _create_array(group, OVER_TIME, "f8", shape, shape, (OVER_TIME,), np.nan)
        array.attrs.put({"units": "s"})
        array[:] = times


def _create_array(
    group: zarr.Group, name: str, dtype: str, shape: tuple[int, ...], chunk: tuple[int, ...],
    dims: tuple[str, ...], fill: Any,
) -> zarr.Array:  # fmt: skip
    return group.create_array(
        name, shape=shape, chunks=chunk, dtype=dtype, fill_value=fill, dimension_names=dims,
        compressors=None,  # digits do not shrink, and a whole file is known by its size
    )  # fmt: skip


def _store_attributes(plan: Plan, chunks: Chunks) -> dict[str, Any]:
    along = plan.along_samples
    more: dict[str, Any] = {"coordinates": " ".join(along)} if along else {}
    own = {"variables": list(plan.variables), "chunk": list(chunks.shape)}
    return {**attributes(plan), **own, **more}


def resume(path: Path, plan: Plan) -> Chunks:
    """The chunks of a store that is this plan's; SomersaultError for any other."""
    attrs = _read_attributes(path)
    theirs, ours = json.loads(attrs["specification"]), json.loads(json.dumps(plan.specification))
    if theirs != ours:
        key = _difference(theirs, ours)
        raise SomersaultError(
            f"{path} holds an ensemble of another specification ({key} differs); give another "
            "--out, or remove it"
        )
    begun, now = json.loads(attrs["versions"]), plan.versions
    if begun != now:
        other = ", ".join(f"{name} {v}" for name, v in begun.items() if now.get(name) != v)
        raise SomersaultError(
            f"{path} was begun with {other}, whose last digits may differ; go on with that, or "
            "give another --out"
        )
    return Chunks(plan.dims, tuple(attrs["chunk"]))


def note_processor(path: Path) -> None:
    """Warn where a store was begun on another kind of processor than this one."""
    begun = _read_attributes(path).get("processor")
    if begun != processor():
        where = f"on {begun}" if begun else "by a version that did not record its processor"
        warnings.warn(
            f"{path} was begun {where}, and this is {processor()}: the last digits of what is "
            "run now may differ; go on there, or begin another, if they matter",
            SomersaultWarning,
            stacklevel=2,
        )


def _read_attributes(path: Path) -> dict[str, Any]:
    import zarr

    try:
        attrs: dict[str, Any] = dict(zarr.open_group(str(path), mode="r").attrs)
        if attrs.get("format") != FORMAT:
            raise KeyError
        json.loads(attrs["specification"]), json.loads(attrs["versions"])
        list(attrs["chunk"]), list(attrs["variables"])
    except (OSError, ValueError, KeyError, TypeError):
        raise SomersaultError(f"{path} is there, but is no ensemble; give another --out") from None
    return attrs


def _difference(theirs: Any, ours: Any, key: str = "") -> str:
    """The first key in which two specifications differ."""
    if isinstance(theirs, dict) and isinstance(ours, dict):
        for name in dict.fromkeys([*theirs, *ours]):
            if theirs.get(name) != ours.get(name):
                return _difference(theirs.get(name), ours.get(name), f"{key}.{name}".lstrip("."))
    return key


def finished(path: Path, plan: Plan, chunks: Chunks) -> set[int]:
    """Numbers of the chunks that are complete: every variable's file there, and whole."""
    complete = set(range(len(chunks)))
    samples, depth = len(plan.simulation.times), len(chunks.grid)
    for name, v in plan.variables.items():
        each = np.dtype(v.dtype).itemsize * (samples if v.over_time else 1)
        places = _files(path / name / "c", each * math.prod(chunks.shape))
        complete &= {int(np.ravel_multi_index(p[:depth], chunks.grid)) for p in places}
    along = plan.along_samples
    if along:
        at = list(chunks.dims).index(SAMPLE)
        there = [_files(path / name / "c", 8 * chunks.shape[at]) for name in along]
        known = {p[0] for p in set.intersection(*there)}
        bringing = {k for k in complete if _brings_samples(chunks, k)}
        complete -= {k for k in bringing if chunks.place(k)[at] not in known}
    return complete


def _files(root: Path, size: int) -> set[tuple[int, ...]]:
    """Places of the chunk files below a folder that have a size, bytes."""
    places = set()
    for folder, _, files in os.walk(root):
        ahead = Path(folder).relative_to(root).parts
        for file in files:
            place = (*ahead, file)
            whole = os.path.getsize(os.path.join(folder, file)) == size
            if whole and all(p.isdecimal() for p in place):
                places.add(tuple(int(p) for p in place))
    return places


def _brings_samples(chunks: Chunks, k: int) -> bool:
    """Whether chunk k writes what is drawn: the first for its samples, by all other dimensions."""
    pairs = zip(chunks.dims, chunks.place(k), strict=True)
    return SAMPLE in chunks.dims and not any(i for dim, i in pairs if dim != SAMPLE)


def write(path: Path, plan: Plan, chunks: Chunks, k: int, rows: Mapping[str, Array]) -> None:
    """The variables of chunk k into the store, `ended` last."""
    try:
        _write(path, plan, chunks, k, rows)
    except OSError as trouble:  # of a full disk, which does not say of which file
        raise OSError(trouble.errno, trouble.strerror, str(path)) from None


def _write(path: Path, plan: Plan, chunks: Chunks, k: int, rows: Mapping[str, Array]) -> None:
    arrays = _arrays(str(path), (path / "zarr.json").stat().st_mtime_ns)
    region = chunks.region(k)
    if _brings_samples(chunks, k):
        along = region[list(chunks.dims).index(SAMPLE)]
        for name, values in plan.drawn(np.arange(along.start, along.stop)).items():
            arrays[name][along] = values
    for name in plan.variables:
        arrays[name][region] = as_block(rows[name], region)


def as_block(values: Array, region: tuple[slice, ...]) -> Array:
    """Rows of runs (N, …) as the block of the dimensions that they are."""
    return values.reshape(*(r.stop - r.start for r in region), *values.shape[1:])


@lru_cache(maxsize=4)
def _arrays(path: str, created: int) -> dict[str, Any]:
    """The arrays of the store `created` (ns) at a path, opened once for all chunks."""
    import zarr

    # A chunk that is all NaN, of runs that failed, is written too: a file that is not there
    # is one that was lost.
    arrays = zarr.open_group(path, mode="r+").arrays()
    return {name: array.with_config({"write_empty_chunks": True}) for name, array in arrays}


def tidy(path: Path) -> None:
    """Remove what writers that were killed left half written."""
    for file in path.rglob("*.partial"):
        try:
            if time.time() - file.stat().st_mtime > _STALE:
                file.unlink()
        except OSError:
            continue


def opened(path: Path) -> xr.Dataset:
    """The dataset of a store, read as it is used; what is not run yet is NaN (`ended` 255)."""
    import xarray as xr

    if path.suffix.lower() == ".nc":
        return _read_netcdf(path)
    names = _read_attributes(path)["variables"]
    data = xr.open_zarr(str(path), chunks=None)
    for name in ("variables", "chunk"):  # of the store, not of the data
        data.attrs.pop(name)
    return data[names]


def _read_netcdf(path: Path) -> xr.Dataset:
    import xarray as xr

    try:
        with xr.open_dataset(path, engine="h5netcdf") as data:
            if data.attrs.get("format") == FORMAT:
                return data.load()
    except (OSError, ValueError):
        pass
    raise SomersaultError(f"{path} is there, but is no ensemble")
