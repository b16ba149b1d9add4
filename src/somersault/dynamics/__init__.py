"""Equations of motion: derived symbolically from a model, compiled, printed."""

from somersault.dynamics._equations import Equations, Expression
from somersault.dynamics._printing import c_code, latex
from somersault.dynamics._springs import spring_torques

__all__ = ["Equations", "Expression", "c_code", "latex", "spring_torques"]
