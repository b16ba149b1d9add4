"""What a model looks like whose file says nothing of it."""

from __future__ import annotations

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import instance
from somersault.model._bodies import Body
from somersault.model._model import Model
from somersault.model._vectors import as_matrix, as_vector
from somersault.model.shapes import Capsule, Shape, Sphere

_THICK = 0.02  # radius of a stick, over the size of the model


def model_shapes(model: Model) -> tuple[tuple[Shape, ...], ...]:
    """What there is to draw of each body: its `solids`, or sticks if no body has any.

    Parameters
    ----------
    model : Model

    Returns
    -------
    tuple of tuple of Shape
        For each body, in its axes.
    """
    solids = instance("model", model, Model).solids
    return solids if any(solids) else _sticks(model)


def _sticks(model: Model) -> tuple[tuple[Shape, ...], ...]:
    """Capsules from each body's joint to its centre of mass and to the joints of its children."""
    sticks: list[list[tuple[Array, Array]]] = []
    for index, body in enumerate(model.bodies):
        com = np.array(body.com)
        start = np.array(body.joints[0].anchor) if body.joints else com
        children = [child for child in model.bodies if child.parent == index]
        sticks.append([(start, end) for end in (com, *map(_joint_in, children))])
    size = max(float(np.abs(ends).max()) for body in sticks for ends in body) or 1.0
    return tuple(tuple(_stick(*ends, _THICK * size) for ends in body) for body in sticks)


def _joint_in(child: Body) -> Array:
    """A child's joint in its parent's axes."""
    anchor = np.array(child.joints[0].anchor) if child.joints else np.zeros(3)
    return np.array(child.position) + np.array(child.rotation) @ anchor


def _stick(start: Array, end: Array, radius: float) -> Shape:
    length = float(np.linalg.norm(end - start))
    middle = as_vector((start + end) / 2)
    if length < 1e-3 * radius:
        return Sphere(radius=radius, position=middle)
    along = (end - start) / length
    across = np.cross(np.eye(3)[np.argmin(np.abs(along))], along)
    across /= np.linalg.norm(across)
    axes = np.column_stack([across, np.cross(along, across), along])
    return Capsule(radius=radius, half_length=length / 2, position=middle, rotation=as_matrix(axes))
