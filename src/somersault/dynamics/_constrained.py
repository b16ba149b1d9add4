"""Forward dynamics of geared joints: the equations projected onto what moves by itself.

With all accelerations a = S z + d, where z are those that are unknown and d those that are known,
M a + c = τ becomes Sᵀ M S z = Sᵀ (τ − c − M d): what the gears pass on does no work.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from somersault.dynamics._composite import mass_matrix
from somersault.dynamics._newton_euler import inverse_dynamics
from somersault.dynamics._tree import Tree
from somersault.dynamics.vectors import Mat, Scalar, Vec, mul, scale, solve_symmetric, sub, total


def constrained_dynamics(
    tree: Tree,
    q: Sequence[Scalar],
    omega: Vec,
    speeds: Sequence[Scalar],
    torques: Sequence[Scalar],
    gravity: Vec,
    driven: Mapping[int, Scalar],
    follows: Mapping[int, tuple[int, Scalar]],
) -> tuple[Vec, Vec, list[Scalar]]:
    """Angular acceleration of a free base, acceleration of its centre of mass, of the joints.

    As `forward_dynamics`, where joints may be geared; without gears that one is cheaper.

    Parameters
    ----------
    tree, q, omega, speeds, torques, gravity
        As for `forward_dynamics`. What acts at a joint that follows reaches its leader through the
        gears; what acts at one that is driven does nothing.
    driven
        Accelerations that are known, by the place of the joint speed.
    follows
        For the place of a joint speed, that of its leader, which follows none itself, and the
        constant factor between their accelerations.

    Returns
    -------
    tuple
        (α, a, joint accelerations), in the base's axes; for a fixed base α and a are zero.
    """
    ahead = 6 if tree.free else 0
    omega = tree.kept(omega)
    known: list[Scalar] = [0.0] * len(speeds)
    moved: dict[int, list[tuple[int, Scalar]]] = {k: [(k, 1.0)] for k in tree.ways}
    for k in range(len(speeds)):
        if k in driven:
            known[k] = driven[k]
        elif k not in follows:
            moved[ahead + k] = [(ahead + k, 1.0)]
    for k, (leader, factor) in follows.items():
        if leader in driven:
            known[k] = mul(factor, driven[leader])
        else:
            moved[ahead + leader].append((ahead + k, factor))
    still: Vec = [0.0] * 3
    moment, force, needed = inverse_dynamics(
        tree, q, omega, speeds, still, scale(-1.0, gravity), known
    )
    outside = [sub(0.0, x) for x in [*moment, *force]] if tree.free else []
    left = [*outside, *(sub(t, n) for t, n in zip(torques, needed, strict=True))]
    # Outermost first: a tree's mass matrix then stays as sparse as it is while it is factored.
    order = sorted(moved, reverse=True)
    columns = [moved[k] for k in order]
    matrix = _projected(mass_matrix(tree, q), columns)
    (unknown,) = solve_symmetric(matrix, [[_along(left, column) for column in columns]])
    result: list[Scalar] = [0.0] * ahead + known
    for column, value in zip(columns, unknown, strict=True):
        for row, factor in column:
            result[row] = mul(factor, value)
    if not tree.free:
        return still, list(still), result
    return result[:3], result[3:6], result[6:]


def _projected(matrix: Mat, columns: Sequence[Sequence[tuple[int, Scalar]]]) -> Mat:
    """Sᵀ M S, each column of S given by its entries."""
    right = [[_along(row, column) for row in matrix] for column in columns]  # (M S)ᵀ
    return [[_along(moved, column) for moved in right] for column in columns]


def _along(vector: Sequence[Scalar], column: Sequence[tuple[int, Scalar]]) -> Scalar:
    """vector · column."""
    return total([mul(factor, vector[row]) for row, factor in column])
