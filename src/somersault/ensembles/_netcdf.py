"""Ensembles as NetCDF files, which carry the digest of what is in them."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.canonical import canonical
from somersault._core.datasets import netcdf
from somersault._core.errors import SomersaultError
from somersault._core.files import write
from somersault._core.hdf5 import require_readable
from somersault.ensembles._labels import FORMAT

if TYPE_CHECKING:
    import xarray as xr


def save(data: xr.Dataset, path: Path) -> None:
    """Write an ensemble as NetCDF, whole or not at all."""
    write(path, netcdf(data.assign_attrs(digest=_digest(data))))


def read(path: Path) -> xr.Dataset:
    """The ensemble of a file; SomersaultError for one that is none, or is not what was written."""
    import xarray as xr

    require_readable(path)
    try:
        with xr.open_dataset(path, engine="h5netcdf") as file:
            data = file.load()
    except (OSError, ValueError, KeyError, TypeError, RuntimeError):
        data = None
    if data is None or data.attrs.get("format") != FORMAT:
        raise SomersaultError(
            f"{path} is there, but is no ensemble of this version of somersault, or is damaged; "
            "run the ensemble again"
        )
    said = data.attrs.pop("digest", None)  # which a dataset saved by xarray does not have
    if said is not None and said != _digest(data):
        raise SomersaultError(f"{path} is not what was written; run the ensemble again")
    return data


def _digest(data: xr.Dataset) -> str:
    digest = hashlib.sha256(_text(_attributes(data.attrs)))
    for name in sorted(map(str, data.variables)):
        variable = data[name]
        kind = str(variable.dtype)
        said = [name, variable.dims, kind, variable.shape, _attributes(variable.attrs)]
        digest.update(_text(said))
        digest.update(np.ascontiguousarray(variable.values).tobytes())
    return digest.hexdigest()


def _attributes(said: Mapping[Any, Any]) -> dict[str, Any]:
    """Attributes as NetCDF has them, which cannot tell a row of one from the one."""
    return {
        name: x[0] if isinstance(x, list) and len(x) == 1 else x
        for name, x in canonical(said).items()
    }


def _text(said: Any) -> bytes:
    return json.dumps(said, sort_keys=True).encode()
