"""Histories of flights as files."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from somersault._core.errors import SomersaultError
from somersault._core.files import write

if TYPE_CHECKING:
    import xarray as xr

    from somersault.flight._flight import Flight


def save(flight: Flight, path: Path) -> None:
    """Write NetCDF or CSV by the file's ending, whole or not at all."""
    check_ending(path)
    write(path, csv(flight) if path.suffix.lower() == ".csv" else netcdf(flight.dataset))


def check_ending(path: Path) -> None:
    """SomersaultError unless flights can be written to a file of that name."""
    if path.suffix.lower() not in (".csv", ".nc"):
        raise SomersaultError(f"{path.name}: flights are written as .nc (NetCDF) or .csv")


def csv(flight: Flight) -> str:
    """One row a sample; the header names each column with its unit."""
    data = flight.dataset
    columns: dict[str, list[float]] = {"time [s]": data["time"].values.tolist()}
    for name, variable in data.data_vars.items():
        unit = variable.attrs["units"]
        if variable.ndim == 1:
            columns[f"{name} [{unit}]"] = variable.values.tolist()
            continue
        labels = data[variable.dims[1]].values.tolist()
        for index, label in enumerate(labels):
            columns[f"{name} {label} [{unit}]"] = variable.values[:, index].tolist()
    rows = zip(*columns.values(), strict=True)
    quoted = ",".join(f'"{name}"' if "," in name else name for name in columns)
    return "\n".join([quoted, *(",".join(map(repr, row)) for row in rows)]) + "\n"


def netcdf(data: xr.Dataset) -> bytes:
    """A dataset as the bytes of a NetCDF file."""
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "data.nc")
        data.to_netcdf(file, engine="h5netcdf")
        return Path(file).read_bytes()
