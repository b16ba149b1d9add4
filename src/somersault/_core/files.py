"""Files that are either whole or not there."""

from __future__ import annotations

import errno
import os
import stat
import tempfile
from pathlib import Path


def write(path: Path, content: str | bytes) -> None:
    """Write a file under a temporary name beside it, then rename it: never half a file."""
    data = content.encode() if isinstance(content, str) else content
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(data)
            os.chmod(name, 0o666 & ~umask())
            os.replace(name, path)
        except BaseException:
            os.unlink(name)
            raise
    except OSError as trouble:  # of the file that was asked for, not of its temporary name
        raise OSError(trouble.errno, trouble.strerror, str(path)) from None


def umask() -> int:
    """The permissions that this process withholds from new files."""
    mask = os.umask(0)
    os.umask(mask)
    return mask


def read_bytes(path: Path, most: int) -> bytes:
    """The first `most` bytes of a file; OSError for what is none, a pipe or a device among them.

    Nobody waits for a pipe that no one writes to.
    """
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with os.fdopen(handle, "rb") as file:
        if not stat.S_ISREG(os.fstat(handle).st_mode):
            raise OSError(errno.EINVAL, "Not a file but a folder, a pipe or a device", str(path))
        return file.read(most)
