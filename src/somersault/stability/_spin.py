"""The steady spin of a model in a pose."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.model import Model, load
from somersault.model import pose as posed
from somersault.stability._coordinates import coordinates
from somersault.stability._principal import (
    Axis,
    axes_of_spin,
    axis_index,
    or_somersault,
    require_free,
    require_inertia,
)
from somersault.stability._steady import composite_inertia, steady_matrices
from somersault.stability._types import Spin


def spin(
    model: str | Model,
    axis: Axis | str | int | None = None,
    pose: Mapping[str, ArrayLike] | None = None,
) -> Spin:
    """The steady spin of a model in a pose about a principal axis.

    Parameters
    ----------
    model : str or Model
        A shipped model's name, a model file, or a model.
    axis : {"minor", "intermediate", "major", 1, 2, 3}, optional
        By its inertia, or the principal axis nearest that body axis. By default the axis of
        somersault, the first of the model's `axes`; a planar model has no other.
    pose : mapping of str to float, optional
        Joint angles in rad (m for slides) by a joint's name or, mirrored, by a left–right pair's.
        The other joints stand as the file draws them.

    Returns
    -------
    Spin
        The spin; `Spin.linear` has the equations of small deviations from it.

    Raises
    ------
    SomersaultError
        For a model without a free base, an unknown axis or joint, or a pose outside limits.

    Examples
    --------
    >>> import somersault as so
    >>> layout = so.spin("furrer", pose={"shoulder": 1.3})
    >>> {name: round(ratio, 3) for name, ratio in layout.inertia_ratios.items()}
    {'k1': 0.687, 'k3': -0.876}
    """
    model = load(model)
    require_free(model)
    q = posed(model, pose)
    if q.ndim != 1:
        raise SomersaultError("a spin has one pose; use stability.chart for several")
    axis = or_somersault(model, axis)
    about = axes_of_spin(model, composite_inertia(model, q))
    require_inertia(model, about.inertias)
    index = axis_index(about.inertias, axis)
    steady = steady_matrices(model, q, about.axes[:, index])
    mass, gyric, stiffness = steady.in_axes(about.axes)
    _require_independent(model, coordinates(model, index + 1).transformed(mass))
    return Spin(
        model,
        index + 1,
        q,
        about.inertias,
        about.axes,
        MappingProxyType(dict(zip(model.speeds, steady.holding.tolist(), strict=True))),
        MappingProxyType(dict(zip(model.speeds, steady.outboard.tolist(), strict=True))),
        mass,
        gyric,
        stiffness,
    )


def principal_inertias(model: str | Model, pose: Mapping[str, ArrayLike] | None = None) -> Array:
    """Principal inertias of a model in a pose, or in many.

    Parameters
    ----------
    model : str or Model
        A shipped model's name, a model file, or a model.
    pose : mapping of str to array_like, optional
        As for `spin`; angles may be arrays, which broadcast against each other.

    Returns
    -------
    numpy.ndarray, shape (..., 3)
        About the principal axes nearest body axes 1, 2 and 3 (of a planar model: about the base's
        own axes), kg m².

    Raises
    ------
    SomersaultError
        For a model without a free base, an unknown joint, or a pose outside limits.

    Examples
    --------
    >>> from somersault.stability import principal_inertias
    >>> principal_inertias("furrer", {"shoulder": [0.0, 1.3]}).round(2)
    array([[11.  , 10.5 ,  0.77],
           [12.96, 11.06,  2.16]])
    """
    model = load(model)
    require_free(model)
    return axes_of_spin(model, composite_inertia(model, posed(model, pose))).inertias


def _require_independent(model: Model, mass: Array) -> None:
    """Refuse joints that do the same, or move nothing in this pose: M would be singular."""
    size = np.sqrt(np.diag(mass))
    with np.errstate(invalid="ignore", divide="ignore"):
        scaled = mass / np.outer(size, size)
    if not np.all(np.isfinite(scaled)) or np.linalg.eigvalsh(scaled)[0] < 1e-12:
        raise SomersaultError(
            f"two joints of {model.name} do the same in this pose, or one moves nothing; remove one"
        )
