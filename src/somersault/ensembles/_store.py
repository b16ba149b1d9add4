"""Ensembles on disk: a Zarr store that fills chunk by chunk and can be left at any moment.

Every chunk of every variable is a file that is written under another name and then renamed: a
chunk is finished when all its files are there, and whole. Nothing else is kept account of, so
there is nothing that could disagree, and what is lost is flown again.
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
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError, SomersaultWarning
from somersault._core.files import umask
from somersault.engine import processor
from somersault.ensembles._plan import SAMPLE, Plan
from somersault.ensembles._report import ENDINGS, Variable, variables

if TYPE_CHECKING:
    import xarray as xr
    import zarr

_FORMAT = "somersault ensemble 1"
_STALE = 60.0  # s after which a half-written file is nobody's


@dataclass(frozen=True)
class Layout:
    """How flights are cut into chunks: blocks of the dimensions, each a run of flights."""

    dims: Mapping[str, int]
    chunk: tuple[int, ...]

    @property
    def grid(self) -> tuple[int, ...]:
        """Chunks along each dimension."""
        return tuple(-(-n // c) for n, c in zip(self.dims.values(), self.chunk, strict=True))

    def __len__(self) -> int:
        return math.prod(self.grid)

    def place(self, k: int) -> tuple[int, ...]:
        """Where chunk k is in the grid of chunks."""
        return tuple(int(i) for i in np.unravel_index(k, self.grid))

    def region(self, k: int) -> tuple[slice, ...]:
        """What chunk k covers."""
        return tuple(
            slice(i * c, min((i + 1) * c, n))
            for i, c, n in zip(self.place(k), self.chunk, self.dims.values(), strict=True)
        )

    def flights(self, k: int) -> tuple[int, int]:
        """First flight of chunk k, and the one after its last."""
        region, shape = self.region(k), tuple(self.dims.values())
        first = np.ravel_multi_index([r.start for r in region], shape)
        last = np.ravel_multi_index([r.stop - 1 for r in region], shape)
        return int(first), int(last) + 1

    def size(self, k: int) -> int:
        """How many flights chunk k has."""
        first, last = self.flights(k)
        return last - first


def layout(dims: Mapping[str, int], most: int) -> Layout:
    """Chunks of at most `most` flights, nearly alike, each a run of flights in order."""
    lengths, inside = list(dims.values()), 1
    chunk: list[int] = []
    for length in reversed(lengths):
        parts = -(-length // max(most // inside, 1))
        chunk.insert(0, -(-length // parts))
        # Ahead of a dimension that is cut, chunks are one thick.
        inside = inside * length if parts == 1 else most
    return Layout(dims, tuple(chunk))


def create(path: Path, plan: Plan, cut: Layout) -> None:
    """An empty store for a plan, there as a whole or not at all."""
    import zarr

    path.parent.mkdir(parents=True, exist_ok=True)
    fresh = Path(tempfile.mkdtemp(dir=path.parent, prefix=f".{path.name}."))
    try:
        group = zarr.create_group(store=str(fresh))
        group.attrs.put(_attributes(plan, cut))
        times = plan.report.times(plan.duration)
        dims, shape = tuple(cut.dims), tuple(cut.dims.values())
        for name, v in variables(plan.report, plan.system).items():
            _array(group, name, v, dims, shape, cut.chunk, len(times))
        for name, vary in plan.vary.items():
            dim = name if name in cut.dims else SAMPLE
            length = cut.chunk[dims.index(dim)]
            made = _create(group, name, "f8", (cut.dims[dim],), (length,), (dim,), np.nan)
            made.attrs.put(coordinate_attributes(vary))
            if vary.grid is not None:
                made[:] = vary.grid
        if plan.report.history:
            made = _create(
                group, "history_time", "f8", times.shape, times.shape, ("history_time",), np.nan
            )
            made.attrs.put({"units": "s"})
            made[:] = times
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


def _array(
    group: zarr.Group, name: str, v: Variable, dims: tuple[str, ...], shape: tuple[int, ...],
    chunk: tuple[int, ...], samples: int,
) -> None:  # fmt: skip
    if v.over_time:
        dims, shape, chunk = (*dims, "history_time"), (*shape, samples), (*chunk, samples)
    made = _create(group, name, v.dtype, shape, chunk, dims, v.fill)
    made.attrs.put(variable_attributes(name, v))


def _create(
    group: zarr.Group, name: str, dtype: str, shape: tuple[int, ...], chunk: tuple[int, ...],
    dims: tuple[str, ...], fill: Any,
) -> zarr.Array:  # fmt: skip
    return group.create_array(
        name, shape=shape, chunks=chunk, dtype=dtype, fill_value=fill, dimension_names=dims,
        compressors=None,  # digits do not shrink, and a whole file is told by its size
    )  # fmt: skip


def variable_attributes(name: str, v: Variable) -> dict[str, Any]:
    """Units, and for `ended` what its codes mean (as the CF conventions have it)."""
    found: dict[str, Any] = {"units": v.unit}
    if v.words:
        found["long_name"] = v.words
    if name == "ended":
        found["flag_values"] = list(range(len(ENDINGS)))
        found["flag_meanings"] = " ".join(word.replace(" ", "_") for word in ENDINGS)
    return found


def coordinate_attributes(vary: Any) -> dict[str, Any]:
    """What a varied quantity moves, and its unit."""
    found: dict[str, Any] = {("adds_to" if vary.adds_to else "sets"): list(vary.targets)}
    if vary.scale != 1:
        found["scale"] = vary.scale
    return {**found, "units": vary.unit} if vary.unit else found


def _attributes(plan: Plan, cut: Layout) -> dict[str, Any]:
    along = [name for name, vary in plan.vary.items() if vary.grid is None]
    more: dict[str, Any] = {"coordinates": " ".join(along)} if along else {}
    names = list(variables(plan.report, plan.system))
    return {**attributes(plan), "variables": names, "chunk": list(cut.chunk), **more}


def attributes(plan: Plan) -> dict[str, Any]:
    """What a dataset says of itself: specification and versions, as JSON texts, and the kind of
    processor it was begun on."""
    return {
        "format": _FORMAT,
        "model": plan.model.name,
        "specification": json.dumps(plan.specification),
        "versions": json.dumps(plan.engines),
        "processor": processor(),
    }


def resume(path: Path, plan: Plan) -> Layout:
    """The layout of a store that is this plan's; SomersaultError for any other."""
    attrs = _read_attributes(path)
    theirs, ours = json.loads(attrs["specification"]), json.loads(json.dumps(plan.specification))
    if theirs != ours:
        key = _difference(theirs, ours)
        raise SomersaultError(
            f"{path} holds an ensemble of another specification ({key} differs); give another "
            "--out, or remove it"
        )
    begun, now = json.loads(attrs["versions"]), plan.engines
    if begun != now:
        other = ", ".join(f"{name} {v}" for name, v in begun.items() if now.get(name) != v)
        raise SomersaultError(
            f"{path} was begun with {other}, whose last digits may differ; go on with that, or "
            "give another --out"
        )
    return Layout(plan.dims, tuple(attrs["chunk"]))


def note_processor(path: Path) -> None:
    """Warn where a store was begun on another kind of processor than this one."""
    begun = _read_attributes(path).get("processor")
    if begun != processor():
        where = f"on {begun}" if begun else "by a version that did not record its processor"
        warnings.warn(
            f"{path} was begun {where}, and this is {processor()}: the last digits of what is "
            "flown now may differ; go on there, or begin another, if they matter",
            SomersaultWarning,
            stacklevel=2,
        )


def _read_attributes(path: Path) -> dict[str, Any]:
    import zarr

    try:
        attrs: dict[str, Any] = dict(zarr.open_group(str(path), mode="r").attrs)
        if attrs.get("format") != _FORMAT:
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


def finished(path: Path, plan: Plan, cut: Layout) -> set[int]:
    """Numbers of the chunks that are complete: every variable's file there, and whole."""
    found = set(range(len(cut)))
    samples = len(plan.report.times(plan.duration))
    for name, v in variables(plan.report, plan.system).items():
        each = np.dtype(v.dtype).itemsize * (samples if v.over_time else 1)
        places = _files(path / name / "c", each * math.prod(cut.chunk))
        depth = len(cut.grid)
        found &= {int(np.ravel_multi_index(p[:depth], cut.grid)) for p in places}
    along = [name for name, vary in plan.vary.items() if vary.grid is None]
    if along:
        at = list(cut.dims).index(SAMPLE)
        there = [_files(path / name / "c", 8 * cut.chunk[at]) for name in along]
        known = {p[0] for p in set.intersection(*there)}
        found -= {k for k in found if _tells_samples(cut, k) and cut.place(k)[at] not in known}
    return found


def _files(root: Path, size: int) -> set[tuple[int, ...]]:
    """Places of the chunk files below a folder that have a size, bytes."""
    found = set()
    for folder, _, files in os.walk(root):
        ahead = Path(folder).relative_to(root).parts
        for file in files:
            place = (*ahead, file)
            whole = os.path.getsize(os.path.join(folder, file)) == size
            if whole and all(p.isdecimal() for p in place):
                found.add(tuple(int(p) for p in place))
    return found


def _tells_samples(cut: Layout, k: int) -> bool:
    """Whether chunk k writes what is drawn: the first for its samples, by all other dimensions."""
    pairs = zip(cut.dims, cut.place(k), strict=True)
    return SAMPLE in cut.dims and not any(i for dim, i in pairs if dim != SAMPLE)


def write(path: Path, plan: Plan, cut: Layout, k: int, rows: Mapping[str, Array]) -> None:
    """The variables of chunk k into the store, `ended` last."""
    try:
        _write(path, plan, cut, k, rows)
    except OSError as trouble:  # of a full disk, which does not say of which file
        raise OSError(trouble.errno, trouble.strerror, str(path)) from None


def _write(path: Path, plan: Plan, cut: Layout, k: int, rows: Mapping[str, Array]) -> None:
    arrays = _arrays(str(path), (path / "zarr.json").stat().st_mtime_ns)
    region = cut.region(k)
    dims = list(cut.dims)
    if _tells_samples(cut, k):
        along = region[dims.index(SAMPLE)]
        for name, values in plan.drawn(np.arange(along.start, along.stop)).items():
            arrays[name][along] = values
    for name, values in rows.items():
        arrays[name][region] = _shaped(values, region)


def _shaped(values: Array, region: tuple[slice, ...]) -> Array:
    """Rows of flights (N, …) as the block of the dimensions that they are."""
    return values.reshape(*(r.stop - r.start for r in region), *values.shape[1:])


@lru_cache(maxsize=4)
def _arrays(path: str, made: int) -> dict[str, Any]:
    """The arrays of the store that was `made` (ns) at a path, opened once for all chunks."""
    import zarr

    # A chunk that is all NaN, of flights that failed, is written too: a file that is not there
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
    """The dataset of a store, read as it is used; what is not flown yet is NaN (`ended` 255)."""
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
            if data.attrs.get("format") == _FORMAT:
                return data.load()
    except (OSError, ValueError):
        pass
    raise SomersaultError(f"{path} is there, but is no ensemble")


def gathered(plan: Plan, cut: Layout) -> tuple[xr.Dataset, Any]:
    """An empty dataset in memory, and what puts the rows of chunk k into it."""
    import xarray as xr

    dims, shape = tuple(cut.dims), tuple(cut.dims.values())
    times = plan.report.times(plan.duration)
    found: dict[str, Any] = {}
    for name, v in variables(plan.report, plan.system).items():
        whole = np.full((*shape, len(times)) if v.over_time else shape, v.fill, v.dtype)
        over = (*dims, "history_time") if v.over_time else dims
        found[name] = (over, whole, variable_attributes(name, v))
    coords: dict[str, Any] = {}
    drawn = plan.drawn(np.arange(cut.dims.get(SAMPLE, 0)))
    for name, vary in plan.vary.items():
        dim, values = (SAMPLE, drawn[name]) if vary.grid is None else (name, vary.grid)
        coords[name] = (dim, values, coordinate_attributes(vary))
    if plan.report.history:
        coords["history_time"] = ("history_time", times, {"units": "s"})
    data = xr.Dataset(found, coords, attributes(plan))

    def put(k: int, rows: Mapping[str, Array]) -> None:
        region = cut.region(k)
        for name, values in rows.items():
            found[name][1][region] = _shaped(values, region)

    return data, put
