"""Table 4.1, and the rigid body of figure 4-5 (section 4.3.1)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from somersault import stability as st
from somersault._core.array import Array
from somersault.model import load
from somersault.thesis._claims import Claim, number, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch4._furrer import MODEL, NOMINAL, shoulder_inertia

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_TABLE_4_1 = {
    "mb": (58.3, "kg"),
    "ml": (3.743, "kg"),
    "Ib1": (10.19, "kg m²"),
    "Ib2": (9.93, "kg m²"),
    "Ib3": (0.52, "kg m²"),
    "Il1": (0.128, "kg m²"),
    "Il2": (0.128, "kg m²"),
    "Il3": (0.0037, "kg m²"),
    "rb1": (0.0, "m"),
    "rb2": (0.18, "m"),
    "rb3": (0.479, "m"),
    "rl1": (0.0, "m"),
    "rl2": (0.0, "m"),
    "rl3": (0.262, "m"),
}


def table_4_1() -> Result:
    """Furrer's numbers as the shipped model has them."""
    body, left, right = load(MODEL).bodies
    pin = np.array(left.joints[0].anchor)
    ours = {"mb": body.mass, "ml": left.mass}
    ours |= {f"Ib{i + 1}": body.inertia[i][i] for i in range(3)}
    ours |= {f"Il{i + 1}": left.inertia[i][i] for i in range(3)}
    ours |= {f"rb{i + 1}": left.position[i] + pin[i] - body.com[i] for i in range(3)}
    ours |= {f"rl{i + 1}": pin[i] - left.com[i] for i in range(3)}
    where = "Table 4.1"
    claims = [
        number(
            f"table4-1.{name}", where, f"{name} of the shipped model", value, ours[name], unit, 0
        )
        for name, (value, unit) in _TABLE_4_1.items()
    ]
    flip = np.array([1, -1, 1])
    mirrored = (
        left.mass == right.mass
        and left.inertia == right.inertia
        and np.allclose(np.array(left.position) * flip, right.position)
        and np.allclose(np.array(left.com) * flip, right.com)
    )
    claims.append(
        statement(
            "table4-1.symmetric",
            "§4.2",
            "the body is symmetric from left to right",
            "symmetric with the arms symmetric",
            "the right arm is the left one mirrored" if mirrored else "the arms differ",
            mirrored,
        )
    )
    claims.append(
        number(
            "table4-1.I_sh",
            "§4.2.2",
            "inertia of an arm about its shoulder, I_sh",
            0.3849,
            shoulder_inertia(),
            "kg m²",
            5e-5,
        )
    )
    rows = tuple(
        (name, f"{value:g}", f"{ours[name]:g}", unit) for name, (value, unit) in _TABLE_4_1.items()
    )
    return Result(
        "Inertia data for Carl Furrer, 1982 World Trampoline Champion: the athlete of chapter 4.",
        "The shipped model furrer carries these numbers. The printed table's label column has "
        "slipped by a row after Il3; only the values in their printed order give the I_sh = 0.3849 "
        "kg m² of the text.",
        tuple(claims),
        table=Table(("parameter", "thesis", "model", "unit"), rows),
    )


def fig_4_5() -> Result:
    """Inertia ratios of the rigid body against the arm angle, over curves of growth."""
    angles = np.linspace(0, 3, 301)
    about = st.principal_inertias(MODEL, {"shoulder": angles})
    k1 = (about[:, 1] - about[:, 2]) / about[:, 0]
    k3 = (about[:, 1] - about[:, 0]) / about[:, 2]
    return Result(
        "“The plot shows that the human form is relatively unstable in the rigid body sense”: k1 "
        "and k3 for arm angles of 0 to 3 rad, over curves of constant Φ, the somersault angle in "
        "which the unstable mode grows tenfold.",
        f"k1 runs from {k1.min():.3f} to {k1.max():.3f} and k3 from {k3.min():.3f} to "
        f"{k3.max():.3f}: always the quadrant of the middle axis. At Γ = 1.3 the text prints "
        "k1 = 0.65, k3 = −0.87 and 3.1 rad; Table 4.1 gives "
        "0.687, −0.876 and 2.97 rad. No arm angle has k1 = 0.65.",
        tuple(_claims_4_5(angles, k1, k3)),
        _draw_4_5(angles, k1, k3),
    )


def _claims_4_5(angles: Array, k1: Array, k3: Array) -> list[Claim]:
    spin = st.spin(MODEL, 2, {"shoulder": NOMINAL})
    here = spin.inertia_ratios
    rate = spin.linear(lock="all").growth_rate
    turn = np.log(10) / rate
    slip = (
        f"Table 4.1's data give 0.687 and −0.876 (errata). k1 = 0.65 belongs to no arm angle: "
        f"its least value is {k1.min():.3f}, at Γ = {angles[np.argmin(k1)]:.2f} rad."
    )
    product = here["k1"] * -here["k3"]
    less = product * (1 - np.log(product))  # area of the unit square where u v < product
    slowest = np.log(10) / np.sqrt(-k1 * k3)
    where = "§4.3.1"
    return [
        number("fig4-5.k1", where, "k1 at Γ = 1.3 rad", 0.65, here["k1"], "1", 0.005, slip),
        number(
            "fig4-5.k3",
            where,
            "k3 at Γ = 1.3 rad",
            -0.87,
            here["k3"],
            "1",
            0.005,
            slip,
        ),
        number(
            "fig4-5.angle",
            where,
            "somersault angle in which the unstable mode grows tenfold, Γ = 1.3 rad",
            3.1,
            turn,
            "rad",
            0.05,
            "Follows from the printed k1 and k3; with those of Table 4.1 it is 2.97 rad (errata). "
            f"The printed ratios do give {np.log(10) / np.sqrt(0.65 * 0.87):.2f} rad.",
        ),
        statement(
            "fig4-5.half",
            where,
            "the unstable mode grows tenfold in less than half a somersault",
            "less than half a somersault",
            f"{turn / (2 * np.pi):.3f} somersaults",
            turn < np.pi,
        ),
        statement(
            "fig4-5.rate",
            "eq. 2.13",
            "growth rate with the arms locked",
            "√(−k1 k3)",
            f"{rate:.9f} Ω, √(−k1 k3) = {np.sqrt(product):.9f}",
            abs(rate - float(np.sqrt(product))) < 1e-9,
            "Closed form against the root of the linearised model with locked arms.",
        ),
        statement(
            "fig4-5.quadrant",
            "Figure 4-5",
            "the inertia ratios for 0 < Γ < 3 rad lie in the quadrant of the middle axis",
            "k1 > 0 and k3 < 0 throughout",
            f"k1 {k1.min():.3f} to {k1.max():.3f}, k3 {k3.min():.3f} to {k3.max():.3f}",
            np.all((k1 > 0) & (k3 < 0)),
        ),
        statement(
            "fig4-5.unstable",
            "Figure 4-5",
            "the human form is relatively unstable as a rigid body",
            "relatively unstable",
            f"more unstable than {100 * less:.0f} % of the quadrant's area at Γ = 1.3; tenfold in "
            f"{slowest.min():.2f} to {slowest.max():.2f} rad over all angles (2.30 is the least "
            "there can be)",
            less > 0.5,
            "Read as: more unstable than most bodies in the quadrant.",
        ),
    ]


def _draw_4_5(angles: Array, k1: Array, k3: Array) -> Figure:
    from somersault.view import charts
    from somersault.view import style as look

    picture = look.figure(8.6, 4.4)
    whole, near = picture.subplots(1, 2, width_ratios=(1, 1.1))
    charts.growth_curves(whole, (2.5, 3, 4, 6, 10), (0.95, 0.85, 0.7, 0.5, 0.3))
    whole.set(xlim=(0, 1), ylim=(-1, 0), title="Tenfold growth in Φ rad")
    whole.set(xlabel="$k_1$", ylabel="$k_3$")
    whole.plot(k1, k3, color=look.VERMILION, lw=3)
    look.pointer(whole, (k1[130], k3[130]), (0.1, -0.93), "Furrer, any\narm angle", look.VERMILION)
    look.label(whole, 0.98, -0.04, "thin curves: constant Φ (rad)", look.GREY, ha="right")
    charts.growth_curves(near, (2.8, 2.9, 3.0, 3.1), (0.9, 0.83, 0.77, 0.72))
    near.plot(k1, k3, color=look.VERMILION)
    near.set(xlim=(0.64, 0.95), ylim=(-0.91, -0.63), title="The same, nearer", xlabel="$k_1$")
    for angle in (0.0, 0.5, 1.0, 1.3, 2.0, 2.5, 3.0):
        i = int(np.argmin(np.abs(angles - angle)))
        near.plot(k1[i], k3[i], "o", color=look.VERMILION, ms=5)
        rising = angle < 1.5  # the branch on the left, labelled on its left
        x, y = (k1[i] - 0.007, k3[i] + 0.005) if rising else (k1[i] + 0.006, k3[i] - 0.007)
        words = f"Γ = {angle:g}" if angle in (0.0, 3.0) else f"{angle:g}"
        look.label(near, x, y, words, look.VERMILION, ha="right" if rising else "left")
    near.plot(0.65, -0.87, "x", color=look.BLUE, ms=8, mew=2)
    look.label(near, 0.645, -0.898, "printed for 1.3", look.BLUE)
    return picture
