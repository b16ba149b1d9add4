"""Steady spins and small deviations from them: which are stable, and which springs help."""

from somersault.stability._chart import chart, growth_rates, root_locus, stable_ranges
from somersault.stability._linear import LinearSpin
from somersault.stability._modes import Mode
from somersault.stability._spin import Spin, principal_inertias, spin

__all__ = [
    "LinearSpin",
    "Mode",
    "Spin",
    "chart",
    "growth_rates",
    "principal_inertias",
    "root_locus",
    "spin",
    "stable_ranges",
]
