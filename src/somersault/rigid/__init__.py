"""One rigid body in the air: stability, the map of its rotation, its exact motion (ch. 2, A.4)."""

from somersault.rigid._euler import Kind, energy_bounds, euler_rates, kind_of_motion
from somersault.rigid._exact import RigidMotion
from somersault.rigid._inertia import (
    growth_angle,
    inertia_ratios,
    inertias_from_ratios,
    quadrant,
)
from somersault.rigid._linear import gyric_matrices, gyric_roots
from somersault.rigid._map import energy_curve, momentum_direction, separatrix, tilt_and_twist

__all__ = [
    "Kind",
    "RigidMotion",
    "energy_bounds",
    "energy_curve",
    "euler_rates",
    "growth_angle",
    "gyric_matrices",
    "gyric_roots",
    "inertia_ratios",
    "inertias_from_ratios",
    "kind_of_motion",
    "momentum_direction",
    "quadrant",
    "separatrix",
    "tilt_and_twist",
]
