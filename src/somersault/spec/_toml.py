"""TOML files, read and written whole."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from somersault._core.errors import SomersaultError
from somersault._core.files import write

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
    if not path.is_file():
        raise SomersaultError(f"there is no SPEC file {str(path)!r}; check the path")
    if path.stat().st_size > _MOST_BYTES:
        raise SomersaultError(f"{path.name} is larger than 10 MB, which no SPEC is; check the file")
    try:
        return tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise SomersaultError(f"{path.name} is not TOML: {error}; correct the file") from None
    except ValueError:  # an integer of more digits than Python reads
        raise SomersaultError(f"{path.name} has a number that is too long; shorten it") from None


def write_toml(path: Path, tables: Mapping[str, Any]) -> None:
    """Write tables as a TOML file, whole or not at all.

    Parameters
    ----------
    path : pathlib.Path
    tables : mapping
    """
    import tomli_w

    write(path, tomli_w.dumps(tables))
