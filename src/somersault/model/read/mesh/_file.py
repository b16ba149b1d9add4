"""A shape that stands for the meshes in a file."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault._core.files import read_bytes
from somersault.model._vectors import IDENTITY, Matrix, as_matrix
from somersault.model.read.mesh._formats import parts_of
from somersault.model.read.mesh._part import Part
from somersault.model.read.mesh._places import MOST_BYTES
from somersault.model.shapes import Mesh, Shape, Triangles, coarser

_MOST_TRIANGLES = 200_000  # of one surface: more is made coarser


@dataclass(frozen=True)
class Contents:
    """What is in a mesh file: read once, however many shapes stand for it."""

    file: Path

    def __getstate__(self) -> dict[str, Any]:
        """Without what was read: models are sent to other processes."""
        return {"file": self.file}

    @cached_property
    def parts(self) -> list[Part]:
        """Its surfaces; SomersaultError, with the reason alone, if it cannot be read."""
        try:
            data = read_bytes(self.file, MOST_BYTES + 1)
        except OSError:
            raise SomersaultError("cannot be read") from None
        if len(data) > MOST_BYTES:
            raise SomersaultError(f"is larger than {MOST_BYTES >> 20} MB")
        return parts_of(self.file.suffix, data)


@dataclass(frozen=True, kw_only=True)
class MeshFile(Shape):
    """The meshes in a file, which is read when somebody looks: equations need no mesh.

    Parameters
    ----------
    contents : Contents
    named : str
        As the model's file names it.
    form : tuple of rows
        Makes lengths in m of the numbers in the file, in the shape's own axes: scales and turns.
    **pose
        As of any `Shape`. Surfaces that have a colour in the file keep it.
    """

    contents: Contents
    named: str
    form: Matrix = IDENTITY
    kind: ClassVar[str] = "mesh file"

    def __post_init__(self) -> None:
        super().__post_init__()
        if not np.all(np.isfinite(self.form)) or np.linalg.det(np.array(self.form)) == 0:
            raise SomersaultError("is scaled to nothing; give it a scale")

    @property
    def sizes(self) -> tuple[float, ...]:
        """None: they are the file's."""
        return ()

    def solids(self) -> tuple[Shape, ...]:
        """Its surfaces, each of one colour.

        Raises
        ------
        SomersaultError
            For a file that cannot be read.
        """
        return tuple(self._meshes(position=self.position, rotation=self.rotation))

    def _meshes(self, **pose: Any) -> list[Mesh]:
        form = np.array(self.form)
        turned = np.linalg.det(form) < 0
        try:
            with np.errstate(all="ignore"):  # `Mesh` looks at what comes out
                placed = [part.vertices @ form.T for part in self.contents.parts]
            return [
                coarser(
                    Mesh(
                        vertices=vertices,
                        faces=part.faces[:, ::-1] if turned else part.faces,
                        color=part.color or self.color,
                        **pose,
                    ),
                    _MOST_TRIANGLES,
                )
                for part, vertices in zip(self.contents.parts, placed, strict=True)
            ]
        except SomersaultError as error:
            raise SomersaultError(f"{self.named} ({error})") from None

    def _mirrored(self) -> MeshFile:
        return replace(self, form=as_matrix(np.diag([1.0, -1.0, 1.0]) @ np.array(self.form)))

    def _surface(self) -> Triangles:
        surfaces = [mesh.triangles for mesh in self._meshes()]
        counts = np.cumsum([0, *(len(surface.vertices) for surface in surfaces)])
        return Triangles(
            np.concatenate([surface.vertices for surface in surfaces]),
            np.concatenate([surface.normals for surface in surfaces]),
            np.concatenate([s.faces + n for s, n in zip(surfaces, counts, strict=False)]),
        )

    def _core(self) -> tuple[Array, float]:
        return np.concatenate([mesh.hull.points for mesh in self._meshes()]), 0.0
