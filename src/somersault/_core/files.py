"""Files that are either whole or not there."""

from __future__ import annotations

import errno
import os
import secrets
import shutil
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from somersault._core.errors import SomersaultError
from somersault._core.interrupts import removed_after, unbroken


def write(path: Path, content: str | bytes) -> None:
    """Write a file under a temporary name beside it, then rename it: never half a file."""
    data = content.encode(errors="replace") if isinstance(content, str) else content
    try:
        with unbroken():
            path.parent.mkdir(parents=True, exist_ok=True)
            with temporary_name(path.parent) as name:
                handle = os.open(name, os.O_WRONLY | os.O_CREAT | os.O_EXCL | _BINARY, 0o666)
                with os.fdopen(handle, "wb") as file:
                    file.write(data)
                os.replace(name, path)
    except OSError as trouble:  # of the file that was asked for, not of its temporary name
        raise OSError(trouble.errno, trouble.strerror, str(path)) from None


_BINARY = getattr(os, "O_BINARY", 0)


@contextmanager
def temporary_name(folder: Path) -> Iterator[Path]:
    """A name in a folder for what is not finished; what is there afterwards is removed."""
    name = folder / f".somersault-{secrets.token_hex(8)}"
    with removed_after(name):
        yield name


@contextmanager
def temporary_folder(parent: Path | None = None) -> Iterator[Path]:
    """An empty folder, by default where the system has such; removed with all that is in it."""
    with temporary_name(Path(tempfile.gettempdir()) if parent is None else parent) as name:
        name.mkdir(mode=0o700)
        yield name


def make_way(path: Path) -> None:
    """Remove what stands where a file is to be, like a folder or a pipe, or where one of its
    folders is to be, like a file; a file in its place stays."""
    for folder in path.parents:  # nearest first
        if folder.is_dir():
            break
        with suppress(OSError):  # it is not there; or another program was quicker
            folder.unlink()
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    elif path.exists() and not path.is_file():
        path.unlink()


def check_is_file(what: str, path: str | os.PathLike[str]) -> None:
    """SomersaultError, calling it `what`, where there is no file: nothing, or something else."""
    if os.path.isfile(path):  # which, unlike pathlib, takes any name
        return
    name = repr(os.fspath(path))
    if os.path.exists(path):
        raise SomersaultError(
            f"{name} is a folder, a pipe or a device, and no {what}; give a {what}"
        )
    raise SomersaultError(f"there is no {what} {name}; check the path")


def read_bytes(path: Path, most: int = -1) -> bytes:
    """The first `most` bytes of a file, or all; OSError for what is none.

    A pipe or a device is none. Nobody waits for a pipe that no one writes to.
    """
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | _BINARY)
    with os.fdopen(handle, "rb") as file:
        if not stat.S_ISREG(os.fstat(handle).st_mode):
            raise OSError(errno.EINVAL, "Not a file but a folder, a pipe or a device", str(path))
        return file.read(most)
