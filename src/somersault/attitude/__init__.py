"""Somersault, tilt and twist; quaternions; direction cosines.

Attitude is the 2-1-3 sequence of Playter (1994), eq. 2.2: somersault Φ about the inertial 2
axis, then tilt Θ about the carried 1 axis, then twist Ψ about the body's 3 axis. `C_bi`
takes inertial components to body components. Quaternions are scalar first and turn body
components into inertial ones, so `matrix_from_quaternion(q)` is `C_bi` transposed.

A body drawn otherwise somersaults, tilts and twists about other axes (a, b, c) of its own: its
attitude is R_a(Φ) R_b(Θ) R_c(Ψ). Renaming axes is all that this takes (`in_sequence`): whoever
tilts about his front and twists about his head has a at his left or, with the sense of Φ turned
round, at his right.

Angles are in radians, in the order (Φ, Θ, Ψ). Everything works on stacks: the last axis (the
last two of matrices) holds the components, those before it are carried along.
"""

from somersault.attitude._angles import (
    SINGULAR,
    angle_rates,
    angles_from_matrix,
    angles_from_quaternion,
    body_rates,
    cayley_klein,
    direction_cosines,
    quaternion_from_angles,
    sequence_rates,
    unwrapped_angles,
)
from somersault.attitude._axes import AXES, Axes, as_axes, from_sequence, in_sequence, side
from somersault.attitude._quaternions import (
    matrix_from_quaternion,
    quaternion_conjugate,
    quaternion_from_matrix,
    quaternion_product,
)

__all__ = [
    "AXES",
    "SINGULAR",
    "Axes",
    "angle_rates",
    "angles_from_matrix",
    "angles_from_quaternion",
    "as_axes",
    "body_rates",
    "cayley_klein",
    "direction_cosines",
    "from_sequence",
    "in_sequence",
    "matrix_from_quaternion",
    "quaternion_conjugate",
    "quaternion_from_angles",
    "quaternion_from_matrix",
    "quaternion_product",
    "sequence_rates",
    "side",
    "unwrapped_angles",
]
