"""Principal axes of a body or of many, each matched to the body axis that it lies nearest."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import permutations
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.checks import shown
from somersault._core.errors import SomersaultError
from somersault._core.numbers import floats
from somersault.model import FREE_IT, Model

Axis = Literal["minor", "intermediate", "major", 1, 2, 3]
_RANK = {"minor": 0, "intermediate": 1, "major": 2}
_BODY_AXES = {"1": 0, "2": 1, "3": 2, 1: 0, 2: 1, 3: 2}
_ORDERS = np.array(list(permutations(range(3))))


def cycle(axis: int) -> tuple[int, int, int]:
    """Indices of the axes before, of and after the spin, in right-handed order."""
    about = axis - 1
    return (about + 2) % 3, about, (about + 1) % 3


@dataclass(frozen=True)
class PrincipalAxes:
    """Principal inertias and axes of one body, or of a stack of them.

    Attributes
    ----------
    inertias : numpy.ndarray, shape (..., 3)
        About the principal axes nearest body axes 1, 2 and 3, kg m².
    axes : numpy.ndarray, shape (..., 3, 3)
        Their directions in the body's axes, as columns: a rotation matrix.
    """

    inertias: Array
    axes: Array


def principal_axes(inertia: ArrayLike) -> PrincipalAxes:
    """Principal axes, each matched to the body axis it lies nearest and pointing its way.

    Where two principal inertias are equal their axes are not determined; the ones returned then
    lie along the body's own axes as nearly as they can.

    Parameters
    ----------
    inertia : array_like, shape (..., 3, 3)
        Inertia matrices about the centre of mass, kg m², in the body's axes.

    Returns
    -------
    PrincipalAxes
        Inertias (..., 3) and axes (..., 3, 3).

    Raises
    ------
    SomersaultError
        For entries that are not finite, and matrices of another shape.

    Examples
    --------
    >>> import numpy as np
    >>> from somersault.stability import principal_axes
    >>> principal_axes(np.diag([3.0, 1.0, 2.0])).inertias
    array([3., 1., 2.])
    """
    # A nudge picks the body's own axes where inertias are equal; `_sharpened` takes it out again
    # wherever the axes are determined.
    inertia = floats("inertia", inertia, 3, 3)
    if not np.all(np.isfinite(inertia)):
        raise SomersaultError("inertia has entries that are not finite; give finite numbers")
    nudge = (
        np.diag([3.0, 2.0, 1.0]) * 1e-11 * np.trace(inertia, axis1=-2, axis2=-1)[..., None, None]
    )
    _, vectors = np.linalg.eigh(inertia + nudge)
    along = np.abs(vectors)  # [body axis, principal axis]
    match = along[..., np.arange(3), _ORDERS].sum(-1)
    order = _ORDERS[np.argmax(match, -1)]
    axes = np.take_along_axis(vectors, order[..., None, :], -1)
    diagonal = np.einsum("...kk->...k", axes)
    axes = axes * np.where(diagonal < 0, -1.0, 1.0)[..., None, :]
    # Three axes that each point along their body axis can still be left-handed; turn the
    # least certain one round.
    left_handed = np.linalg.det(axes) < 0
    least = np.argmin(np.abs(np.einsum("...kk->...k", axes)), -1)
    flip = np.where(left_handed[..., None] & (np.arange(3) == least[..., None]), -1.0, 1.0)
    return _sharpened(inertia, axes * flip[..., None, :])


def _sharpened(inertia: Array, axes: Array) -> PrincipalAxes:
    """One step of perturbation theory: the small products of inertia that are left, gone."""
    left = np.swapaxes(axes, -1, -2) @ inertia @ axes
    moments = np.einsum("...kk->...k", left)
    gap = moments[..., None, :] - moments[..., :, None]
    apart = np.abs(gap) > 1e-8 * moments.sum(-1)[..., None, None]
    axes = axes @ (np.eye(3) + np.where(apart, left / np.where(apart, gap, 1.0), 0.0))
    axes = axes @ (1.5 * np.eye(3) - 0.5 * np.swapaxes(axes, -1, -2) @ axes)  # orthonormal again
    left = np.swapaxes(axes, -1, -2) @ inertia @ axes
    return PrincipalAxes(np.einsum("...kk->...k", left), axes)


def axis_index(inertias: Array, axis: Axis | str | int) -> int:
    """Index 0, 1, 2 of the principal axis meant, of a body with these three inertias."""
    if (own := body_axis(axis)) is not None:
        return own
    if isinstance(axis, str) and axis in _RANK:
        return int(np.argsort(inertias)[_RANK[axis]])
    raise SomersaultError(
        f"{shown(axis)} is no axis to spin about; use minor, intermediate, major, 1, 2 or 3"
    )


def body_axis(axis: Axis | str | int) -> int | None:
    """Index 0, 1, 2 of the body axis meant, None for what is no number of one."""
    known = isinstance(axis, str | int | np.integer) and not isinstance(axis, bool)
    return _BODY_AXES.get(axis) if known else None


def axes_of_spin(model: Model, inertia: Array) -> PrincipalAxes:
    """Principal inertias (…, 3) and axes (…, 3, 3) of inertia matrices (…, 3, 3).

    A planar model turns about the axis across its plane, a principal axis or not: for it they are
    the base's own axes, and the moments about them.
    """
    if model.plane is None:
        return principal_axes(inertia)
    return PrincipalAxes(
        np.einsum("...kk->...k", inertia).copy(), np.broadcast_to(np.eye(3), inertia.shape)
    )


def require_inertia(model: Model, inertias: Array) -> None:
    """Refuse bodies without inertia about some axis: nothing says how they would turn."""
    if model.plane is not None:
        inertias = inertias[..., model.plane - 1 : model.plane]
    least, most = np.min(inertias, -1), np.max(inertias, -1)
    if not np.all(least > 1e-12 * most):
        raise SomersaultError(
            f"{model.name} has no inertia about one of its axes, so its spins are not determined; "
            "give its bodies some thickness"
        )


def or_somersault(model: Model, axis: Axis | str | int | None) -> Axis | str | int:
    """The axis asked for, or else the one that the model somersaults about.

    SomersaultError for an axis about which a planar model does not turn.
    """
    if model.plane is not None and axis is not None and str(axis) != str(model.plane):
        raise SomersaultError(
            f"{model.name} moves in the plane across its axis {model.plane}, so it spins about no "
            f'other; leave axis {shown(axis)} out, or give the model base = "free"'
        )
    return model.axes[0] if axis is None else axis


def require_free(model: Model) -> None:
    """Refuse a model whose base cannot turn freely."""
    if not model.free:
        raise SomersaultError(f"{model.name} has a fixed base, so it cannot spin freely; {FREE_IT}")
