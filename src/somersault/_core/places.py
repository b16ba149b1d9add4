"""Where files are to be written: what is in the way is said before there is anything to write."""

from __future__ import annotations

import errno
import os
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from somersault._core.checks import file_path
from somersault._core.errors import SomersaultError
from somersault._core.files import temporary_name

# What the beginning of a file that is written here has in it; any other is somebody's work.
_MARKS = {
    ".c": b"/* Equations of motion", ".csv": b"time [s]", ".gif": b"GIF8",
    ".htm": b"<!doctype html", ".html": b"<!doctype html", ".mp4": b"ftyp", ".nc": b"\x89HDF",
    ".png": b"\x89PNG",
    ".svg": b"<svg", ".tex": b"\\begin{align*}", ".toml": b"model =", ".webm": b"\x1aE\xdf\xa3",
    ".xml": b"<mujoco", ".mjcf": b"<mujoco",
}  # fmt: skip
_OF_ZARR = "zarr.json"  # which every group and array has
_HEAD = 1024  # bytes


def check_file(path: Any, endings: Sequence[str]) -> Path:
    """The path of a file to be written, with one of some endings; tried, without leaving one.

    SomersaultError where it cannot be written, or where a file of another kind has that name: what
    is written here replaces its like alone.
    """
    file = file_path("the file", path)
    if file.suffix.lower() not in endings:
        raise SomersaultError(
            f"{file} has another ending than {' or '.join(endings)}; give one of these"
        )
    _check_room(file)
    if file.is_dir():
        raise SomersaultError(f"{file} is a folder; give the name of a file")
    if file.exists() and not file.is_file():
        raise SomersaultError(f"{file} is a device or a pipe; give the name of a file")
    if file.exists() and not os.access(file, os.W_OK):
        raise SomersaultError(f"{file} is write-protected; give another name")
    if file.exists() and not _replaceable(file):
        raise SomersaultError(
            f"{file} is there already, and somersault did not write it; give another name, or "
            "remove it"
        )
    return file


def check_folder(path: Any) -> Path:
    """The path of a folder to be filled, whether it is there or not; SomersaultError where files
    cannot be written to it."""
    folder = file_path("the folder", path)
    _check_room(folder, inside=True)
    return folder


def _check_room(place: Path, inside: bool = False) -> None:
    """SomersaultError unless a file can be written there, or inside of the folder that is to be
    there: tried in the nearest folder there is. Nor is any place inside of a Zarr store."""
    for above in Path(os.path.realpath(place)).parents:
        if os.path.isfile(above / _OF_ZARR):  # which, unlike pathlib, takes any name
            raise SomersaultError(
                f"{place} would be inside of {above}, a Zarr store, which holds its own files "
                "alone; give a place outside of it"
            )
    try:
        file = place.absolute() / "x" if inside else place.absolute()
        missing, folder = [file.name], file.parent
        while not folder.exists() and folder != folder.parent:
            missing.append(folder.name)
            folder = folder.parent
        if not folder.is_dir():
            raise NotADirectoryError(errno.ENOTDIR, f"{folder} is no folder")
        for name in missing:  # one that is too long, say
            with suppress(FileNotFoundError):
                os.lstat(folder / name)
        with temporary_name(folder) as trial:
            trial.touch(exist_ok=False)
    except OSError as trouble:
        raise SomersaultError(
            f"{place} cannot be written ({trouble.strerror}); give another place"
        ) from None


def _replaceable(file: Path) -> bool:
    with file.open("rb") as there:
        head = there.read(_HEAD)
    return not head or _MARKS[file.suffix.lower()] in head
