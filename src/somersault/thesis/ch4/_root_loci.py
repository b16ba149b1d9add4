"""Root loci of the 3-d.o.f. subsystem: figures 4-6 and 4-8."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from somersault import stability as st
from somersault._core.array import Array
from somersault.thesis._claims import Claim, number, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch4._furrer import (
    HIGH,
    LOW,
    MODEL,
    NOMINAL,
    STIFFNESS,
    THREE,
    at,
    edges,
    shoulder_inertia,
    undivided_roots,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SWEEP = np.linspace(LOW, HIGH, 601)
PANELS = np.round(np.arange(0, 2.9, 0.4), 1)  # figure 4-8: 0.0 top left to 2.8 bottom centre


def roots_along(values: Array, **fixed: float) -> Array:
    """Roots (K_sh, 6) of tilt, twist and asymmetric arms; `fixed` by kind (pose, damping)."""
    locus = st.root_locus(
        MODEL,
        (STIFFNESS, values),
        fixed={f"{kind}.shoulder": value for kind, value in fixed.items()},
        subsystem=THREE,
    )
    return np.asarray(locus.growth.values + 1j * locus.frequency.values)


def asymmetry(roots: Array) -> float:
    """How far the roots are from their mirror image in the imaginary axis, at worst."""
    gap = np.abs(-roots.conj()[:, :, None] - roots[:, None, :]).min(-1)
    return float(gap.max())


def fig_4_6() -> Result:
    """The root locus at Γ = 1.3 rad without damping."""
    roots = roots_along(SWEEP, pose=NOMINAL)
    edge = edges(np.array([NOMINAL]))
    low, high = float(edge.lower3[0]), float(edge.upper3[0])
    return Result(
        "Undamped at Γ = 1.3 rad, K_sh from −2 (light) to 4 (dark): four symmetric complex roots "
        "converge on the imaginary axis and split; one pair goes out along it, the other meets at "
        "the origin and splits along the real axis. Two roots stay at ±i.",
        f"So it is. The complex roots meet the axis at K_sh = {low:.3f}, the slow pair reaches the "
        f"origin at {high:.3f}, and in between all roots are imaginary. Just below the lower edge "
        "the growth rate rises as the square root of the distance, hence the thesis's “jump”.",
        (*_path(roots, low, high), *_ends(roots), *_stroboscopic()),
        _draw_4_6(roots, low, high),
    )


def _path(roots: Array, low: float, high: float) -> list[Claim]:
    where = "§4.3.2, Figure 4-6"
    start = roots[0][np.abs(roots[0].real) > 1e-6]
    below, above = (roots_along(np.array([high + d]), pose=NOMINAL)[0] for d in (-1e-4, 1e-4))
    slow, fast = below[np.argsort(np.abs(below))[:2]], above[np.argsort(np.abs(above))[:2]]
    stable = np.abs(roots.real).max(-1) < 1e-6
    at_low = roots_along(np.array([low + 1e-7]), pose=NOMINAL)[0]
    meeting = np.sort(at_low.imag[at_low.imag > 0])[:2]
    distance = np.logspace(-4, -2, 9)
    growth = roots_along(low - distance, pose=NOMINAL).real.max(-1)
    power = float(np.polyfit(np.log(distance), np.log(growth), 1)[0])
    symmetric = asymmetry(roots)
    return [
        statement(
            "fig4-6.symmetric",
            where,
            "the locus is symmetric about the imaginary axis",
            "symmetric, as a conservative gyric system is",
            f"mirror images agree to {symmetric:.0e}" if symmetric > 1e-6 else "to below 1e-6",
            symmetric < 1e-6,
        ),
        statement(
            "fig4-6.start",
            where,
            "at K_sh = −2 four symmetrically placed roots have real and imaginary parts",
            "four complex roots",
            ", ".join(f"{s.real:+.3f}{s.imag:+.3f}i" for s in start),
            len(start) == 4 and np.abs(start.imag).min() > 1e-3 and np.ptp(np.abs(start)) < 1e-9,
        ),
        statement(
            "fig4-6.meet",
            where,
            "as K_sh rises they converge on the imaginary axis, where they split",
            "meet on the imaginary axis",
            f"meet at K_sh = {low:.3f} at ±{meeting.mean():.3f}i",
            np.ptp(meeting) < 1e-2 and np.abs(at_low.real).max() < 1e-6 and meeting.mean() > 0.1,
        ),
        statement(
            "fig4-6.range",
            where,
            "for some K_sh all roots are on the imaginary axis",
            "some",
            f"{low:.3f} < K_sh < {high:.3f}",
            np.array_equal(stable, (low < SWEEP) & (high > SWEEP)) and stable.any(),
            "The edges in closed form; the sweep in steps of 0.01 agrees with them everywhere.",
        ),
        statement(
            "fig4-6.origin",
            where,
            "the other pair converges at the origin and splits along the real axis",
            "imaginary, then real",
            f"±{abs(slow[0].imag):.4f}i just below K_sh = {high:.4f}, "
            f"±{abs(fast[0].real):.4f} just above",
            np.abs(slow.real).max() < 1e-6
            and np.abs(fast.imag).max() < 1e-6
            and fast.real.max() > 1e-4 > -1e-4 > fast.real.min(),
        ),
        statement(
            "fig4-6.steep",
            where,
            "loci jump to the imaginary axis: the edge of the stable region is steep",
            "steep",
            f"growth rate ∝ (distance from the edge) to the power {power:.3f}",
            abs(power - 0.5) < 0.02,
            "A square root: its slope is infinite at the edge.",
        ),
    ]


def _ends(roots: Array) -> list[Claim]:
    where = "§4.3.2"
    fastest = np.abs(roots.imag).max(-1)
    beyond = fastest[SWEEP > 0.9]
    high = np.array([1e3, 1e4, 1e5])
    stiff = roots_along(high, pose=NOMINAL)
    k1_k3 = at(NOMINAL).spin.inertia_ratios
    rigid = float(np.sqrt(-k1_k3["k1"] * k1_k3["k3"]))
    real = stiff.real.max(-1)
    error = np.abs(real - rigid)
    three = at(NOMINAL).subsystem(THREE)
    m = three.M
    reduced = m[2, 2] - m[0, 2] ** 2 / m[0, 0]
    arm_body = np.sqrt(high * 2 * shoulder_inertia() / reduced)
    ratio = np.abs(stiff.imag).max(-1) / arm_body
    sprung = at(NOMINAL).spin.linear({"shoulder": HIGH})
    mode = max(sprung.subsystem(THREE).modes, key=lambda mode: mode.root.imag)
    return [
        statement(
            "fig4-6.outward",
            where,
            "one set moves away from the origin along the imaginary axis as long as K_sh rises",
            "outward for as long as stiffness increases",
            f"±{beyond[0]:.3f}i at K_sh = 0.9 to ±{beyond[-1]:.3f}i at 4, rising at every step",
            np.all(np.diff(beyond) > 0),
        ),
        number(
            "fig4-6.arm-body",
            where,
            "at high K_sh the fast pair is an arm–body oscillation: frequency over that of "
            "the arms "
            "on their springs against the body",
            1.0,
            float(ratio[-1]),
            "1",
            1e-3,
            f"At K_sh = 1e5; at 4 the mode is the {mode.name}.",
        ),
        number(
            "fig4-6.rigid",
            where,
            "at very high K_sh the two real roots approach the rigid body's ±√(−k1 k3)",
            rigid,
            float(real[-1]),
            "Ω",
            1e-4,
            f"At K_sh = 1e3, 1e4, 1e5 they are {error[0]:.0e}, {error[1]:.0e} and {error[2]:.0e} "
            "from it.",
        ),
    ]


def _stroboscopic() -> list[Claim]:
    """±i, from the whole system with nothing removed."""
    where = "§4.3.2"
    worst, arms, parallel = 0.0, 0.0, 0.0
    for angle in np.linspace(0, 3, 16):
        for damping in (0.0, 0.26):
            roots = undivided_roots(at(float(angle)), SWEEP[::6], damping)
            worst = max(worst, float(np.abs(roots - 1j).min(-1).max()))
    for k in (-2.0, 0.0, 1.0, 1.3, 4.0):
        part = at(NOMINAL).spin.linear({"shoulder": k}).subsystem(THREE)
        mode = min(part.modes, key=lambda mode: abs(mode.root - 1j))
        tilt, twist, arm = mode.shape
        arms = max(arms, float(abs(arm)))
        # Pure spin: the body's own rates across the spin, θ̇ + ψ and ψ̇ − θ, both vanish.
        rates = abs(mode.root * tilt + twist), abs(mode.root * twist - tilt)
        parallel = max(parallel, *(float(r) for r in rates))
    return [
        statement(
            "fig4-6.stroboscopic",
            where,
            "two poles at ±i do not move with K_sh, nor with any other parameter",
            "±i for all values of the parameters",
            f"within {1e-6:.0e} of ±i" if worst < 1e-6 else f"up to {worst:.1e} away from ±i",
            worst < 1e-6,
            "From all ten roots of the whole 5-d.o.f. system, 16 arm angles from 0 to 3 rad, 101 "
            "K_sh from −2 to 4, with and without damping.",
        ),
        statement(
            "fig4-6.no-arms",
            where,
            "the stroboscopic mode does not include arm movement",
            "a rigid-body mode",
            "no arm in the eigenvector" if arms < 1e-6 else f"arms by up to {arms:.1e}",
            arms < 1e-6,
            "For a tilt and twist of 1, at K_sh = −2, 0, 1, 1.3 and 4.",
        ),
        statement(
            "fig4-6.pure-spin",
            where,
            "it is pure spin about the middle principal axis, that axis being displaced",
            "attitude and velocity vectors parallel",
            "no angular velocity across the axis"
            if parallel < 1e-6
            else f"angular velocity across the axis up to {parallel:.1e}",
            parallel < 1e-6,
        ),
    ]


def _draw_4_6(roots: Array, low: float, high: float) -> Figure:
    from somersault.view import charts
    from somersault.view import style as look

    picture = look.figure(7.0, 5.6)
    ax = picture.add_subplot(title="Roots at Γ = 1.3 rad, undamped")
    dots = charts.locus(ax, SWEEP, roots, size=9, arrows=(-1.0, 0.45, 2.5))
    charts.stroboscopic(ax)
    corner = roots[0][np.argmax(roots[0].real + roots[0].imag)]
    look.label(ax, corner.real + 0.08, corner.imag - 0.1, "$K_{sh}$ = −2", look.GREY)
    end = roots[-1]
    look.label(ax, 0.12, end.imag.max(), "$K_{sh}$ = 4: arm against body")
    look.label(ax, 0.5, 0.17, "$K_{sh}$ = 4")
    meeting = roots[int(np.argmin(np.abs(SWEEP - low)))]
    y = float(np.median(meeting.imag[meeting.imag > 0]))
    look.pointer(ax, (0, y), (-1.9, y + 0.1), f"meet at {low:.2f}", look.VERMILION)
    look.pointer(ax, (0, 0), (-1.9, 0.22), f"origin at {high:.2f}", look.VERMILION)
    picture.colorbar(dots, ax=ax, label="$K_{sh}$", shrink=0.7)
    return picture


def fig_4_8() -> Result:
    """How the locus changes with the arm angle."""
    edge = edges(PANELS)
    rows, stable = [], []
    for i, angle in enumerate(PANELS):
        some = not np.isnan(edge.lower3[i])
        stable.append(some)
        text = f"{edge.lower3[i]:.3f} to {edge.upper3[i]:.3f}" if some else "none"
        rows.append((f"{angle:.1f}", text))
    loci = [roots_along(SWEEP[::3], pose=float(angle)) for angle in PANELS]
    imaginary = [np.abs(r.real).max(-1) < 1e-6 for r in loci]
    inside = [
        (edge.lower3[i] < SWEEP[::3]) & (edge.upper3[i] > SWEEP[::3]) for i in range(len(PANELS))
    ]
    claims = (
        statement(
            "fig4-8.some",
            "§4.3.2, Figure 4-8",
            "neutral stability is possible for certain combinations of arm angle and K_sh",
            "certain combinations",
            f"at {sum(stable)} of {len(PANELS)} arm angles: "
            + ", ".join(f"{a:.1f}" for a, some in zip(PANELS, stable, strict=True) if some),
            0 < sum(stable) < len(PANELS) and np.array_equal(imaginary, inside),
            "Eight panels from 0.0 (top left) to 2.8 rad (bottom centre) are steps of 0.4 rad. At "
            f"2.4 rad the range lies at negative K_sh and is {edge.upper3[6] - edge.lower3[6]:.3f} "
            "wide.",
        ),
        statement(
            "fig4-8.symmetric",
            "Figure 4-8",
            "without damping every locus is symmetric about the imaginary axis",
            "b_sh = 0",
            "all eight are" if max(map(asymmetry, loci)) < 1e-5 else "not all are",
            max(map(asymmetry, loci)) < 1e-5,
        ),
    )
    return Result(
        "Root loci of the 3-by-3 subsystem for arm angles from 0.0 (top left) to 2.8 rad (bottom "
        "centre), undamped, −2 < K_sh < 4.",
        "The stretch of K_sh that puts all roots on the imaginary axis opens near 0.6 rad, is "
        "widest near 1.5 rad and closes near 2.5 rad. Roots off the axis do not get there "
        "together for arms near the thighs or overhead.",
        claims,
        _draw_4_8(loci, rows),
        Table(("Γ (rad)", "stable K_sh, 3 d.o.f."), tuple(rows)),
    )


def _draw_4_8(loci: list[Array], rows: list[tuple[str, str]]) -> Figure:
    from somersault.view import charts
    from somersault.view import style as look

    picture = look.figure(8.6, 9.0)
    grid = picture.subplots(3, 3, sharex=True, sharey=True)
    for ax, roots, (angle, text) in zip(grid.flat, loci, rows, strict=False):
        dots = charts.locus(ax, SWEEP[::3], roots, size=5)
        ax.set(xlabel="", ylabel="", xlim=(-2, 2), ylim=(-2.6, 2.6))
        ax.set_aspect("equal", adjustable="box")
        ax.set_title(f"Γ = {angle} rad")
        look.label(
            ax,
            0.03,
            0.03,
            "stable: none" if text == "none" else f"stable:\n{text}",
            look.BLUE if text != "none" else look.VERMILION,
            transform=ax.transAxes,
            va="bottom",
        )
        ax.plot([0, 0], [1, -1], "o", mfc="none", mec=look.BLACK, ms=6, zorder=7)
    last = grid.flat[-1]
    last.axis("off")
    look.label(last, 0.02, 0.75, "rings: stroboscopic\nroots at ±i", transform=last.transAxes)
    picture.colorbar(dots, ax=last, label="$K_{sh}$", orientation="horizontal", fraction=0.2)
    picture.supxlabel("real part (growth), units of Ω", fontsize=10)
    picture.supylabel("imaginary part, units of Ω", fontsize=10)
    return picture
