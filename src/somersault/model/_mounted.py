"""A body in the air held by something that moves about a fixed place, until it lets go."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import instance, shown, text
from somersault._core.errors import SomersaultError
from somersault._core.numbers import as_floats
from somersault.model._bodies import GROUND, Body
from somersault.model._model import Model
from somersault.model._rerooted import rerooted
from somersault.model._vectors import IDENTITY, ZERO, Matrix, Vector, as_matrix, as_vector
from somersault.model._weld import merge_welded


@dataclass(frozen=True)
class Mount:
    """A free model (`rider`) one body of which, as a rule its base, is fixed to a carrier.

    Parameters
    ----------
    rider : Model
        What is held.
    held : Model
        The two as one model with a fixed base: the carrier's joints, then the rider's, all with
        their own names.
    place : int
        Which body of `held` the rider's base is, or is fixed to.
    position, rotation : tuple of float, tuple of rows
        Where the rider's base frame stands (m), and how it is turned (columns: its axes), in the
        axes of that body.
    """

    rider: Model
    held: Model
    place: int
    position: Vector
    rotation: Matrix

    @property
    def carrier(self) -> Body:
        """The carrier with the body that it holds in it."""
        return self.held.bodies[0]


def mounted(
    model: Model,
    carrier: Body,
    position: Vector = ZERO,
    rotation: Matrix = IDENTITY,
    *,
    body: str | None = None,
) -> Mount:
    """Fix a body of a free model to a carrier that stands on the ground with joints of its own.

    Parameters
    ----------
    model : Model
        Free in the air.
    carrier : Body
        With `GROUND` for its parent; its mass may be zero.
    position, rotation : tuple of float, tuple of rows
        Of the frame of the body that is held, in the carrier's axes.
    body : str, optional
        The body that is held, as the hands on a bar; by default the base.

    Returns
    -------
    Mount

    Raises
    ------
    SomersaultError
        For a model whose base is not free, a body that it does not have, and a carrier with a
        parent or without joints.

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
    names = [one.name for one in model.bodies]
    if body is not None and text("the name of a body", body) not in names:
        raise SomersaultError(
            f"{model.name} has no body {shown(body)}; its bodies are {', '.join(names[:12])}"
        )
    bodies, places = rerooted(model.bodies, 0 if body is None else names.index(body))
    base, *others = bodies
    fixed = replace(
        base,
        parent=0,
        position=as_vector(_numbers("position", position, (3,))),
        rotation=as_matrix(_numbers("rotation", rotation, (3, 3))),
    )
    whole = [carrier, fixed, *(replace(one, parent=one.parent + 1) for one in others)]
    held = Model(f"{model.name}, held", False, merge_welded(whole, free=False), model.ignored)
    if places[0] == 0:
        return Mount(model, held, 0, fixed.position, fixed.rotation)
    return Mount(model, held, places[0], ZERO, IDENTITY)


def _numbers(what: str, given: Any, shape: tuple[int, ...]) -> Array:
    """Finite numbers of a shape; SomersaultError naming `what`."""
    found = as_floats(given)
    if found is None or found.shape != shape or not np.all(np.isfinite(found)):
        wanted = " x ".join(map(str, shape))
        raise SomersaultError(f"{what} must be {wanted} finite numbers, and is {shown(given)}")
    return found
