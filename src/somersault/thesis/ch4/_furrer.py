"""What several figures share: Furrer's regions of stability, computed in two ways.

The charts search with `stability.chart`, which removes the integrals of angular momentum. The
edges in closed form come from the characteristic polynomial of the matrices themselves.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault import stability as st
from somersault._core.array import Array

if TYPE_CHECKING:
    import xarray as xr


MODEL = "furrer"
ANGLE, STIFFNESS, DAMPING = "pose.shoulder", "stiffness.shoulder", "damping.shoulder"
THREE, TWO = "tilt", "somersault"  # a coordinate of the 3- and of the 2-d.o.f. subsystem
LOW, HIGH = -2.0, 4.0  # K_sh in the thesis's plots
NOMINAL = 1.3  # the arm angle of figures 4-6, 4-7 and 4-14, rad
GROWS = 1e-6  # growth rates up to this, in units of Ω, count as none
PRINTED_DAMPING = 0.1  # b_sh/Φ̇ of figure 4-7, kg m²


@cache
def at(angle: float) -> st.LinearSpin:
    """The linear system with the arms at an angle and no springs."""
    return st.spin(MODEL, 2, {"shoulder": angle}).linear()


@cache
def shoulder_inertia() -> float:
    """I_sh: the arm about the shoulder, kg m²."""
    return float(at(NOMINAL).spin.outboard_inertias["left_shoulder"])


def literal_damping() -> float:
    """Figure 4-7's b_sh/Φ̇ = 0.1 kg m² as the non-dimensional b/(Ω I_sh)."""
    return PRINTED_DAMPING / shoulder_inertia()


@cache
def region(subsystem: str) -> xr.Dataset:
    """Stability over arm angle 0 to 3 rad and K_sh −2 to 4, both in steps of 0.01."""
    return st.chart(
        MODEL,
        (ANGLE, np.linspace(0, 3, 301)),
        (STIFFNESS, np.linspace(LOW, HIGH, 601)),
        subsystem=subsystem,
    )


def both() -> Any:
    """Where the 3- and the 2-d.o.f. subsystem are both stable: the 5-d.o.f. system."""
    return region(THREE).stable & region(TWO).stable


# ----------------------------------------------------------------- edges in closed form


@dataclass(frozen=True)
class Edges:
    """The stable K_sh of the two subsystems at some angles: lower3 < K < upper3, K > lower2.

    NaN where the 3-d.o.f. subsystem is stable for no K_sh.
    """

    lower3: Array
    upper3: Array
    lower2: Array
    rule: Array
    """The K_sh that cancels the centrifugal term, −k33/(2 I_sh)."""
    arm_term: Array
    """k13²/(2 I_sh k11): how far above the rule the upper edge lies."""

    @property
    def lower5(self) -> Array:
        """Lower edge of the 5-d.o.f. system."""
        low = np.maximum(self.lower3, self.lower2)
        return np.where(low < self.upper3, low, np.nan)

    @property
    def upper5(self) -> Array:
        """Its upper edge."""
        return np.where(np.isnan(self.lower5), np.nan, self.upper3)


@cache
def _exact(angle: float) -> tuple[float, float, float, float, float]:
    """One angle's edges.

    Written in λ = s², det(M λ + G s + K) of the 3-d.o.f. part is (λ + 1)(a λ² + b λ + c), with
    b and c linear in K_sh. All roots are imaginary where a, b, c > 0 and b² > 4 a c.
    """
    whole = at(angle)
    m3, g3, k3 = (x[:3, :3] for x in (whole.M, whole.G, whole.K))
    m2, g2, k2 = (x[3:, 3:] for x in (whole.M, whole.G, whole.K))
    scale = 2 * shoulder_inertia()
    sprung = k3.copy()
    sprung[2, 2] += scale
    a = np.linalg.det(m3)
    (b0, c0), (b1, c1) = (
        (np.linalg.det(m3 + g3 + k) / 2 - a - np.linalg.det(k), np.linalg.det(k))
        for k in (k3, sprung)
    )
    b, c = np.array([b0, b1 - b0]), np.array([c0, c1 - c0])
    upper = -c[0] / c[1]  # a root at the origin: c falls as K_sh rises
    collisions = np.sort(
        np.roots([b[1] ** 2, 2 * b[0] * b[1] - 4 * a * c[1], b[0] ** 2 - 4 * a * c[0]])
    )
    lower = collisions[-1].real if np.isreal(collisions[-1]) else -np.inf
    middle = (lower + upper) / 2
    exists = lower < upper and b[0] + b[1] * middle > 0 and c[0] + c[1] * middle > 0
    lower2 = -(k2[1, 1] + g2[0, 1] ** 2 / m2[0, 0]) / scale
    rule = -k3[2, 2] / scale
    arm_term = k3[0, 2] ** 2 / (k3[0, 0] * scale)
    return lower if exists else np.nan, upper if exists else np.nan, lower2, rule, arm_term


def edges(angles: Array) -> Edges:
    """Edges in closed form at an array of angles."""
    return Edges(*np.array([_exact(float(angle)) for angle in angles]).T)


# -------------------------------------------------------------------- edges by searching


def searched(subsystem: str, angles: Array, steps: int = 1200) -> list[list[tuple[float, float]]]:
    """Stable ranges of K_sh within −2 to 4 at each angle."""
    return st.stable_ranges_by_case(
        MODEL, (STIFFNESS, LOW, HIGH), fixed={ANGLE: angles}, subsystem=subsystem, samples=steps + 1
    )


def undivided_growth(angle: float, stiffness: Array, damping: float = 0.0) -> Array:
    """Largest real part of all ten roots of the whole 5-d.o.f. system, nothing removed."""
    return undivided_roots(at(angle), stiffness, damping).real.max(-1)


def undivided_roots(system: st.LinearSpin, stiffness: Array, damping: float = 0.0) -> Array:
    """Roots (K_sh, 2 n) of M s² + (G + D) s + K + K′ for an array of K_sh, as they stand."""
    size = len(system.M)
    pattern = np.zeros((size, size))
    for place, name in enumerate(system.coordinates):
        if "shoulder" in name:
            pattern[place, place] = 2 * shoulder_inertia()
    k = system.K + stiffness[:, None, None] * pattern
    c = system.G + damping * pattern
    inverse = np.linalg.inv(system.M)
    first = np.zeros((len(stiffness), 2 * size, 2 * size))
    first[:, :size, size:] = np.eye(size)
    first[:, size:, :size] = -inverse @ k
    first[:, size:, size:] = -inverse @ c
    return np.linalg.eigvals(first).astype(complex)


def shown(ranges: list[tuple[float, float]]) -> str:
    """Ranges of K_sh as text."""
    if not ranges:
        return "none"
    return " and ".join(f"{low:.3f} to {high:.3f}" for low, high in ranges)
