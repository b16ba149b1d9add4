"""Meshes in files: where they are, how they are read, and shapes that stand for them."""

from somersault.model.read.mesh._file import Contents, MeshFile
from somersault.model.read.mesh._places import mesh_file

__all__ = ["Contents", "MeshFile", "mesh_file"]
