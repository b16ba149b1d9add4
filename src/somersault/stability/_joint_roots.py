"""Natural frequencies of a body's sprung joints when it does not spin."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.checks import by_name
from somersault._core.errors import SomersaultError
from somersault.dynamics import Equations
from somersault.model import Model, load
from somersault.model import pose as posed
from somersault.stability._coordinates import locked_speeds, motions
from somersault.stability._gyric import Attitude, GyricSystem
from somersault.stability._springs import strengths


def joint_roots(
    model: str | Model,
    pose: Mapping[str, ArrayLike] | None = None,
    *,
    stiffness: Mapping[str, float] | None = None,
    damping: Mapping[str, float] | None = None,
    lock: str | Iterable[str] = (),
) -> Array:
    """Roots of the small motions of sprung joints about a pose, of a body at rest.

    They are those of M q̈ + D q̇ + K q = 0 over the joints, the free base eliminated, with no gyric
    terms: how stiff a body's joints are by themselves (Playter 1994, table 6.1). A model loaded
    with base="fixed" has the roots of its joints with the base clamped.

    Parameters
    ----------
    model : str or Model
        A shipped model's name, a model file, or a model.
    pose : mapping of str to float, optional
        As for `spin`.
    stiffness : mapping of str to float, optional
        In N m/rad (N/m for a slide), by joint or pair; those that are not named have none.
    damping : mapping of str to float, optional
        In N m s/rad (N s/m), by joint or pair.
    lock : str or iterable of str
        Joints or pairs that are rigid.

    Returns
    -------
    numpy.ndarray, shape (2n,)
        Complex, rad/s, for n joint speeds that are not locked.

    Raises
    ------
    SomersaultError
        For an unknown name, a pose outside limits, a number that is not finite, or a negative
        damping.

    Examples
    --------
    The arms of a body at rest with springs of 1 N m/rad, both together and against each other:

    >>> from somersault.stability import joint_roots
    >>> abs(joint_roots("furrer", stiffness={"shoulder": 1.0}).imag).round(3)
    array([1.678, 1.612, 1.612, 1.678])
    """
    model = load(model)
    q = posed(model, pose)
    if q.ndim != 1:
        raise SomersaultError("these are the roots of one pose; ask for one after the other")
    none = np.zeros(len(model.speeds))
    springs = strengths(model, "stiffness", by_name("stiffness", stiffness), none + 1, none)
    dampers = strengths(model, "damping", by_name("damping", damping), none + 1, none)
    moves = motions(model, locked_speeds(model, lock))
    columns = np.array([*moves.values()]).reshape(len(moves), len(none)).T
    mass, damped, sprung = (
        columns.T @ a @ columns
        for a in (_over_joints(model, q), np.diag(dampers), np.diag(springs))
    )
    names = tuple(model.speeds[k] for k in moves)
    attitude = Attitude(None, None, None)
    return GyricSystem(names, mass, np.zeros_like(mass), damped, sprung, attitude).roots()


def _over_joints(model: Model, q: Array) -> Array:
    """The mass matrix over joint speeds of a body whose base moves as the joints make it."""
    whole, base = Equations(model).mass_matrix(q), 6 if model.free else 0
    coupling = whole[:base, base:]
    return whole[base:, base:] - coupling.T @ np.linalg.solve(whole[:base, :base], coupling)
