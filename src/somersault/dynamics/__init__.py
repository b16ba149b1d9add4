"""Equations of motion: derived symbolically from a model, compiled, printed."""

from somersault.dynamics._equations import Equations, Expression
from somersault.dynamics._printing import c_code, latex
from somersault.dynamics._springs import spring_torques
from somersault.dynamics._tree import parameter_names, parameter_value

__all__ = [
    "Equations",
    "Expression",
    "c_code",
    "latex",
    "parameter_names",
    "parameter_value",
    "spring_torques",
]
