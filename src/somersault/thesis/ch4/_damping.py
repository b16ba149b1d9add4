"""Figure 4-7, damped shoulders, and the signature of the energy, which explains it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from somersault import stability as st
from somersault._core.array import Array
from somersault.thesis._claims import Claim, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch4._furrer import (
    ANGLE,
    DAMPING,
    GROWS,
    HIGH,
    LOW,
    MODEL,
    NOMINAL,
    PRINTED_DAMPING,
    STIFFNESS,
    THREE,
    at,
    edges,
    literal_damping,
)
from somersault.thesis.ch4._root_loci import SWEEP, asymmetry, roots_along

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_COARSE = np.linspace(0, 3, 61), np.linspace(LOW, HIGH, 121)


def _growth(damping: float, angles: Array, stiffness: Array, axis: int = 2) -> Array:
    """Growth rates (K_sh, Γ) with damped shoulders."""
    quantities: dict[str, Any] = {
        ANGLE: angles[None, :],
        STIFFNESS: stiffness[:, None],
        DAMPING: damping,
    }
    return st.growth_rates(MODEL, quantities, axis=axis, subsystem=THREE if axis == 2 else None)


def fig_4_7() -> Result:
    """The locus of figure 4-6 with a damper at each shoulder."""
    damping = literal_damping()
    roots = roots_along(SWEEP, pose=NOMINAL, damping=damping)
    moving = np.where(np.abs(roots - 1j) < 1e-6, -np.inf, roots.real)
    moving = np.where(np.abs(roots + 1j) < 1e-6, -np.inf, moving).max(-1)
    best = int(np.argmin(moving))
    return Result(
        "The same locus with b_sh/Φ̇ = 0.1: the symmetry about the imaginary axis is lost, and no "
        "spring stabilises the system. Damping tends to destabilise gyrically stabilised systems.",
        f"b_sh/Φ̇ has a unit: 0.1 kg m² is b/(Ω I_sh) = {damping:.2f}. Read that way, and also "
        "with 0.1 taken as non-dimensional, no K_sh stabilises the spin. The least growth rate is "
        f"{moving[best]:.3f}"
        f" Ω, at K_sh = {SWEEP[best]:.2f}. ",
        tuple(_claims(roots, moving)),
        _draw_4_7(roots, moving, best),
    )


def _claims(roots: Array, moving: Array) -> list[Claim]:
    where = "§4.3.2, Figure 4-7"
    claims = []
    for slug, value, words in (
        ("kg-m2", literal_damping(), "b_sh/Φ̇ = 0.1 kg m², that is b/(Ω I_sh) = 0.26"),
        ("non-dimensional", PRINTED_DAMPING, "b/(Ω I_sh) = 0.1"),
    ):
        growth = _growth(value, np.array([NOMINAL]), SWEEP)
        claims.append(
            statement(
                f"fig4-7.no-spring-{slug}",
                where,
                f"no K_sh stabilises the damped system at Γ = 1.3 rad ({words})",
                "no set of spring values",
                f"{int((growth <= GROWS).sum())} of {growth.size} K_sh from −2 to 4; least growth "
                f"rate {growth.min():.4f} Ω",
                not np.any(growth <= GROWS),
                "The thesis plots b_sh/Φ̇ = 0.1 without a unit; eq. 4.4 makes it kg m². Both "
                "readings are checked.",
            )
        )
    unlike = asymmetry(roots)
    still = np.abs(roots - 1j).min(-1).max()
    light = [_light(damping) for damping in (1e-3, 1e-2, 0.1)]
    wide = [_growth(b, *_COARSE) for b in (literal_damping(), PRINTED_DAMPING)]
    count = sum(int((growth <= GROWS).sum()) for growth in wide)
    return [
        *claims,
        statement(
            "fig4-7.asymmetric",
            where,
            "with damping the symmetry about the imaginary axis is lost",
            "loss of symmetry",
            f"mirror images up to {unlike:.2f} Ω apart",
            unlike > 0.01,
        ),
        statement(
            "fig4-7.stroboscopic",
            "§4.3.2",
            "the stroboscopic roots ±i stay, for all values of the parameters",
            "±i",
            "±i at every K_sh" if still < 1e-6 else f"up to {still:.1e} away",
            still < 1e-6,
        ),
        statement(
            "fig4-7.destabilises",
            "§4.3.2",
            "damping tends to destabilise gyrically stabilised systems",
            "tends to",
            "; ".join(f"b/(Ω I) = {b:g}: {bad} of {total} stable cases" for b, bad, total in light),
            all(bad == total for _, bad, total in light),
            "Every stable case of figure 4-10 on a grid of 0.05 by 0.05, damped lightly. Hughes's "
            "theorem asks for complete damping, as the thesis remarks; here it happens all the "
            "same.",
        ),
        statement(
            "fig4-7.asymptotic",
            "§4.3.2",
            "asymptotic stability is unlikely, as damping destabilises",
            "unlikely",
            f"{count} of {sum(g.size for g in wide)} damped cases are stable",
            count == 0,
            "Arm angles 0 to 3 rad by 0.05, K_sh −2 to 4 by 0.05, both readings of 0.1.",
        ),
    ]


def _light(damping: float) -> tuple[float, int, int]:
    """How many of the stable cases a light damper makes grow."""
    stable = _growth(0.0, *_COARSE) <= GROWS
    grows = _growth(damping, *_COARSE) > GROWS
    return damping, int((stable & grows).sum()), int(stable.sum())


def _draw_4_7(roots: Array, moving: Array, best: int) -> Figure:
    from somersault.view import charts
    from somersault.view import style as look

    picture = look.figure(9.2, 5.2)
    ax, rate = picture.subplots(1, 2, width_ratios=(1.1, 1))
    ax.set_title("Roots at Γ = 1.3 rad, $b_{sh}$/Ω = 0.1 kg m²")
    dots = charts.locus(ax, SWEEP, roots, size=9, arrows=(-1.0, 0.3, 3.0))
    charts.stroboscopic(ax, text="stroboscopic")
    picture.colorbar(dots, ax=ax, label="$K_{sh}$", shrink=0.7)
    undamped = roots_along(SWEEP, pose=NOMINAL).real.max(-1)
    rate.plot(SWEEP, undamped, color=look.BLUE)
    rate.plot(SWEEP, moving, color=look.VERMILION)
    rate.set(xlabel="$K_{sh}$", ylabel="largest growth rate, units of Ω", ylim=(-0.05, 1.3))
    rate.set_title("Growth with and without the damper")
    rate.axhline(0, color=look.GREY, lw=0.8)
    look.pointer(rate, (1.0, 0.0), (0.7, 0.95), "undamped:\nzero in between", look.BLUE)
    look.pointer(
        rate,
        (SWEEP[best], moving[best]),
        (1.85, 0.16),
        f"damped: at least\n{moving[best]:.3f} Ω",
        look.VERMILION,
    )
    return picture


# ------------------------------------------------------------------ beyond the thesis


def energy_signature() -> Result:
    """Which stable spins are minima of the energy: why figure 4-7 comes out as it does."""
    angles, stiffness = np.linspace(0, 3, 151), np.linspace(LOW, HIGH, 301)
    layout = st.chart(MODEL, (ANGLE, angles), (STIFFNESS, stiffness), subsystem=THREE, energy=True)
    wheel = st.chart(MODEL, (ANGLE, angles), (STIFFNESS, stiffness), axis=1, energy=True)
    rows = [
        (
            name,
            f"{int(chart.definite.sum())}",
            f"{int((chart.stable & ~chart.definite).sum())}",
            f"{int((~chart.stable).sum())}",
        )
        for name, chart in (("layout somersault, axis 2", layout), ("cartwheel, axis 1", wheel))
    ]
    return Result(
        "There are three kinds of spin. “Definite”: at the given angular momentum the energy is a "
        "minimum, so the motion stays near it and dampers only help. “Gyroscopic”: the energy is a "
        "saddle, and Coriolis forces alone hold the motion there. “Unstable”: nothing does.",
        "Every stable layout somersault is gyroscopic: twist has negative stiffness (k22 = I₂ − I₁ "
        "< 0) that no shoulder spring can lift. Of its two arm–body oscillations one has negative "
        f"energy, so a damper that takes energy away makes it larger. At Γ = 1.3, K_sh = 1: "
        f"{_signs()}. That is why figure 4-7 has no stable spring. The lower edge of figure "
        "4-10 lies where the two oscillations, of opposite energy, meet. The same athlete turning "
        "cartwheels about "
        "the axis of greatest inertia is definite above a certain stiffness, and damping does no "
        "harm there.",
        (),
        _draw_energy(layout, wheel),
        Table(
            ("spin", "definite", "gyroscopic", "unstable"),
            tuple(rows),
        ),
    )


def _draw_energy(layout: xr.Dataset, wheel: xr.Dataset) -> Figure:
    from somersault.view import charts
    from somersault.view import style as look

    picture = look.figure(9.2, 7.4)
    (left, right), (low_left, low_right) = picture.subplots(2, 2, height_ratios=(1.4, 1))
    titles = "Layout somersault (axis 2)", "Cartwheel (axis 1)"
    damping = literal_damping()
    values = np.linspace(LOW, HIGH, 301)
    for ax, below, chart, axis, title in (
        (left, low_left, layout, 2, titles[0]),
        (right, low_right, wheel, 1, titles[1]),
    ):
        charts.chart_axes(ax, title)
        x, y = chart[ANGLE], chart[STIFFNESS]
        gyroscopic = chart.stable & ~chart.definite
        if bool(gyroscopic.any()):
            charts.filled(ax, x, y, gyroscopic, look.ORANGE, look.VERMILION)
        if bool(chart.definite.any()):
            charts.filled(ax, x, y, chart.definite, look.GREEN, look.GREEN, alpha=0.35)
        ax.plot([NOMINAL] * 2, [LOW, HIGH], color=look.BLACK, lw=0.8, ls="--")
        for b, color in ((0.0, look.BLUE), (damping, look.VERMILION)):
            rate = _growth(b, np.array([NOMINAL]), values, axis)[:, 0]
            below.plot(values, rate, color=color, ls="-" if b == 0 else "--")
        below.axhline(0, color=look.GREY, lw=0.8)
        below.set(xlabel="$K_{sh}$ along the dashed line, Γ = 1.3 rad", ylim=(-0.15, 1.8))
    low_left.set_ylabel("largest growth rate, units of Ω")
    edge = edges(np.array([NOMINAL]))
    middle = float(edge.lower3[0] + edge.upper3[0]) / 2
    look.pointer(left, (1.5, 0.75), (1.75, 2.4), "gyroscopic:\ndamping destroys it", look.VERMILION)
    look.label(left, 0.2, 3.0, "unstable", look.GREY)
    look.label(right, 0.9, 2.6, "definite: damping does no harm", look.GREEN)
    look.label(right, 0.3, -1.2, "unstable", look.GREY)
    look.pointer(low_left, (middle, 0), (middle + 0.1, 1.2), "undamped", look.BLUE)
    look.pointer(
        low_left,
        (2.2, float(_growth(damping, np.array([NOMINAL]), np.array([2.2]))[0, 0])),
        (2.5, 1.2),
        "damped",
        look.VERMILION,
    )
    look.label(low_right, 0.3, 0.18, "damped and undamped: no growth", look.BLACK)
    return picture


def _signs() -> str:
    """The two oscillations at K_sh = 1: frequency, sign of energy, and what a light damper does."""
    spin = at(NOMINAL).spin
    still, damped = (
        spin.linear({"shoulder": 1.0}, {"shoulder": b}).subsystem(THREE) for b in (0.0, 0.01)
    )
    words = []
    for mode in still.modes:
        if mode.energy:
            near = damped.roots[np.argmin(np.abs(damped.roots - mode.root))]
            sign = "positive" if mode.energy > 0 else "negative"
            words.append(
                f"the one at {mode.root.imag:.2f} Ω has {sign} energy and, damped by "
                f"b/(Ω I) = 0.01, {'grows' if near.real > 0 else 'decays'} at "
                f"{abs(near.real):.4f} Ω"
            )
    return "; ".join(words)
