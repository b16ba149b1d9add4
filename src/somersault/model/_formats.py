"""File formats by the endings of their files: one reader each."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from somersault._core.checks import shown, text
from somersault._core.errors import SomersaultError
from somersault.model._base import Base, rebased
from somersault.model._model import Model

Reader = Callable[[Path, "Base | None"], Model]


def register_format(ending: str, read: Callable[[Path], Model]) -> None:
    """Have files of an ending read by a function, from now on.

    Parameters
    ----------
    ending : str
        With its dot: ".rods". Upper and lower case are the same.
    read : callable
        From the path of a file that is there to a `Model`.

    Raises
    ------
    SomersaultError
        For an ending that the package reads itself.

    Examples
    --------
    >>> import somersault as so
    >>> from somersault.model import register_format
    >>> register_format(".book", lambda path: so.load("book"))
    """
    key = text("ending", ending).lower()
    if not key.startswith(".") or key in _OWN:
        raise SomersaultError(f"{ending!r} is no ending that can be given to a format of yours")
    if not callable(read):
        raise SomersaultError(f"read must be a function of a path, and is {shown(read)}")
    _READERS[key] = lambda path, base: rebased(read(path), base)


def endings() -> tuple[str, ...]:
    """Endings of the files that are read."""
    return tuple(_READERS)


def reader(ending: str) -> Reader | None:
    """What reads files of an ending, None if nothing does."""
    return _READERS.get(ending.lower())


def _read_biomod(path: Path, base: Base | None) -> Model:
    from somersault.model.read._biomod import read_biomod

    return read_biomod(path, base)


def _read_osim(path: Path, base: Base | None) -> Model:
    from somersault.model.read._osim import read_osim

    return read_osim(path, base)


def _read_xml(path: Path, base: Base | None) -> Model:
    """MJCF or URDF, by the root element, and by the ending where that does not tell."""
    from somersault.model.read._xml import root_tag

    root = root_tag(path)
    if root == "robot" or (path.suffix.lower() == ".urdf" and root != "mujoco"):
        from somersault.model.read._urdf import read_urdf

        return read_urdf(path, base)
    from somersault.model.read._mujoco import read_mjcf

    return read_mjcf(path, base)


_READERS: dict[str, Reader] = {
    ".xml": _read_xml,
    ".mjcf": _read_xml,
    ".urdf": _read_xml,
    ".biomod": _read_biomod,
    ".osim": _read_osim,
}
_OWN = tuple(_READERS)
