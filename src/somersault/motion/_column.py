"""One column of a table against its time, as a torque is recorded."""

from __future__ import annotations

import os

from somersault._core.checks import file_path, shown, text
from somersault._core.errors import SomersaultError
from somersault.motion._tables import column_name, seconds, table_of


def read_column(
    path: str | os.PathLike[str], column: str | None = None
) -> tuple[tuple[float, ...], tuple[float, ...]]:
    r"""Times (s) and values of a column of a .csv, .tsv, .txt, .mot or .sto file.

    Parameters
    ----------
    path : str or path-like
    column : str, optional
        Its name, without the unit that may follow in brackets; it may be left out where the file
        has one column besides `time`. Values are in SI units.

    Returns
    -------
    times, values : tuple of float

    Raises
    ------
    SomersaultError
        For a file that cannot be read, and a column that is not there.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder) / "hip.csv"
    ...     _ = file.write_text("time [ms],hip\n0,0\n100,25\n")
    ...     read_column(file)
    ((0.0, 0.1), (0.0, 25.0))
    """
    file = file_path("path", path)
    if column is not None:
        text("column", column)
    try:
        table = table_of(file)
        names = [column_name(label) for label in table.labels]
        if "time" not in map(str.lower, names):
            raise SomersaultError("it has no column named time; name the one with the seconds so")
        at = [name.lower() for name in names].index("time")
        others = [name for k, name in enumerate(names) if k != at]
        wanted = others[0] if column is None and len(others) == 1 else column
        if wanted not in others:
            said = "names no column of it" if column is None else f"has no column {shown(column)}"
            raise SomersaultError(f"{said}; name one of {', '.join(others[:12])}")
        times = seconds(table.labels[at]) * table.values[:, at]
        values = table.values[:, names.index(wanted)]
    except SomersaultError as mistake:
        raise SomersaultError(f"{file.name}: {mistake}") from None
    return tuple(times.tolist()), tuple(values.tolist())
