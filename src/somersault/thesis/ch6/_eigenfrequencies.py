"""Table 6.1: eigenfrequencies of the compliant gymnast, held in pike and in wrap.

Every oscillating row of the table has ζ = 0.7 ω/30, and its rows with ζ = 0 are the real roots of
overdamped pairs (921 goes with 21.9…): M ẍ + C ẋ + K x = 0 over the joints of the free body, with
C = (2 ζ/ω_n) K, and no gyroscopic terms. The roots are then those of s² + (2 ζ/ω_n) λ s + λ = 0
for the eigenvalues λ of M⁻¹ K.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from somersault import stability as st
from somersault._core.array import Array
from somersault.dynamics import Equations
from somersault.model import load, named_pose
from somersault.model import pose as posed
from somersault.thesis._claims import Claim, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch6 import _rudi as rudi

# ω_n (rad/s) and ζ as printed; a row with ζ = 0 is one real root, any other one of a pair.
PRINTED = {
    "pike": (
        (921.0, 0), (709.2, 0), (359.4, 0), (161.2, 0), (160.6, 0), (88.0, 0), (69.0, 0),
        (36.7, 0.85), (36.7, 0.85), (31.3, 0.73), (31.3, 0.73), (31.0, 0), (30.1, 0.70),
        (30.1, 0.70), (30.0, 0.70), (30.0, 0.70), (28.3, 0), (24.7, 0), (24.7, 0), (22.9, 0.53),
        (22.9, 0.53), (22.7, 0), (22.0, 0), (21.9, 0), (16.0, 0.37), (16.0, 0.37),
    ),
    "wrap": (
        (210.0, 0), (188.3, 0), (159.2, 0), (107.7, 0), (93.1, 0), (39.7, 0.92), (39.7, 0.92),
        (38.9, 0.90), (38.9, 0.90), (30.1, 0.70), (30.1, 0.70), (30.0, 0.70), (30.0, 0.70),
        (27.8, 0), (26.8, 0.62), (26.8, 0.62), (26.7, 0), (26.5, 0.62), (26.5, 0.62), (24.9, 0.58),
        (24.9, 0.58), (24.8, 0.58), (24.8, 0.58), (24.7, 0), (24.1, 0), (23.8, 0),
    ),
}  # fmt: skip
_ZETA, _FREQUENCY = 0.7, 30.0
_ARM = ("shoulder_abduction", "shoulder_rotation", "shoulder_flexion", "elbow")
_NEAR = 0.25  # of a printed root: how far ours may be from it


@cache
def roots(pose: str, of: str = "wrap") -> Array:
    """The 26 roots of the gymnast in a pose, with gains from the outboard inertias `of` another."""
    model = load(rudi.MODEL)
    inertias = Equations(model).outboard_inertia(posed(model, _angles(of)))
    springs = dict(zip(model.speeds, (inertias * _FREQUENCY**2).tolist(), strict=True))
    dampers = {joint: 2 * _ZETA / _FREQUENCY * k for joint, k in springs.items()}
    both = st.joint_roots(model, _angles(pose), stiffness=springs, damping=dampers)
    return both[np.argsort(-np.abs(both))]


def _angles(pose: str) -> dict[str, float]:
    model = load(rudi.MODEL)
    if pose != "pike":
        return named_pose(model, "wrap")
    out = named_pose(model, "T")  # as it takes off: arms straight out
    return named_pose(model, "pike") | {name: out[name] for name in _ARM}


def printed_rule(pose: str) -> tuple[float, float]:
    """How well the printed rows obey the reading: the largest misfit of ζ = 0.7 ω/30 in the
    oscillating rows, and of 1/fast + 1/slow = 2 ζ/ω_n in the best pairing of the real ones."""
    rows = PRINTED[pose]
    swinging = max(abs(z - _ZETA * w / _FREQUENCY) for w, z in rows if z)
    real = sorted(w for w, z in rows if not z)
    half = len(real) // 2
    sums = [1 / a + 1 / b for a, b in zip(real[:half], reversed(real[half:]), strict=True)]
    return swinging, float(max(abs(s * _FREQUENCY / (2 * _ZETA) - 1) for s in sums))


def apart(pose: str, of: str = "wrap") -> float:
    """The factor by which our roots differ from the printed ones, over all rows."""
    ratios = np.abs(roots(pose, of)) / [w for w, _ in PRINTED[pose]]
    return float(np.exp(np.sqrt(np.mean(np.log(ratios) ** 2))))


def _fastest(ours: Array, printed: tuple[tuple[float, float], ...]) -> str:
    """The four fastest, in words."""
    four = zip(np.abs(ours[:4]), printed, strict=False)
    return ", ".join(f"{here:.0f} against {there:.0f}" for here, (there, _) in four)


def _rows(ours: dict[str, Array]) -> Claim:
    """Row by row, in the order of the table: from fast to slow."""
    ratios = {
        pose: np.abs(ours[pose]) / [w for w, _ in printed] for pose, printed in PRINTED.items()
    }
    every = np.concatenate(list(ratios.values()))
    off = {pose: int((np.abs(r - 1) > _NEAR).sum()) for pose, r in ratios.items()}
    return statement(
        "table6-1.rows", "Table 6.1", "the rows of the table, from fast to slow",
        "26 roots in each pose", f"ours are {every.min():.2f} to {every.max():.2f} times the "
        f"printed ones; more than {100 * _NEAR:.0f} % off: {off['pike']} in pike, {off['wrap']} in "
        "wrap", sum(off.values()) == 0,
        f"Holds when every root is within {100 * _NEAR:.0f} % of the printed one in its row. "
        "Another gymnast: the thesis does not print his inertias, and every root is one clamped at "
        "30 rad/s times a ratio of inertias.",
    )  # fmt: skip


def table_6_1() -> Result:
    """Both poses."""
    ours = {pose: roots(pose) for pose in PRINTED}
    rate = rudi.twist_rate()[0]
    size = np.abs(ours["wrap"])
    share = float(np.mean((size > 0.5 * rate) & (size < 1.5 * rate)))
    claims = []
    for pose in PRINTED:
        swinging, pairs = printed_rule(pose)
        claims.append(
            statement(
                f"table6-1.{pose}-rule", "Table 6.1", f"{pose}: the printed rows are those of "
                "proportional damping without gyroscopic terms", "as printed",
                f"ζ = 0.7 ω/30 to {swinging:.3f}; real rows pair to 1/a + 1/b = 2ζ/ω_n within "
                f"{100 * pairs:.1f} %", swinging < 0.011 and pairs < 0.02,
            )
        )  # fmt: skip
    stiff = {pose: float(np.abs(r).max()) for pose, r in ours.items()}
    claims.append(
        statement(
            "table6-1.stiffer", "Table 6.1", "the fastest root is faster in pike than in wrap",
            "921 against 210 rad/s", f"{stiff['pike']:.0f} against {stiff['wrap']:.0f} rad/s",
            stiff["pike"] > 1.5 * stiff["wrap"],
            "Holds when it is 1.5 times faster at least. The straight arm's small inertia about "
            "its long axis is the cause; gains are from the wrap. The thesis's masses are not "
            "printed.",
        )
    )  # fmt: skip
    claims.append(_rows(ours))
    claims.append(
        statement(
            "table6-1.near", "§6.5", "many of the eigenfrequencies of the tuned system are in the "
            "neighborhood of the maximum twist rate", "many",
f"{100 * share:.0f} % of the 26 roots in wrap are between half and one and a half times "
            f"{rate:.0f} rad/s", share > 0.5,
        )
    )  # fmt: skip
    rows = []
    for k in range(26):
        row: list[str] = []
        for pose, printed in PRINTED.items():
            s = ours[pose][k]
            zeta = -s.real / abs(s) if s.imag else 0.0
            row += [f"{printed[k][0]:g}", f"{printed[k][1]:g}", f"{abs(s):.1f}", f"{zeta:.2f}"]
        rows.append(tuple(row))
    return Result(
        "Eigenfrequencies and damping ratios of the gymnast held in pike and in wrap, ω_n = 30 "
        "rad/s.",
        "The printed rows are the roots of M⁻¹ K with proportional damping and no gyroscopic "
        "terms: the oscillating ones have ζ = 0.7 ω/30, those with ζ = 0 are the real roots of "
        "overdamped pairs. Ours, of another body, stand beside them, with gains from the outboard "
        "inertias in wrap, and the fast ones differ: "
        + "; ".join(f"{pose} {_fastest(ours[pose], PRINTED[pose])}" for pose in PRINTED)
        + ". The first of them is near the printed one by chance. Over all rows ours differ by a "
        f"factor of {apart('pike'):.2f} in pike and {apart('wrap'):.2f} in wrap (root mean square "
        f"of logarithms); with gains from the pike by {apart('pike', 'pike'):.2f} and "
        f"{apart('wrap', 'pike'):.2f}, which favours the wrap, but only weakly, since it is "
        "another body. "
        "Roots that fast make the flight mildly stiff.",
        tuple(claims),
        None,
        Table(
            tuple(f"{pose} {what}" for pose in PRINTED for what in ("ω", "ζ", "ω ours", "ζ ours")),
            tuple(rows),
        ),
    )
