"""What bodies look like: shapes that a picture, a film or a page draws, and that decide nothing."""

from somersault.model.shapes._box import Box
from somersault.model.shapes._coarser import coarser, lighter
from somersault.model.shapes._mesh import Mesh, loft
from somersault.model.shapes._round import Capsule, Cylinder, Ellipsoid, Sphere
from somersault.model.shapes._shape import Color, Hull, Shape, Triangles

__all__ = [
    "Box",
    "Capsule",
    "Color",
    "Cylinder",
    "Ellipsoid",
    "Hull",
    "Mesh",
    "Shape",
    "Sphere",
    "Triangles",
    "coarser",
    "lighter",
    "loft",
]
