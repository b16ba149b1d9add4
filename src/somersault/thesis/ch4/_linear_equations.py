"""Equations 4.1 to 4.9 and the elements of appendix A.3: the linear equations themselves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from somersault import stability as st
from somersault.model import Model, load
from somersault.thesis._claims import Claim, number, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch4._furrer import MODEL, NOMINAL, at, shoulder_inertia

_ANGLES = np.linspace(0, 3, 16)
_NAMES = ("tilt", "twist", "antisymmetric shoulder", "somersault", "symmetric shoulder")
_FORM = {
    "M": ["x.x..", ".x...", "x.x..", "...x.", "....x"],
    "G": [".x...", "x.x..", ".x...", "....x", "...x."],
    "K": ["x.x..", ".x...", "x.x..", ".....", "....x"],
}

# The expressions of A.3 evaluated with Table 4.1 at Γ = 1.3 rad, as the errata print them.
_REFERENCE = {
    "m11": 12.9553,
    "m13": 0.8831,
    "m22": 2.1582,
    "m33": 0.7657,
    "m44": 11.0645,
    "m55": 0.7156,
    "g12": 4.0490,
    "g23": -2.1036,
    "g45": 1.2416,
    "k11": 8.9063,
    "k13": -1.2204,
    "k22": -1.8908,
    "k33": -0.8802,
    "k55": -0.8260,
}


def small_deviations() -> Result:
    """The form of the linear equations: which elements vanish, what couples, what is singular."""
    systems = [at(float(angle)) for angle in _ANGLES]
    claims = [
        statement(
            "eq4-1.coordinates",
            "§4.2.2",
            "the state: tilt, twist, asymmetric arms, somersault, symmetric arms",
            "θ, ψ, γ_a, φ, γ_s",
            ", ".join(systems[0].coordinates),
            all(s.coordinates == _NAMES for s in systems),
        ),
        *_pattern(systems),
        *_symmetry(systems),
        *_springs(),
        _decoupling(systems),
        *_definite(systems),
        _rate(),
        _pretension(),
    ]
    return Result(
        "M ẍ + Φ̇(G + D)ẋ + Φ̇²(K + K′)x = 0 splits into a 3-by-3 system of tilt, twist and "
        "asymmetric arms and a 2-by-2 system of somersault and symmetric arms, with Φ̇ no more than "
        "a scale of time.",
        "Derived from the model file alone, the matrices have this form at every arm angle. The "
        "pretension that holds the arms also follows from the work they do: twice the torque is "
        "−½ Ω² dI₂/dΓ.",
        tuple(claims),
    )


def _pattern(systems: list[st.LinearSpin]) -> list[Claim]:
    claims = []
    for name, rows in _FORM.items():
        empty = np.array([[cell == "." for cell in row] for row in rows])
        worst = max(float(np.abs(getattr(s, name)[empty]).max()) for s in systems)
        least = min(float(np.abs(getattr(s, name)).max()) for s in systems)
        claims.append(
            statement(
                f"eq4-1.zeros-{name}",
                {"M": "eq. 4.2", "G": "eq. 4.3", "K": "eq. 4.5"}[name],
                f"{name} has the zeros printed",
                f"{int(empty.sum())} of 25 elements vanish",
                f"largest of them below {_above(worst)} kg m² at {len(systems)} arm angles",
                worst < 1e-9 * least,
            )
        )
    return claims


def _above(value: float) -> str:
    """A power of ten above a rounding error, so that the text is the same on every machine."""
    return f"1e{int(np.ceil(np.log10(max(value, 1e-13))))}"


def _symmetry(systems: list[st.LinearSpin]) -> list[Claim]:
    signs = {"M": (1, "M = Mᵀ"), "G": (-1, "G = −Gᵀ"), "K": (1, "K = Kᵀ, including k13 = k31")}
    claims = []
    for name, (sign, text) in signs.items():
        worst = max(
            float(np.abs(getattr(s, name) - sign * getattr(s, name).T).max()) for s in systems
        )
        claims.append(
            statement(
                f"eq4-1.symmetry-{name}",
                "eq. 4.1",
                f"a conservative gyric system: {text}",
                text,
                f"to {_above(worst)} kg m² at {len(systems)} arm angles",
                worst < 1e-9,
            )
        )
    return claims


def _springs() -> list[Claim]:
    spin = st.spin(MODEL, 2, {"shoulder": NOMINAL})
    k, b = 1.2, 0.3
    sprung = spin.linear({"shoulder": k}, {"shoulder": b})
    scale = shoulder_inertia()
    claims = []
    for where, name, matrix, value in (
        ("eq. 4.4", "D", sprung.D, b),
        ("eq. 4.6", "K′", sprung.K_springs, k),
    ):
        expected = np.diag([0, 0, 2 * value * scale, 0, 2 * value * scale])
        quantity = "b_sh/Φ̇" if name == "D" else "k_sh/Φ̇²"
        claims.append(
            number(
                f"eq4-1.{'damper' if name == 'D' else 'spring'}",
                where,
                f"elements 3,3 and 5,5 of {name} over {quantity}",
                2.0,
                float(matrix[2, 2] / (value * scale)),
                "1",
                1e-9,
                "Nothing else in the matrix."
                if np.abs(matrix - expected).max() < 1e-12
                else "Other elements differ from zero.",
            )
        )
    return claims


def _decoupling(systems: list[st.LinearSpin]) -> Claim:
    upper, lower = _NAMES[:3], _NAMES[3:]
    parts = [s.spin.linear({"shoulder": 1.1}, {"shoulder": 0.2}).subsystems for s in systems]
    across = any(set(group) & set(upper) and set(group) & set(lower) for p in parts for group in p)
    return statement(
        "eq4-1.decouple",
        "§4.2.2",
        "the system decouples into tilt, twist, asymmetric arms and somersault, symmetric arms",
        "an upper 3-by-3 and a lower 2-by-2 system",
        f"exactly these two at {sum(p == (upper, lower) for p in parts)} of {len(parts)} arm "
        f"angles",
        not across and all(p == (upper, lower) for p in parts[1:]),
        "With springs and dampers. At Γ = 0 the lower system itself falls apart: g45 = dI₂/dΓ "
        "vanishes there.",
    )


def _definite(systems: list[st.LinearSpin]) -> list[Claim]:
    springs = np.array([0.0, 0, 1, 0, 1]) * 2 * shoulder_inertia()
    values = np.linspace(-2, 4, 61)
    stacks = np.stack([s.K + k * np.diag(springs) for s in systems for k in values])
    ranks = np.linalg.matrix_rank(stacks, tol=1e-9)
    lows = np.linalg.eigvalsh(stacks[:, :3, :3])[:, 0]
    return [
        statement(
            "eq4-1.singular",
            "§4.3.2",
            "K + K′ of the 5-d.o.f. system is never positive definite, not even of full rank",
            "rank below 5",
            f"rank at most {ranks.max()} at {len(stacks)} pairs of arm angle and K_sh",
            ranks.max() < 5,
        ),
        statement(
            "eq4-1.indefinite",
            "§4.3.2",
            "nor is the 3-by-3 K + K′ positive definite, so the stability must be gyric",
            "no positive definite stiffness matrix",
            f"lowest eigenvalue {lows.min():.2f} to {lows.max():.2f} kg m²",
            lows.max() < 0,
            "No spring can change it: k22 = I2 − I1 is negative at every arm angle, and springs "
            "do not act on twist.",
        ),
    ]


def _rate() -> Claim:
    """One spring k_sh = K Φ̇² I_sh at two spin rates, entered in N m/rad."""
    stiffness, roots = 1.2, []
    for rate in (2.0, 9.0):
        model = _sprung(stiffness * rate**2 * shoulder_inertia())
        roots.append(st.spin(model, 2, {"shoulder": NOMINAL}).linear(rate=rate).roots)
    worst = max(float(np.abs(roots[1] - root).min()) for root in roots[0])
    return statement(
        "eq4-1.rate",
        "eq. 4.9",
        "Φ̇ only scales time: with K_sh = k_sh/(Φ̇² I_sh) kept, roots over Φ̇ stay where they are",
        "the same roots at every rate",
        f"roots at 2 and 9 rad/s agree to {_above(worst)}",
        worst < 1e-6,
    )


def _sprung(stiffness: float) -> Model:
    """Furrer with shoulder springs in N m/rad."""
    model = load(MODEL)
    bodies = tuple(
        replace(b, joints=tuple(replace(j, stiffness=stiffness) for j in b.joints))
        for b in model.bodies
    )
    return replace(model, bodies=bodies)


def _pretension() -> Claim:
    step, worst, largest = 1e-4, 0.0, 0.0
    for angle in _ANGLES[1:]:
        torque = at(float(angle)).spin.holding_torques
        poses = np.array([angle - step, angle + step])
        inertia = st.principal_inertias(MODEL, {"shoulder": poses})[:, 1]
        work = -0.5 * (inertia[1] - inertia[0]) / (2 * step)
        both = torque["left_shoulder"] - torque["right_shoulder"]
        worst, largest = max(worst, abs(both - work)), max(largest, abs(work))
    return statement(
        "eq4-1.pretension",
        "§4.2.2",
        "a constant shoulder torque, a function of Γ and Φ̇, makes pure somersault an equilibrium",
        "cancels the centrifugal forces",
        f"holding torques agree with −½ Ω² dI₂/dΓ to {_above(worst)} of {largest:.2f} N m "
        "at 1 rad/s",
        worst < 1e-5 * largest,
        "Checked by the work done when both arms move, which uses the inertia alone.",
    )


def appendix_a_3() -> Result:
    """The elements of M, G and K at Γ = 1.3 rad against the printed expressions."""
    system = at(NOMINAL)
    claims, rows = [], []
    for name, printed in _REFERENCE.items():
        ours = _element(system, name)
        claims.append(
            number(
                f"appA-3.{name}",
                "A.3",
                f"{name} at Γ = 1.3 rad, Φ̇ = 1",
                printed,
                ours,
                "kg m²",
                5e-5,
                "The printed expression with Table 4.1's numbers and the errata's readings.",
            )
        )
        rows.append((name, f"{printed:.4f}", f"{ours:.4f}"))
    claims += [
        number(
            "appA-3.k31",
            "A.3",
            "k31, which is not printed, equals k13",
            _REFERENCE["k13"],
            float(system.K[2, 0]),
            "kg m²",
            5e-5,
        ),
        *_no_rb2(),
    ]
    return Result(
        "The elements of the linear model, printed as expressions from a symbolic linearisation.",
        "All fourteen elements, derived here from the model file by another route, equal the "
        "printed expressions to every digit given.",
        tuple(claims),
        table=Table(("element", "A.3 at Γ = 1.3 (kg m²)", "derived here"), tuple(rows)),
    )


def _element(system: st.LinearSpin, name: str) -> float:
    matrix = getattr(system, name[0].upper())
    return float(matrix[int(name[1]) - 1, int(name[2]) - 1])


def _no_rb2() -> list[Claim]:
    """Whether k13, k33 and k55 change with the shoulders' width."""
    near, far = (_elements_with(width) for width in (0.18, 0.25))
    change = {name: abs(far[name] - near[name]) for name in near}
    claims = []
    for name, has in (("k13", True), ("k33", False), ("k55", False)):
        claims.append(
            statement(
                f"appA-3.{name}-rb2",
                "A.3",
                f"the expression of {name} {'has an' if has else 'has no'} rb2 term",
                "depends on rb2" if has else "does not depend on rb2",
                f"changes by {change[name]:.3f} kg m² when rb2 goes from 0.18 to 0.25 m",
                (change[name] > 1e-9) == has,
            )
        )
    return claims


def _elements_with(width: float) -> dict[str, float]:
    model = load(MODEL)
    bodies = [model.bodies[0]]
    for body in model.bodies[1:]:
        x, y, z = body.position
        bodies.append(replace(body, position=(x, float(np.copysign(width, y)), z)))
    system = st.spin(replace(model, bodies=tuple(bodies)), 2, {"shoulder": NOMINAL}).linear()
    return {name: _element(system, name) for name in ("k13", "k33", "k55")}
