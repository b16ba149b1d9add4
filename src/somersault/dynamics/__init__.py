"""Equations of motion: derived symbolically from a model, compiled, printed."""

from somersault.dynamics._composite import outboard_inertia
from somersault.dynamics._equations import Equations, Expression
from somersault.dynamics._motion import place
from somersault.dynamics._newton_euler import inverse_dynamics
from somersault.dynamics._printing import c_code, latex
from somersault.dynamics._springs import spring_torques
from somersault.dynamics._tree import parameter_names, parameter_value
from somersault.dynamics._vector import Vec, cross, scale, vadd, vsub

__all__ = [
    "Equations",
    "Expression",
    "Vec",
    "c_code",
    "cross",
    "inverse_dynamics",
    "latex",
    "outboard_inertia",
    "parameter_names",
    "parameter_value",
    "place",
    "scale",
    "spring_torques",
    "vadd",
    "vsub",
]
