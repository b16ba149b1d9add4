"""Equations of motion: derived symbolically from a model, compiled, printed.

`Equations` are a model's, for arrays of samples. What they are made of is here as well, written
over symbols: the links of a model, their placements and the algorithms, for whoever derives the
equations of something else. `vectors` has the arithmetic of three-vectors of symbols.
"""

from somersault.dynamics._articulated import forward_dynamics
from somersault.dynamics._composite import (
    Composite,
    composite_bodies,
    mass_matrix,
    outboard_inertia,
)
from somersault.dynamics._constrained import constrained_dynamics
from somersault.dynamics._equations import Equations
from somersault.dynamics._motion import placements
from somersault.dynamics._newton_euler import Momentum, inverse_dynamics, momentum
from somersault.dynamics._parameters import body_kind, parameter_values
from somersault.dynamics._printing import c_code, latex
from somersault.dynamics._springs import spring_torques
from somersault.dynamics._symbolic import Expression
from somersault.dynamics._tree import Link, Tree, link_tree

__all__ = [
    "Composite",
    "Equations",
    "Expression",
    "Link",
    "Momentum",
    "Tree",
    "body_kind",
    "c_code",
    "composite_bodies",
    "constrained_dynamics",
    "forward_dynamics",
    "inverse_dynamics",
    "latex",
    "link_tree",
    "mass_matrix",
    "momentum",
    "outboard_inertia",
    "parameter_values",
    "placements",
    "spring_torques",
]
