"""The shapes of a file's bodies, gathered after all that moves, and forgiving.

Nobody's flight is refused for its picture: a shape that makes no sense is left out, and named.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from somersault._core.errors import SomersaultError
from somersault.model._strange import Strange
from somersault.model.read.mesh import Contents, MeshFile, mesh_file
from somersault.model.shapes import Shape

_MOST_SHAPES = 5000
_MOST_BYTES = 500 * 2**20  # of all mesh files, each as often as it is named


class Drawn:
    """Shapes by the names of their bodies; `beside` as of `mesh_file`."""

    def __init__(self, folder: Path, strange: Strange, beside: Sequence[Path] = ()) -> None:
        self._folder = folder
        self._strange = strange
        self._beside = beside
        self._shapes: dict[str, list[Shape]] = {}
        self._files: dict[Path, Contents] = {}
        self._count = 0
        self._bytes = 0

    def add(self, body: str, make: Callable[[], Shape | None]) -> None:
        """A shape of a body, if it can be made: `make` may say that there is nothing to see."""
        self._count += 1
        try:
            if self._count > _MOST_SHAPES:
                raise SomersaultError(f"all beyond {_MOST_SHAPES}")
            shape = make()
        except SomersaultError as error:
            self._strange.add("shapes left out", str(error))
        else:
            self._shapes.setdefault(body, []).extend([] if shape is None else [shape])

    def file(self, name: str, **options: Any) -> MeshFile:
        """The shape that stands for the mesh file of a name; `options` as of `MeshFile`.

        Raises
        ------
        SomersaultError
            If it is not to be read.
        """
        try:
            place = mesh_file(name, self._folder, self._beside)
            self._bytes += place.stat().st_size
            if self._bytes > _MOST_BYTES:
                raise SomersaultError(f"and those before it are larger than {_MOST_BYTES >> 20} MB")
            contents = self._files.setdefault(place, Contents(place))
            return MeshFile(contents=contents, named=name[:100], **options)
        except SomersaultError as error:
            raise SomersaultError(f"{name[:100]} ({error})") from None

    def of(self, body: str) -> tuple[Shape, ...]:
        """The shapes of a body, in its axes."""
        return tuple(self._shapes.get(body, ()))
