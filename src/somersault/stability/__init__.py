"""Steady spins and small deviations from them: which are stable, and which springs help."""

from somersault.stability._burst import Burst, burst
from somersault.stability._chart import (
    chart,
    growth_rates,
    root_locus,
)
from somersault.stability._coordinates import locked_speeds
from somersault.stability._delay import DelayedFeedback
from somersault.stability._feedback import feedback
from somersault.stability._joint_roots import joint_roots
from somersault.stability._modes import Mode
from somersault.stability._principal import PrincipalAxes, principal_axes
from somersault.stability._ranges import stable_ranges, stable_ranges_by_case
from somersault.stability._resonances import Resonance
from somersault.stability._spin import principal_inertias, spin
from somersault.stability._spins import spins
from somersault.stability._steady import holding_torques
from somersault.stability._types import LinearSpin, Spin

__all__ = [
    "Burst",
    "DelayedFeedback",
    "LinearSpin",
    "Mode",
    "PrincipalAxes",
    "Resonance",
    "Spin",
    "burst",
    "chart",
    "feedback",
    "growth_rates",
    "holding_torques",
    "joint_roots",
    "locked_speeds",
    "principal_axes",
    "principal_inertias",
    "root_locus",
    "spin",
    "spins",
    "stable_ranges",
    "stable_ranges_by_case",
]
