"""A body in the air held by something that moves about a fixed place, until it lets go."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import instance, shown
from somersault._core.errors import SomersaultError
from somersault._core.numbers import as_floats
from somersault.model._bodies import GROUND, Body
from somersault.model._model import Model
from somersault.model._vectors import IDENTITY, ZERO, Matrix, Vector, as_matrix, as_vector
from somersault.model._weld import merge_welded


@dataclass(frozen=True)
class Mount:
    """A free model (`rider`) whose base is fixed to a carrier.

    Parameters
    ----------
    rider : Model
        What is held.
    held : Model
        The two as one model with a fixed base: the carrier's joints, then the rider's, all with
        their own names.
    position, rotation : tuple of float, tuple of rows
        Where the rider's base frame stands (m), and how it is turned (columns: its axes), in the
        axes of the carrier, which is body 0 of `held`.
    """

    rider: Model
    held: Model
    position: Vector
    rotation: Matrix

    @property
    def carrier(self) -> Body:
        """The carrier with the rider's base in it."""
        return self.held.bodies[0]


def mounted(
    model: Model, carrier: Body, position: Vector = ZERO, rotation: Matrix = IDENTITY
) -> Mount:
    """Fix a free model's base to a carrier that stands on the ground with joints of its own.

    Parameters
    ----------
    model : Model
        Free in the air.
    carrier : Body
        With `GROUND` for its parent; its mass may be zero.
    position, rotation : tuple of float, tuple of rows
        Of the model's base frame in the carrier's axes.

    Returns
    -------
    Mount

    Raises
    ------
    SomersaultError
        For a model whose base is not free, and a carrier with a parent or without joints.

    Examples
    --------
    >>> import somersault as so
    >>> none = (0.0, 0.0, 0.0)
    >>> bar = so.Joint("bar", "hinge", axis=(0.0, 1.0, 0.0))
    >>> clamp = so.Body("clamp", -1, 0.0, none, (none, none, none), joints=(bar,))
    >>> so.mounted(so.load("doll"), clamp, position=(0.0, 0.0, -0.3)).held
    <Model 'doll, held': 3 bodies, 3 joints, 0.521 kg, on a fixed base>
    """
    instance("model", model, Model)
    instance("carrier", carrier, Body)
    if not model.free:
        raise SomersaultError(
            f"{model.name} has a fixed base already; mount a model that is free in the air"
        )
    if carrier.parent != GROUND or not carrier.joints:
        raise SomersaultError(
            f"the carrier {carrier.name!r} must stand on the ground, with a joint to move on"
        )
    base, *others = model.bodies
    fixed = replace(
        base,
        parent=0,
        position=as_vector(_numbers("position", position, (3,))),
        rotation=as_matrix(_numbers("rotation", rotation, (3, 3))),
    )
    bodies = [carrier, fixed, *(replace(body, parent=body.parent + 1) for body in others)]
    held = Model(f"{model.name}, held", False, merge_welded(bodies, free=False), model.ignored)
    return Mount(model, held, fixed.position, fixed.rotation)


def _numbers(what: str, given: Any, shape: tuple[int, ...]) -> Array:
    """Finite numbers of a shape; SomersaultError naming `what`."""
    found = as_floats(given)
    if found is None or found.shape != shape or not np.all(np.isfinite(found)):
        wanted = " x ".join(map(str, shape))
        raise SomersaultError(f"{what} must be {wanted} finite numbers, and is {shown(given)}")
    return found
