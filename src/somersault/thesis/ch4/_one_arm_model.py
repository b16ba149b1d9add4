"""The simplest model: figure 4-16, Tables 4.2 and 4.3, equation 4.11."""

from __future__ import annotations

import numpy as np

from somersault import stability as st
from somersault._core.array import Array
from somersault.model import load
from somersault.thesis._claims import Claim, number, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch4._furrer import GROWS, MODEL, THREE
from somersault.thesis.ch4._one_arm_sketch import one_arm_sketch

SIMPLEST, ARM = "simplest", "stiffness.arm"
PRINTED = {"k1": 0.65, "k3": -0.87, "I_rel": 0.06, "kl1": -0.99}  # Table 4.3


def bodies(k1: Array | float, k3: Array | float, relative: float, kl1: float) -> dict[str, Array]:
    """Inertias of the simplest model with given non-dimensional parameters and I1 = 1.

    From the definitions of section 4.4.2: I3 = (1 − k1)/(1 − k3), I2 = k1 + I3; the arm has
    Il1 = Il3 = I_rel and Il2 = I_rel kl1 + Il3.
    """
    one, three = np.asarray(k1, float), np.asarray(k3, float)
    i3 = (1 - one) / (1 - three)
    i2 = one + i3
    arm2 = relative * kl1 + relative
    return {
        "bodies.arm.inertia.11": np.asarray(relative),
        "bodies.arm.inertia.22": np.asarray(arm2),
        "bodies.arm.inertia.33": np.asarray(relative),
        "bodies.body.inertia.11": np.asarray(1 - relative),
        "bodies.body.inertia.22": i2 - arm2,
        "bodies.body.inertia.33": i3 - relative,
    }


def stable(inertias: dict[str, Array], stiffness: Array | float) -> Array:
    """Which of an array of simplest models are stable."""
    rates = st.growth_rates(SIMPLEST, {**inertias, ARM: stiffness}, subsystem=THREE)
    return np.asarray(rates <= GROWS)


def parameters() -> dict[str, float]:
    """The five parameters (but K_sh) of the shipped model."""
    body, arm = load(SIMPLEST).bodies
    total = [body.inertia[i][i] + arm.inertia[i][i] for i in range(3)]
    a1, a2, a3 = (arm.inertia[i][i] for i in range(3))
    return {
        "k1": (total[1] - total[2]) / total[0],
        "k3": (total[1] - total[0]) / total[2],
        "I_rel": a1 / total[0],
        "kl1": (a2 - a3) / a1,
    }


def printed_matrices(p: dict[str, float], stiffness: float) -> tuple[Array, Array, Array]:
    """M, G and K of equation 4.11 as printed."""
    k1, k3, relative, kl1 = p["k1"], p["k3"], p["I_rel"], p["kl1"]
    m = np.array([[1, 0, relative], [0, 1, 0], [1, 0, 1]])
    g23 = -(1 - kl1) * (1 - k3) * relative / (1 - k1)
    g = np.array([[0, 1 - k1, 0], [-(1 - k3), 0, g23], [0, 1 - kl1, 0]])
    k = np.array([[k1, 0, kl1 * relative], [0, k3, 0], [kl1, 0, kl1 + stiffness]])
    return m, g, k


def fig_4_16() -> Result:
    """The model itself."""
    model = load(SIMPLEST)
    body, arm = model.bodies
    apart = np.abs(np.array(arm.position) + np.array(arm.com) - np.array(body.com)).max()
    along = np.abs(np.array(arm.joints[0].anchor) - np.array(arm.com)).max()
    return Result(
        "The simplest model that captures passive layout stability: a single arm allowed to pivot "
        "about its centre, the centres of mass of arm and body coincident.",
        "Shipped as the model simplest, with Furrer's numbers.",
        (
            statement(
                "fig4-16.one-arm",
                "§4.4.2",
                "only asymmetric arm motion is allowed",
                "a single arm",
                f"one joint, turning about axis {int(np.argmax(np.abs(arm.joints[0].axis))) + 1}",
                len(model.joints) == 1 and abs(arm.joints[0].axis[0]) == 1,
            ),
            statement(
                "fig4-16.coincident",
                "Figure 4-16",
                "arm and body centres of mass are coincident, and the arm pivots about its centre",
                "coincident",
                f"{apart:g} m and {along:g} m apart",
                apart == 0 and along == 0,
            ),
        ),
        one_arm_sketch(),
    )


def table_4_2() -> Result:
    """The elements of equation 4.10 by Table 4.2, and of 4.11, against the derived ones."""
    model = load(SIMPLEST)
    body, arm = model.bodies
    b1, b2, b3 = (body.inertia[i][i] for i in range(3))
    a1, a2, a3 = (arm.inertia[i][i] for i in range(3))
    system = st.spin(SIMPLEST, 2).linear()
    formulas = {
        "m11": b1 + a1,
        "m13": a1,
        "m22": b3 + a3,
        "m33": a1,
        "g12": (b1 + a1) - (b2 + a2) + (b3 + a3),
        "g23": -a1 + a2 - a3,
        "k11": (b2 + a2) - (b3 + a3),
        "k13": a2 - a3,
        "k22": -(b1 + a1) + (b2 + a2),
        "k33": a2 - a3,
    }
    part = system.subsystem(THREE)
    order = [part.coordinates.index(name) for name in ("tilt", "twist", "arm")]
    claims, rows = [], []
    for name, value in formulas.items():
        matrix = getattr(part, name[0].upper())[np.ix_(order, order)]
        ours = float(matrix[int(name[1]) - 1, int(name[2]) - 1])
        claims.append(
            number(f"table4-2.{name}", "Table 4.2", name, value, ours, "kg m²", 1e-9, _FORMULA)
        )
        rows.append((name, f"{value:.6f}", f"{ours:.6f}"))
    claims += [
        statement(
            "table4-2.decouple",
            "§4.4.2",
            "the somersault decouples from the rest in this model too",
            "decouples again",
            " | ".join(" + ".join(group) for group in system.subsystems),
            ("somersault",) in system.subsystems,
        ),
        *_equation_4_11(),
    ]
    return Result(
        "The elements of the simplest model's M, G and K, and the same in non-dimensional form "
        "with five parameters (equation 4.11).",
        "Derived from the model file, the elements equal the printed ones, and equation 4.11 has "
        "the same roots.",
        tuple(claims),
        table=Table(("element", "Table 4.2 (kg m²)", "derived here"), tuple(rows)),
    )


_FORMULA = "The printed definition with the inertias of the shipped model."


def _equation_4_11() -> list[Claim]:
    p = parameters()
    spin = st.spin(SIMPLEST, 2)
    worst = 0.0
    for stiffness in np.linspace(-2, 4, 61):
        m, g, k = printed_matrices(p, float(stiffness))
        inverse = np.linalg.inv(m)
        first = np.block([[np.zeros((3, 3)), np.eye(3)], [-inverse @ k, -inverse @ g]])
        theirs = np.linalg.eigvals(first)
        ours = spin.linear({"arm": float(stiffness)}).subsystem(THREE).roots
        worst = max(worst, float(np.abs(theirs[:, None] - ours[None, :]).min(1).max()))
    locked = spin.linear(lock="all").growth_rate
    rigid = float(np.sqrt(-p["k1"] * p["k3"]))
    _, g, k = printed_matrices(PRINTED, 0.0)
    where = "eq. 4.11"
    return [
        statement(
            "table4-2.eq4-11",
            where,
            "the non-dimensional equation with five parameters is the same system",
            "only five parameters",
            "same roots" if worst < 1e-6 else f"roots differ by up to {worst:.1e}",
            worst < 1e-6,
            "Largest difference of a root below 1e-6 over 61 K_sh from −2 to 4.",
        ),
        number(
            "table4-2.rigid",
            where,
            "without the arm's freedom it is the rigid body's equation: growth rate √(−k1 k3)",
            rigid,
            locked,
            "Ω",
            1e-9,
        ),
        number(
            "table4-2.g32",
            "§4.4.2",
            "the 3-2 term of G is nearly 2.0",
            2.0,
            float(g[2, 1]),
            "1",
            0.05,
            "1 − kl1: a negative twist rate lifts the arm, which corrects the tilt.",
        ),
        statement(
            "table4-2.k33-negative",
            "§4.4.2",
            "with K_sh = 0 the 3-3 term of K is negative: centrifugal forces drive the arm away",
            "negative",
            f"{k[2, 2]:.2f}; {parameters()['kl1']:.3f} for the shipped model",
            k[2, 2] < 0 and parameters()["kl1"] < 0,
        ),
    ]


def table_4_3() -> Result:
    """Furrer's non-dimensional parameters and the range of springs they give."""
    ours = parameters()
    ratios = st.principal_inertias(MODEL, {"shoulder": np.linspace(0, 3, 301)})
    least = float(((ratios[:, 1] - ratios[:, 2]) / ratios[:, 0]).min())
    slip = (
        f"Not Furrer's: with Table 4.1's data k1 is nowhere below {least:.3f}, and k3 = −0.87 goes "
        "with k1 of 0.697 or 0.726 (errata: §4.3.1 has the same slip)."
    )
    notes = {"k1": slip, "k3": slip}
    claims = [
        number(
            f"table4-3.{name}",
            "Table 4.3",
            f"{name} for arms straight out",
            value,
            ours[name],
            "1",
            0.005,
            notes.get(name, ""),
        )
        for name, value in PRINTED.items()
    ]
    printed = bodies(PRINTED["k1"], PRINTED["k3"], PRINTED["I_rel"], PRINTED["kl1"])
    theirs = st.stable_ranges(SIMPLEST, (ARM, -2, 4), fixed=printed, subsystem=THREE)
    furrer = st.stable_ranges(SIMPLEST, (ARM, -2, 4), subsystem=THREE)
    arm = load(SIMPLEST).bodies[1].inertia[0][0]
    where = "§4.4.2"
    claims += [
        number(
            "table4-3.arm",
            where,
            "Il1 = Il3 = 2 I_sh of the arm",
            2 * 0.3849,
            arm,
            "kg m²",
            1e-4,
        ),
        number("table4-3.low", where, "least stabilising K_sh", 0.98, theirs[0][0], "1", 0.005),
        number("table4-3.high", where, "greatest stabilising K_sh", 1.08, theirs[0][1], "1", 0.005),
        statement(
            "table4-3.one-range",
            where,
            "one range of K_sh stabilises the simplest model",
            "0.98 to 1.08",
            f"{_text(theirs)} with Table 4.3's numbers; {_text(furrer)} with Furrer's",
            len(theirs) == len(furrer) == 1,
            "Furrer's own k1 = 0.687 and k3 = −0.880 move the range down a little.",
        ),
        statement(
            "table4-3.rule",
            where,
            "the range approximately cancels kl1 = −1: the rule of thumb",
            "K_sh ≈ −kl1",
            f"−kl1 = {-PRINTED['kl1']:.2f} lies in {_text(theirs)}",
            theirs[0][0] < -PRINTED["kl1"] < theirs[0][1],
        ),
    ]
    rows = tuple((name, f"{value:g}", f"{ours[name]:.4f}") for name, value in PRINTED.items())
    return Result(
        "Furrer's non-dimensional parameters with the arms straight out. A root locus search gives "
        "0.98 ≤ K_sh ≤ 1.08, which approximately cancels kl1 = −1.",
        f"With the printed parameters {_text(theirs)}: the thesis's range. With Furrer's own, "
        f"{_text(furrer)}: Table 4.3's k1 and k3 are not those of Table 4.1.",
        tuple(claims),
        table=Table(("parameter", "Table 4.3", "from Table 4.1"), rows),
    )


def _text(ranges: list[tuple[float, float]]) -> str:
    return " and ".join(f"{low:.3f} to {high:.3f}" for low, high in ranges) or "none"
