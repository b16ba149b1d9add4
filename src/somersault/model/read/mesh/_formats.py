"""Meshes as formats of files have them: STL, OBJ, PLY, COLLADA, VTK's, and biorbd's own."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from importlib import import_module

import numpy as np

from somersault._core.errors import SomersaultError
from somersault.model.read.mesh._part import Part

_READERS = {
    ".stl": "_stl",
    ".obj": "_obj",
    ".ply": "_ply",
    ".dae": "_collada",
    ".vtp": "_vtp",
    ".biomesh": "_biomesh",
}
ENDINGS = tuple(_READERS)
_MOST_TRIANGLES = 2_000_000


def parts_of(ending: str, data: bytes) -> list[Part]:
    """The parts of a mesh file with some contents.

    Raises
    ------
    SomersaultError
        With the reason alone, where there is nothing to be seen in it.
    """
    module = import_module(f"somersault.model.read.mesh.{_READERS[ending.lower()]}")
    read: Callable[[bytes], Iterable[Part]] = module.parts
    parts: list[Part] = []
    try:
        with np.errstate(all="ignore"):  # `Mesh` looks at what comes out
            for part in read(data):
                parts += [part] if len(part.faces) else []
                if sum(len(one.faces) for one in parts) > _MOST_TRIANGLES:
                    raise SomersaultError(f"has more than {_MOST_TRIANGLES} triangles")
    except SomersaultError:
        raise
    except (ValueError, IndexError, KeyError, OverflowError, MemoryError, RecursionError):
        raise SomersaultError(f"is no whole mesh of the kind {ending}") from None
    if not parts:
        raise SomersaultError("has no triangles")
    return parts
