"""Where the mesh file is that a model's file names, and whether it may be read.

A model's file comes from somebody else, and says which files are to be opened. It may point out of
its own folder, as robots do (`../meshes/hub.stl`), but only to what ends like a mesh, is a regular
file of this machine, and is not too large. Nothing of a file's contents is ever said or kept
unless it is a mesh.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator, Sequence
from pathlib import Path
from urllib.parse import unquote, urlsplit

from somersault._core.errors import SomersaultError
from somersault.model.read.mesh._formats import ENDINGS

MOST_BYTES = 100 * 2**20

_OF_PACKAGES = ("package", "model")
_PACKAGE_PATHS = ("ROS_PACKAGE_PATH", "GZ_SIM_RESOURCE_PATH", "GAZEBO_MODEL_PATH")


def mesh_file(name: str, folder: Path, beside: Sequence[Path] = ()) -> Path:
    """The file that a mesh is in.

    Parameters
    ----------
    name : str
        As the model's file has it: a path, or an address of `package://`, `model://` or `file://`.
    folder : Path
        Of the model's file.
    beside : sequence of Path
        Other folders that a path may be relative to, if it is not there.

    Returns
    -------
    Path

    Raises
    ------
    SomersaultError
        With the reason alone, for what is not to be read.
    """
    if os.path.splitext(name)[1].lower() not in ENDINGS:
        raise SomersaultError(f"is none of {', '.join(ENDINGS)}")
    try:
        for place in _places(name.strip(), folder, beside):
            if os.path.lexists(place):
                _check(place)
                return place
    except SomersaultError:
        raise
    except (OSError, ValueError):  # a name too long, or with a null character
        pass
    raise SomersaultError("is not there")


def _check(place: Path) -> None:
    about = os.stat(place)
    if not stat.S_ISREG(about.st_mode):
        raise SomersaultError("is not a file but a folder, a pipe or a device")
    if about.st_size > MOST_BYTES:
        raise SomersaultError(f"is larger than {MOST_BYTES >> 20} MB")


def _places(name: str, folder: Path, beside: Sequence[Path]) -> Iterator[Path]:
    """Where it could be, in order."""
    if "://" in name:
        address = urlsplit(name)
        if address.scheme in _OF_PACKAGES:
            yield from _in_packages(name.partition("://")[2].lstrip("/"), folder)
        elif address.scheme == "file" and address.netloc in ("", "localhost"):
            yield Path(unquote(address.path))
        else:
            raise SomersaultError("is not on this machine")
        return
    if name.startswith(("//", "\\\\")):  # another machine's, on Windows
        raise SomersaultError("is not on this machine")
    for written in dict.fromkeys((name, name.replace("\\", "/"))):
        for root in (folder, *beside):
            yield root / written


def _in_packages(path: str, folder: Path) -> Iterator[Path]:
    """A package is a folder around the model's file, one beside such a folder, or one in the
    paths that ROS and Gazebo have for packages."""
    within = path.partition("/")[2]
    for around in (folder.resolve(), *folder.resolve().parents):
        yield around / path
        yield around / within  # a package whose folder has another name
    for variable in _PACKAGE_PATHS:
        for root in filter(None, os.environ.get(variable, "").split(os.pathsep)):
            yield Path(root) / path
            yield Path(root).parent / path
    for root in filter(None, os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)):
        yield Path(root) / "share" / path
