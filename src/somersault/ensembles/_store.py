"""Ensembles on disk: a Zarr store that fills chunk by chunk and can be left at any moment.

Every chunk of every variable is a file that is written under another name and then renamed. A chunk
is finished when its seal is there and fits: what is lost, or is not what was written, is run again.
"""

from __future__ import annotations

import json
import time
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault._core.interrupts import unbroken
from somersault._core.notes import note
from somersault.engine import processor
from somersault.ensembles._begin import write_anew
from somersault.ensembles._chunks import Chunks
from somersault.ensembles._metadata import (
    GROUP,
    DamagedMetadataError,
    chunk_of_array,
    coordinates_are_whole,
    damaged_arrays,
    fixed_coordinates,
    read_metadata,
)
from somersault.ensembles._plan import SAMPLE, SEAL, Plan
from somersault.ensembles._seals import brings_samples, seals_of_plan
from somersault.simulation import ENDED

if TYPE_CHECKING:
    import xarray as xr

_STALE = 60.0  # s after which a half-written file is nobody's


def resume(path: Path, plan: Plan) -> Chunks:
    """The chunks of a store that is this plan's; SomersaultError for any other.

    What else than chunks is damaged in it is written anew, with a warning.
    """
    names: list[str] | None = None  # arrays to write anew; None: the group too
    try:
        metadata = read_metadata(path)
    except DamagedMetadataError:
        chunks = _surviving_chunks(path, plan)
    else:
        chunks = _chunks_of(path, plan, metadata)
        names = damaged_arrays(path, metadata)
        if not coordinates_are_whole(path, metadata):
            names = sorted({*names, *fixed_coordinates(metadata)})
    if names is None or names:
        write_anew(path, plan, chunks, names)
        what = "metadata" if names is None else f"what it says of {', '.join(names)}"
        note(f"{path} was damaged ({what}), and has been mended")
    return chunks


def is_of(path: Path, plan: Plan) -> bool:
    """Whether a store is this plan's."""
    try:
        _chunks_of(path, plan, read_metadata(path))
    except SomersaultError:
        return False
    return True


def _chunks_of(path: Path, plan: Plan, metadata: dict[str, Any]) -> Chunks:
    """The chunks of a store, if its metadata are this plan's."""
    attrs = metadata["attributes"]
    theirs, ours = json.loads(attrs["specification"]), json.loads(json.dumps(plan.specification))
    if theirs != ours:
        key = _difference(theirs, ours)
        raise SomersaultError(
            f"{path} holds an ensemble of another specification ({key} differs); write to "
            "another place, or remove it"
        )
    begun, now = json.loads(attrs["versions"]), plan.versions
    if begun != now:
        other = ", ".join(f"{name} {v}" for name, v in begun.items() if now.get(name) != v)
        raise SomersaultError(
            f"{path} was begun with {other}, whose last digits may differ; go on with that, or "
            "write to another place"
        )
    return Chunks(plan.dims, tuple(attrs["chunk"]))


def _surviving_chunks(path: Path, plan: Plan) -> Chunks:
    """The chunks of a store whose metadata are lost, if seals show that it is this plan's."""
    shape = chunk_of_array(path / ENDED)
    if shape is not None and len(shape) == len(plan.dims):
        chunks = Chunks(plan.dims, shape)
        if seals_of_plan(path, plan, chunks).check()[0]:
            return chunks
    raise SomersaultError(
        f"{path / GROUP} is damaged, and nothing else shows that {path} is of this specification; "
        "write to another place, or remove it"
    )


def note_processor(path: Path) -> None:
    """Warn where a store was begun on another kind of processor than this one."""
    begun = read_metadata(path)["attributes"]["processor"]
    if begun != processor():
        note(
            f"{path} was begun on {begun}, and this is {processor()}: the last digits of what is "
            "run now may differ; go on there, or begin another, if they matter"
        )


def _difference(theirs: Any, ours: Any, key: str = "") -> str:
    """The first key in which two specifications differ."""
    if isinstance(theirs, dict) and isinstance(ours, dict):
        for name in dict.fromkeys([*theirs, *ours]):
            if theirs.get(name) != ours.get(name):
                return _difference(theirs.get(name), ours.get(name), f"{key}.{name}".lstrip("."))
    return key


def finished(path: Path, plan: Plan, chunks: Chunks) -> set[int]:
    """Numbers of the chunks that are complete and whole; a warning says how many are damaged."""
    complete, damaged = seals_of_plan(path, plan, chunks).check()
    if damaged:
        were, are = ("chunk was", "is") if len(damaged) == 1 else ("chunks were", "are")
        note(f"{len(damaged):,} {were} damaged in {path}, and {are} run again")
    return complete


def write(path: Path, plan: Plan, chunks: Chunks, k: int, rows: Mapping[str, Array]) -> None:
    """The variables of chunk k into the store, its seal last."""
    try:
        with unbroken():
            _write(path, plan, chunks, k, rows)
    except OSError as trouble:  # of a full disk, which does not say of which file
        raise OSError(trouble.errno, trouble.strerror, str(path)) from None


def _write(path: Path, plan: Plan, chunks: Chunks, k: int, rows: Mapping[str, Array]) -> None:
    arrays = _arrays(str(path), (path / GROUP).stat().st_mtime_ns)
    region, seals = chunks.region(k), seals_of_plan(path, plan, chunks)
    seals.make_way(k)
    if brings_samples(chunks, k):
        along = region[list(chunks.dims).index(SAMPLE)]
        for name, values in plan.drawn(np.arange(along.start, along.stop)).items():
            arrays[name][along] = values
    for name in plan.variables:
        arrays[name][region] = as_block(rows[name], region)
    arrays[SEAL][chunks.place(k)] = np.frombuffer(seals.seal(k), np.uint8)


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

    data = xr.open_zarr(str(path), chunks=None)
    names = data.attrs["variables"]
    for name in ("variables", "chunk", "fixed", "digest"):  # of the store, not of the data
        data.attrs.pop(name)
    return data[names]
