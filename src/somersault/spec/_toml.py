"""TOML files, read and written whole."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from somersault._core.checks import file_path, shown
from somersault._core.errors import SomersaultError
from somersault._core.files import check_is_file, read_bytes, write

_MOST_BYTES = 10_000_000


def read_toml(path: Path) -> dict[str, Any]:
    """The tables of a TOML file.

    Parameters
    ----------
    path : pathlib.Path
        Of a file of at most 10 MB.

    Returns
    -------
    dict

    Raises
    ------
    SomersaultError
        For a file that is not there, is too large, or is not TOML.
    """
    path = file_path("a SPEC", path)
    check_is_file("SPEC file", path)
    try:
        data = read_bytes(path, _MOST_BYTES + 1)
    except OSError as trouble:
        raise SomersaultError(f"{path} cannot be read ({trouble.strerror}); check it") from None
    if len(data) > _MOST_BYTES:
        raise SomersaultError(f"{path.name} is larger than 10 MB, which no SPEC is; check the file")
    try:
        return tomllib.loads(data.decode("utf-8-sig").replace("\r\n", "\n"))
    except UnicodeDecodeError:
        raise SomersaultError(f"{path.name} is not UTF-8, as TOML is; save it as that") from None
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise SomersaultError(f"{path.name} is not TOML: {error}; correct the file") from None
    except ValueError:  # an integer of more digits than Python reads
        raise SomersaultError(f"{path.name} has a number that is too long; shorten it") from None


def write_toml(path: Path, tables: Mapping[str, Any]) -> None:
    """Write tables as a TOML file, whole or not at all.

    Parameters
    ----------
    path : pathlib.Path
    tables : mapping

    Raises
    ------
    SomersaultError
        For what is no path or a folder, what cannot be written, and what TOML cannot hold.
    """
    import tomli_w

    try:
        text = tomli_w.dumps(tables)
    except (TypeError, ValueError, AttributeError, RecursionError) as trouble:
        raise SomersaultError(f"these tables cannot be written as TOML: {trouble}") from None
    file = file_path("path", path)
    if os.path.isdir(file):
        raise SomersaultError(f"{file} is a folder; give the name of a file")
    try:
        write(file, text)
    except OSError as trouble:
        raise SomersaultError(
            f"{file} cannot be written ({trouble.strerror}); give another place"
        ) from None


def require_table(given: Any) -> None:
    """SomersaultError where what is given for a SPEC is no table.

    Parameters
    ----------
    given : object

    Raises
    ------
    SomersaultError
        For what is no mapping.
    """
    if not isinstance(given, Mapping):
        raise SomersaultError(f"a SPEC is a table of keys, and not {shown(given)}")


def model_beside(name: Any, folder: Path) -> Any:
    """A model's name as a SPEC has it, or its place in the SPEC's folder if anything is there.

    Parameters
    ----------
    name : object
        What is no text stays as it is.
    folder : pathlib.Path

    Returns
    -------
    object
    """
    if isinstance(name, str) and Path(name).suffix and os.path.exists(folder / name):
        return str(folder / name)
    return name
