"""The 95 measurements of Yeadon's inertia model, from a file or a mapping.

Yeadon MR (1990) The simulation of aerial movement II: a mathematical inertia model of the human
body. J Biomech 23(1):67-74. Names and file format are those of the `yeadon` package (Dembia C,
Moore JK, Hubbard M (2014) An object oriented implementation of the Yeadon human inertia model.
F1000Research 3:233).
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Mapping
from typing import Any

from somersault._core.checks import file_path, shown
from somersault._core.errors import SomersaultError
from somersault._core.files import read_bytes

_MOST_BYTES = 100_000
_FACTOR, _MASS = "measurementconversionfactor", "totalmass"
_LEAST, _MOST = 0.001, 3.0  # m, of any measurement
_LINE = re.compile(r"\s*([A-Za-z0-9]+)\s*[:=]\s*(\S+)\s*")


def read_measurements(
    source: str | os.PathLike[str] | Mapping[str, Any], names: Iterable[str]
) -> tuple[dict[str, float], float | None]:
    """The measurements of those names in m, and the measured mass in kg if there is one.

    A file has lines `name: number` and comments after #. `measurementconversionfactor` (1 if
    it is left out) makes metres of the numbers; `totalmass` is in kg.

    Raises SomersaultError for a file that is not there or not of that form, a name that is
    missing, unknown or given twice, and a number that is not finite and positive or, in
    metres, outside 0.001 to 3.
    """
    if isinstance(source, Mapping):
        where, given = "the measurements", {str(name): value for name, value in source.items()}
    else:
        where, given = _read(source)
    wanted = tuple(names)
    for name in given:
        if name not in (*wanted, _FACTOR, _MASS):
            raise SomersaultError(f"{where}: {name!r} is no measurement; remove it")
    missing = [name for name in wanted if name not in given]
    if missing:
        shown = ", ".join(missing[:5]) + (", …" if len(missing) > 5 else "")
        raise SomersaultError(
            f"{where}: {len(missing)} of the {len(wanted)} measurements are missing ({shown}); "
            "add them"
        )
    numbers = {name: _positive(where, name, value) for name, value in given.items()}
    mass = numbers.pop(_MASS, None)
    factor = numbers.pop(_FACTOR, 1.0)
    metres = {name: factor * numbers[name] for name in wanted}
    for name, value in metres.items():
        if not _LEAST <= value <= _MOST:
            raise SomersaultError(
                f"{where}: {name} is {value:g} m; give {_LEAST:g} to {_MOST:g} m, or the unit as "
                f"{_FACTOR} (0.01 for centimetres, 0.001 for millimetres)"
            )
    return metres, mass


def _read(source: str | os.PathLike[str]) -> tuple[str, dict[str, str]]:
    """The file's name, and what it gives each name."""
    path = file_path("the measurements, unless they are given by name,", source)
    try:
        data = read_bytes(path, _MOST_BYTES + 1)
        text = data.decode("utf-8")
    except (ValueError, OSError) as error:
        reason = getattr(error, "strerror", None) or "it is no text file"
        raise SomersaultError(
            f"the measurements {str(source)!r} cannot be read ({reason}); give a text file or a "
            "mapping"
        ) from None
    if len(data) > _MOST_BYTES:
        raise SomersaultError(f"{path.name} is larger than 100 kB, which no measurements are")
    given: dict[str, str] = {}
    for number, line in enumerate(text.splitlines(), 1):
        bare = line.partition("#")[0]
        if not bare.strip():
            continue
        found = _LINE.fullmatch(bare)
        if found is None:
            raise SomersaultError(
                f"{path.name}, line {number}: {line.strip()[:40]!r} is not 'name: number'"
            )
        name, value = found.groups()
        if name in given:
            raise SomersaultError(f"{path.name}, line {number}: {name} is given twice; keep one")
        given[name] = value
    return path.name, given


def _positive(where: str, name: str, value: Any) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not 0 < number < math.inf:
        raise SomersaultError(f"{where}: {name} is {shown(value)}; give a positive number")
    return number
