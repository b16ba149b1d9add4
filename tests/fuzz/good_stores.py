"""Ensembles as they are kept: every file of a Zarr store in turn, and NetCDF files."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import somersault as so
from somersault.ensembles import Plan, carried_out, plan
from somersault.flight import flights

from .good import Folder

STORE = "map.zarr"
_CHUNK = 4  # flights


@cache
def planned() -> Plan:
    """A dozen flights with all that can be kept of them."""
    report = so.Report(("tilt",), extremes=("tilt",), history=("twist",), samples=3)
    vary = {
        "start": so.Vary(adds_to="takeoff.tilt", normal=(0, 0.1)),
        "rate": so.Vary(sets="takeoff.spin", values=[4.0, 6.0]),
    }
    return plan(flights("book", so.Takeoff(spin=5.0), 0.2, report=report), vary, 6, 0)


def carried_on(store: Path) -> Any:
    """The dataset of the plan, in a store that may be there already, after all of it has run."""
    return carried_out(planned(), store, chunk=_CHUNK, threads=1).dataset.load()


@cache
def whole() -> Any:
    """The dataset as it is to be."""
    return carried_out(planned(), None, chunk=_CHUNK, threads=1).dataset.load()


@cache
def _files() -> Folder:
    with TemporaryDirectory() as place:
        carried_on(Path(place, STORE))
        return {
            file.relative_to(place).as_posix(): file.read_bytes()
            for file in sorted(Path(place).rglob("*"))
            if file.is_file()
        }


def _each_first(names: list[str]) -> list[Folder]:
    return [{name: _files()[name], **_files()} for name in names]


@cache
def chunks() -> list[Folder]:
    """A store, once for each of its files that is of numbers."""
    return _each_first([name for name in _files() if not name.endswith(".json")])


@cache
def metadata() -> list[Folder]:
    """A store, once for each of its files that describes others."""
    return _each_first([name for name in _files() if name.endswith(".json")])


@cache
def netcdf() -> list[Folder]:
    """The same as one NetCDF file."""
    with TemporaryDirectory() as place:
        file = Path(place, "map.nc")
        carried_out(planned(), file, chunk=_CHUNK, threads=1)
        return [{file.name: file.read_bytes()}]
