"""Whether a spinning body is its own mirror image, and so keeps two kinds of motion apart.

A mirror across the axis of spin leaves the spin as it is. If the body is its own image, motions
that the mirror leaves (even) and those that it reverses (odd) are decoupled in the linear
equations, and no product of an odd number of odd motions acts on anything in the non-linear ones.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from somersault._core.array import Array
from somersault.dynamics import Equations
from somersault.model import Model
from somersault.stability._coordinates import coordinates
from somersault.stability._steady import equations_of

_SAME = 1e-7  # of the mass matrix: an image that differs by less is one
_AWAY = 0.3  # rad or m that the joints are moved to see
_LOOKS = 3


def parities(
    model: Model, axis: int, names: Sequence[str], q: Array, parameters: Sequence[str] = (),
    values: Array | None = None,
) -> Array:  # fmt: skip
    """1 for each coordinate that the mirror leaves, −1 for one that it reverses, (n,); 0 for all
    if the body in one of the poses q (N, coordinates) is not its own image.

    Seen from the mass matrix, in poses moved at random: the kinetic energy is all the physics that
    a free body has besides its springs.
    """
    whole = coordinates(model, axis)
    turns = [k for k in range(len(whole.names)) if np.any(whole.columns[:3, k])]
    planar = whole.parity.copy()  # of joints that turn about the axis of spin, or slide across it
    planar[[k for k in range(len(planar)) if k not in turns]] = 1
    if not any(joint.kind == "ball" for joint in model.joints):
        equations = equations_of(model, tuple(parameters))
        for parity in (whole.parity, planar):
            known = dict(zip(whole.names, parity.tolist(), strict=True))
            of_names = np.array([known.get(name, 0) for name in names])
            moving = {name: known[name] for name in names if name in known}
            if of_names.all() and _is_image(equations, axis, moving, q, values):
                return of_names
    return np.zeros(len(names), int)


def _is_image(
    equations: Equations, axis: int, parity: Mapping[str, int], q: Array, values: Array | None
) -> bool:
    """Whether the mass matrix in mirrored poses is the mirror image of that in the poses."""
    whole = coordinates(equations.model, axis)
    named = [k for k, name in enumerate(whole.names) if name in parity]
    joints = [k for k in named if not whole.columns[:3, k].any()]
    moves = whole.columns[3:, joints]
    ways = np.array([parity[whole.names[k]] for k in joints], float)
    # Turns, the base's own velocity, joints; the mirror turns turns over, but for that of the spin.
    turns = np.where(np.arange(3) == axis - 1, 1.0, -1.0)
    image = np.concatenate([turns, -turns, ways])
    columns = np.zeros((6 + len(moves), 6 + len(joints)))
    columns[:6, :6], columns[6:, 6:] = np.eye(6), moves
    random = np.random.default_rng(0)
    for _ in range(_LOOKS):
        step = _AWAY * random.uniform(-1.0, 1.0, len(joints))
        here, there = (
            columns.T @ equations.mass_matrix(q + moves @ moved, values) @ columns
            for moved in (step, ways * step)
        )
        size = np.sqrt(np.einsum("...kk->...k", here))
        scale = size[..., :, None] * size[..., None, :]
        if np.any(np.abs(here - image[:, None] * image * there) > _SAME * scale):
            return False
    return True


def odd_places(parity: Array, groups: Sequence[Sequence[int]]) -> Array:
    """Which coordinates the mirror reverses, (n,); none where one of the groups that act on each
    other has both kinds, as unlike springs make it."""
    mixed = any(len(set(parity[list(group)].tolist())) > 1 for group in groups)
    return np.asarray((parity < 0) & (not mixed))
