"""HDF5 files of others, tried before they are opened: over strange bytes HDF5 may go on for ever.

Run as a program with a file and limits it reads all that is in the file, and says so or why not.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

from somersault._core import limited
from somersault._core.errors import SomersaultError
from somersault._core.files import check_is_file

_WHOLE = "whole"


def require_readable(path: Path) -> None:
    """SomersaultError for a file that HDF5 cannot read, within limits of time and memory."""
    check_is_file("file", path)  # and no pipe that nobody writes to
    try:
        why = limited.answer(__file__, os.path.abspath(path)).decode(errors="replace")
    except limited.Ended as end:
        why = f"it {end}"
    if why != _WHOLE:
        raise SomersaultError(
            f"{path.name} cannot be read as NetCDF: {why}; give a file that was written here"
        )


def _main(path: str, *limits: str) -> str:
    import h5py

    def read(name: str, item: object) -> None:
        dict(item.attrs)  # type: ignore[attr-defined]
        if isinstance(item, h5py.Dataset):
            item[()]

    limited.limit(*limits)
    try:
        with h5py.File(path) as file:
            dict(file.attrs)
            file.visititems(read)
    except MemoryError:
        return f"it asks for more than {limited.MORE_BYTES / 2**30:g} GB of memory"
    except Exception as trouble:  # whatever HDF5 meets in bytes that are not its own
        return " ".join(str(trouble).split()).rstrip(".")[:200] or type(trouble).__name__
    return _WHOLE


if __name__ == "__main__":
    words = _main(*sys.argv[1:])
    sys.stdout.write(words)
    sys.stdout.flush()
    os._exit(0)  # what HDF5 says while it closes a damaged file is nothing to anybody
