"""Labelled datasets as files: NetCDF, or CSV with a unit in each column's name."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from somersault._core.errors import SomersaultError
from somersault._core.files import write

if TYPE_CHECKING:
    import xarray as xr


def save_history(data: xr.Dataset, path: Path) -> None:
    """Write a dataset over `time` as NetCDF or CSV by the file's ending, whole or not at all."""
    check_history_file(path)
    write(path, csv(data) if path.suffix.lower() == ".csv" else netcdf(data))


def check_history_file(path: Path) -> None:
    """SomersaultError unless flights can be written to a file of that name."""
    if path.suffix.lower() not in (".csv", ".nc"):
        raise SomersaultError(f"{path.name}: flights are written as .nc (NetCDF) or .csv")


def csv(data: xr.Dataset) -> str:
    """One row a sample; the header names each column with its unit."""
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
