"""The printed linear equations of Playter (1994), to hold the derived ones against.

Appendix A.3 (five degrees of freedom) and table 4.2 (the simplest model), term by term as they
are printed, with the readings that the scan needs: "2 I l_l", "2 r l_l" and "2 l_l" are 2 Il1,
"I_2" is Il2, "Π_2" and "Π_3" are Il2 and Il3. Nothing here imports somersault.

Order of the coordinates, as in eqs. 4.1–4.6: tilt, twist, antisymmetric arms, somersault,
symmetric arms; without springs, and with Ω = 1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy import cos, sin


@dataclass(frozen=True)
class Athlete:
    """Table 4.1: masses (kg), principal inertias (kg m²) and lengths (m)."""

    mb: float
    ml: float
    Ib: tuple[float, float, float]
    Il: tuple[float, float, float]
    rb2: float
    rb3: float
    rl3: float

    @property
    def shoulder_inertia(self) -> float:
        """I_sh, of one arm about its shoulder."""
        return self.Il[0] + self.ml * self.rl3**2

    @property
    def _shared(self) -> float:
        """2 ml + 8 ml³/(2 ml + mb)² + 4 ml² mb/(2 ml + mb)² − 8 ml²/(2 ml + mb).

        These four stand together, in this proportion, wherever the arms move the body along.
        """
        ml, mb = self.ml, self.mb
        all_ = 2 * ml + mb
        return 2 * ml + 8 * ml**3 / all_**2 + 4 * ml**2 * mb / all_**2 - 8 * ml**2 / all_


FURRER = Athlete(58.3, 3.743, (10.19, 9.93, 0.52), (0.128, 0.128, 0.0037), 0.18, 0.479, 0.262)
DOLL = Athlete(
    0.466, 0.0275, (4.11e-3, 3.91e-3, 3.54e-4), (5.59e-5, 5.59e-5, 1e-6), 0.0413, 0.0664, 0.0832
)
DOLL_WEIGHTED = Athlete(
    0.466, 0.0575, (4.11e-3, 3.91e-3, 3.54e-4), (7.89e-5, 7.89e-5, 1e-6), 0.0413, 0.0664, 0.0622
)
ATHLETES = {"furrer": FURRER, "doll": DOLL, "doll_weighted": DOLL_WEIGHTED}


def m11(a: Athlete, angle: float) -> float:
    c, s = cos(angle), sin(angle)
    return (
        a.Ib[0]
        + 2 * a.Il[0]
        + 2 * a.rb2**2 * a.ml
        + a.rb3**2 * a._shared
        - 2 * a.rl3 * a.rb3 * a._shared * c
        + a.rl3**2 * a._shared * c**2
        + 4 * a.rl3 * a.rb2 * a.ml * s
        + 2 * a.rl3**2 * a.ml * s**2
    )


def m13(a: Athlete, angle: float) -> float:
    c, s = cos(angle), sin(angle)
    return (
        2 * a.Il[0]
        - a.rl3 * a.rb3 * a._shared * c
        + a.rl3**2 * a._shared * c**2
        + 2 * a.rl3 * a.rb2 * a.ml * s
        + 2 * a.rl3**2 * a.ml * s**2
    )


def m22(a: Athlete, angle: float) -> float:
    c, s = cos(angle), sin(angle)
    return (
        a.Ib[2]
        + 2 * a.rb2**2 * a.ml
        + 2 * a.Il[2] * c**2
        + 4 * a.rl3 * a.rb2 * a.ml * s
        + 2 * a.Il[1] * s**2
        + 2 * a.rl3**2 * a.ml * s**2
    )


def m33(a: Athlete, angle: float) -> float:
    c, s = cos(angle), sin(angle)
    return 2 * a.Il[0] + a.rl3**2 * a._shared * c**2 + 2 * a.rl3**2 * a.ml * s**2


def m44(a: Athlete, angle: float) -> float:
    c, s = cos(angle), sin(angle)
    return (
        a.Ib[1]
        + a.rb3**2 * a._shared
        - 2 * a.rl3 * a.rb3 * a._shared * c
        + 2 * a.Il[1] * c**2
        + a.rl3**2 * a._shared * c**2
        + 2 * a.Il[2] * s**2
    )


def m55(a: Athlete, angle: float) -> float:
    c, s = cos(angle), sin(angle)
    return 2 * a.Il[0] + 2 * a.rl3**2 * a.ml * c**2 + a.rl3**2 * a._shared * s**2


def g12(a: Athlete, angle: float) -> float:
    c, s = cos(angle), sin(angle)
    return (
        a.Ib[0]
        - a.Ib[1]
        + a.Ib[2]
        + 2 * a.Il[0]
        + 4 * a.rb2**2 * a.ml
        - 2 * a.Il[1] * c**2
        + 2 * a.Il[2] * c**2
        + 8 * a.rl3 * a.rb2 * a.ml * s
        + 2 * a.Il[1] * s**2
        - 2 * a.Il[2] * s**2
        + 4 * a.rl3**2 * a.ml * s**2
    )


def g23(a: Athlete, angle: float) -> float:
    c, s = cos(angle), sin(angle)
    return (
        -2 * a.Il[0]
        + 2 * a.Il[1] * c**2
        - 2 * a.Il[2] * c**2
        - 4 * a.rl3 * a.rb2 * a.ml * s
        - 2 * a.Il[1] * s**2
        + 2 * a.Il[2] * s**2
        - 4 * a.rl3**2 * a.ml * s**2
    )


def g45(a: Athlete, angle: float) -> float:
    c, s = cos(angle), sin(angle)
    return (
        2 * a.rl3 * a.rb3 * a._shared * s
        - 4 * a.Il[1] * c * s
        + 4 * a.Il[2] * c * s
        - 2 * a.rl3**2 * a._shared * c * s
    )


def k11(a: Athlete, angle: float) -> float:
    c, s = cos(angle), sin(angle)
    return (
        a.Ib[1]
        - a.Ib[2]
        - 2 * a.rb2**2 * a.ml
        + a.rb3**2 * a._shared
        - 2 * a.rl3 * a.rb3 * a._shared * c
        + 2 * a.Il[1] * c**2
        - 2 * a.Il[2] * c**2
        + a.rl3**2 * a._shared * c**2
        - 4 * a.rl3 * a.rb2 * a.ml * s
        - 2 * a.Il[1] * s**2
        + 2 * a.Il[2] * s**2
        - 2 * a.rl3**2 * a.ml * s**2
    )


def k13(a: Athlete, angle: float) -> float:
    """k31 too; the only one of the arms' stiffnesses that holds rb2."""
    return k33(a, angle) - 2 * a.rl3 * a.rb2 * a.ml * sin(angle)


def k22(a: Athlete, angle: float) -> float:
    c, s = cos(angle), sin(angle)
    return (
        -a.Ib[0]
        + a.Ib[1]
        - 2 * a.Il[0]
        - 2 * a.rb2**2 * a.ml
        + 2 * a.Il[1] * c**2
        - 4 * a.rl3 * a.rb2 * a.ml * s
        + 2 * a.Il[2] * s**2
        - 2 * a.rl3**2 * a.ml * s**2
    )


def k33(a: Athlete, angle: float) -> float:
    c, s = cos(angle), sin(angle)
    return (
        -a.rl3 * a.rb3 * a._shared * c
        + 2 * a.Il[1] * c**2
        - 2 * a.Il[2] * c**2
        + a.rl3**2 * a._shared * c**2
        - 2 * a.Il[1] * s**2
        + 2 * a.Il[2] * s**2
        - 2 * a.rl3**2 * a.ml * s**2
    )


def k55(a: Athlete, angle: float) -> float:
    c, s = cos(angle), sin(angle)
    return (
        -a.rl3 * a.rb3 * a._shared * c
        + 2 * a.Il[1] * c**2
        - 2 * a.Il[2] * c**2
        + a.rl3**2 * a._shared * c**2
        - 2 * a.Il[1] * s**2
        + 2 * a.Il[2] * s**2
        - a.rl3**2 * a._shared * s**2
    )


def matrices(a: Athlete, angle: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """M, G, K of eqs. 4.2, 4.3 and 4.5."""
    m = np.diag([f(a, angle) for f in (m11, m22, m33, m44, m55)])
    m[0, 2] = m[2, 0] = m13(a, angle)
    g = np.zeros((5, 5))
    for (row, column), f in {(0, 1): g12, (1, 2): g23, (3, 4): g45}.items():
        g[row, column] = f(a, angle)
        g[column, row] = -g[row, column]
    k = np.diag([k11(a, angle), k22(a, angle), k33(a, angle), 0.0, k55(a, angle)])
    k[0, 2] = k[2, 0] = k13(a, angle)
    return m, g, k


def springs(a: Athlete, stiffness: float) -> np.ndarray:
    """K′ of eq. 4.6 for a non-dimensional shoulder stiffness k_sh/(Ω² I_sh); D of 4.4 likewise."""
    return np.diag([0.0, 0.0, 2.0, 0.0, 2.0]) * stiffness * a.shoulder_inertia


@dataclass(frozen=True)
class Simplest:
    """The body and arm of figure 4-16."""

    Ib: tuple[float, float, float]
    Il: tuple[float, float, float]

    def matrices(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """M, G, K of eq. 4.10 by table 4.2, over tilt, twist and arm."""
        (b1, b2, b3), (l1, l2, l3) = self.Ib, self.Il
        m = np.array([[b1 + l1, 0, l1], [0, b3 + l3, 0], [l1, 0, l1]])
        g12, g23 = (b1 + l1) - (b2 + l2) + (b3 + l3), -l1 + l2 - l3
        g = np.array([[0, g12, 0], [-g12, 0, g23], [0, -g23, 0]])
        k11, k13, k33 = (b2 + l2) - (b3 + l3), l2 - l3, l2 - l3
        k22 = -(b1 + l1) + (b2 + l2)
        return m, g, np.array([[k11, 0, k13], [0, k22, 0], [k13, 0, k33]])

    def nondimensional(self) -> dict[str, float]:
        """k1, k3, I_rel and kl1 of eq. 4.11."""
        (b1, b2, b3), (l1, l2, l3) = self.Ib, self.Il
        return {
            "k1": ((b2 + l2) - (b3 + l3)) / (b1 + l1),
            "k3": ((b2 + l2) - (b1 + l1)) / (b3 + l3),
            "I_rel": l1 / (b1 + l1),
            "kl1": (l2 - l3) / l1,
        }


SIMPLEST = Simplest((12.660771, 11.452145, 1.468626), (0.769869, 0.0074, 0.769869))


def nondimensional(
    k1: float, k3: float, i_rel: float, kl1: float, stiffness: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """M, G, K of eq. 4.11, not symmetric, for a shoulder stiffness K_sh."""
    m = np.array([[1, 0, i_rel], [0, 1, 0], [1, 0, 1]])
    g23 = -(1 - kl1) * (1 - k3) * i_rel / (1 - k1)
    g = np.array([[0, 1 - k1, 0], [-(1 - k3), 0, g23], [0, 1 - kl1, 0]])
    k = np.array([[k1, 0, kl1 * i_rel], [0, k3, 0], [kl1, 0, kl1 + stiffness]])
    return m, g, k


def growth_rate(m: np.ndarray, c: np.ndarray, k: np.ndarray) -> np.ndarray:
    """Largest real part of the roots of det(M s² + C s + K), for stacks of matrices."""
    shape = np.broadcast_shapes(m.shape, c.shape, k.shape)
    m, c, k = (np.broadcast_to(a, shape) for a in (m, c, k))
    n = shape[-1]
    top = np.broadcast_to(np.hstack([np.zeros((n, n)), np.eye(n)]), (*shape[:-2], n, 2 * n))
    bottom = -np.linalg.solve(m, np.concatenate([k, c], -1))
    return np.linalg.eigvals(np.concatenate([top, bottom], -2)).real.max(-1)
