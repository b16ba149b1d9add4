"""Labelled datasets as files: NetCDF, or CSV with a unit in each column's name."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from somersault._core.files import temporary_folder, write
from somersault._core.places import check_file

if TYPE_CHECKING:
    import xarray as xr


def save_history(data: xr.Dataset, path: str | os.PathLike[str]) -> None:
    """Write a dataset over `time` as NetCDF or CSV by the file's ending, whole or not at all."""
    file = check_history_file(path)
    write(file, csv(data) if file.suffix.lower() == ".csv" else netcdf(data))


def check_history_file(path: Any) -> Path:
    """The path of a file that flights can be written to; SomersaultError for any other."""
    return check_file(path, (".nc", ".csv"))


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
    with temporary_folder() as folder:
        file = folder / "data.nc"
        data.to_netcdf(file, engine="h5netcdf")
        return file.read_bytes()
