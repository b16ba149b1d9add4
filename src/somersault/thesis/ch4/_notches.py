"""The notches of figure 4-12, springs of the stable region with which few somersaults are done:
which resonance lies under each."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault import stability as st
from somersault._core.array import Array
from somersault.ensembles import Vary, ensemble
from somersault.flight import JointTakeoff, Report, Takeoff
from somersault.thesis._claims import Claim, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch4 import _lifetimes as figure
from somersault.thesis.ch4._columns import ORDER, Column, column, unflown
from somersault.thesis.ch4._furrer import ANGLE, MODEL, STIFFNESS, shoulder_inertia
from somersault.thesis.ch4._layout_takeoff import SPIN, TURN
from somersault.thesis.ch4._two_to_one import two_to_one

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

ANGLES = (0.9, 1.1, 1.3, 1.5, 1.7, 1.9)  # rad
TILTS = (0.002, 0.005, 0.01)  # rad, the momentum along the inertial axis 2
_MOST = 1000  # turns
_STEP = 0.002  # of K_sh
_NEAR = 0.005  # of K_sh from a resonance to the notch that it makes
_DRAWN = 1.7  # rad, of the picture
_MAP = np.linspace(0.6, 2.2, 81), np.linspace(0.0, 1.5, 76)
_MAP_START, _MAP_MOST = (0.05, 0.0), 100  # one of figure 4-12's starts, and turns
_WHERE = "§4.3.3, Figure 4-12"


@cache
def fine_map() -> xr.Dataset:
    """One of figure 4-12's plots, finer and longer."""
    tilt, twist = _MAP_START
    vary = {
        "arm_angle": Vary(sets="joints.shoulder.angle", values=_MAP[0], unit="rad"),
        "K_sh": _springs(_MAP[1]),
    }
    return ensemble(
        MODEL, Takeoff(tilt=tilt, twist=twist, spin=SPIN, joints=_arms(1.0)), _MAP_MOST * TURN,
        vary, report=Report(("somersaults",)), until="quarter twist", steps=1_000_000,
    ).dataset  # fmt: skip


def _arms(angle: float) -> dict[str, JointTakeoff]:
    return {"shoulder": JointTakeoff("sprung", angle=angle, stiffness=0.0, hold=True)}


def _springs(values: Array) -> Vary:
    scale = SPIN**2 * shoulder_inertia()
    return Vary(sets="joints.shoulder.stiffness", values=values, unit="1", scale=scale)


def in_the_figure() -> list[tuple[float, float]]:
    """Arm angle and K_sh of figure 4-12's notches: points of the region that do not reach eight,
    between two of the same arm angle that do, from any of the starts."""
    region = figure.predicted()
    found = set()
    for start in figure.STARTS:
        kept = figure.ridge(figure.flights(*start))
        for i, angle in enumerate(figure.ANGLES):
            places = np.flatnonzero(region[i])
            for j in places:
                between = kept[i, places[places < j]].any() and kept[i, places[places > j]].any()
                if between and not kept[i, j]:
                    found.add((float(angle), float(figure.STIFFNESSES[j])))
    return sorted(found)


def notches() -> Result:
    """Columns of the region, the figure's own notches, and the curves."""
    rows = []
    for angle in ANGLES:
        exact = two_to_one(MODEL, angle)
        for k, tilt in enumerate(TILTS):
            size = float(exact.burst.amplitude(tilt=tilt))
            low, high = exact.band(size)
            found = _column(angle).notches(k)
            rows.append((
                f"{angle:g}", f"{tilt:g}", f"{exact.stiffness:.3f}", f"{low:.3f} to {high:.3f}",
                ", ".join(f"{a:.3f} to {b:.3f}" for a, b in found) or "none",
            ))  # fmt: skip
    return Result(
        "The region that the linear analysis predicts is also the one that produces the most "
        "stable somersaults; the plots have notches in it.",
        "Of the three modes of the layout the slow wobble has negative energy, and the two others "
        "positive. Where whole numbers of such frequencies add up, both kinds grow together. The "
        "strongest is 2 : 1, the symmetric arms twice as fast as the wobble, of cubic terms in the "
        "energy. Its place follows from the linear modes, and how wide it is for a wobble of some "
        f"size from the quadratic terms of the equations. The table has, over {_MOST} turns, where "
        f"spins are lost within the region. Explosive ones of order {ORDER} or less: "
        f"{_said_resonances()} at Γ = {_DRAWN:g}.",
        tuple(_claims()),
        _draw(),
        Table(
            ("Γ (rad)", "tilt (rad)", "K_sh of 2 : 1", "where it should burst",
             "lost, away from the edges"), tuple(rows),
        ),
    )  # fmt: skip


def _said_resonances() -> str:
    return ", ".join(f"{name} at K_sh = {at:.3f}" for name, _, at in _column(_DRAWN).resonances())


def _claims() -> list[Claim]:
    small = [(angle, n) for angle in ANGLES for n in _column(angle).notches(0)]
    on = [_under(angle, notch) for angle, notch in small]
    places = in_the_figure()
    nearest = [
        min(
            (found for found in unflown(MODEL, angle).resonances() if found[1] <= 4),
            key=lambda found, k=k: abs(found[2] - k),  # type: ignore[misc]
        )
        for angle, k in places
    ]
    strong = [(a, n) for a in ANGLES for n in _column(a).notches(0) if _strong(a, n)]
    ends = []
    for angle, notch in strong:
        exact = two_to_one(MODEL, angle)
        band = exact.band(float(exact.burst.amplitude(tilt=TILTS[0])))
        ends += [abs(a - b) for a, b in zip(notch, band, strict=True)]
    shifts = [
        [
            sum(n) / 2 - two_to_one(MODEL, a).stiffness
            for n in _column(a).notches(k)
            if _strong(a, n)
        ]
        for k in (0, 1)
        for a in ANGLES
    ]
    first, second = (np.mean([x for s in shifts[k : k + len(ANGLES)] for x in s]) for k in (0, 6))
    untouched = [f"{a:g}" for a in ANGLES if not any(_strong(a, n) for n in _column(a).notches(0))]
    return [
        statement(
            "fig4-12-notches.under", _WHERE, f"from a tilt of {TILTS[0]:g} rad every notch has an "
            "explosive resonance of the linear modes under it", "ours",
            "; ".join(
                f"{angle:g} rad, {a:.3f} to {b:.3f}: {name or 'none'}"
                for (angle, (a, b)), name in zip(small, on, strict=True)
            ), all(on), f"Within {_NEAR:g} of the notch, order {ORDER} or less.",
        ),
        statement(
            "fig4-12-notches.width", _WHERE, "the notch of 2 : 1 is as wide as the quadratic terms "
            "say", "ours", f"its ends are within {max(ends):.3f} of the prediction, "
            f"{np.mean(ends):.3f} on average; notches are up to "
            f"{max(b - a for _, (a, b) in strong):.3f} wide", max(ends) < 0.01,
            f"Tilt {TILTS[0]:g} rad. Holds within 0.01. At Γ = "
            f"{', '.join(untouched) or 'none'} rad nothing is lost, though wobbles burst: they "
            "change their frequency as they grow, and stop below a quarter twist.",
        ),
        statement(
            "fig4-12-notches.figure", _WHERE, "2 : 1 lies nearest to each notch of figure 4-12, of "
            "the explosive resonances of order three and four",
            "ours", "; ".join(
                f"{a:g} rad, {k:g}: {n[0]} at {n[2]:.2f}"
                for (a, k), n in zip(places, nearest, strict=True)
            ), bool(places) and all(n[1] == 3 for n in nearest),
            "Notches: points of the linear region that do not reach eight somersaults, with points "
            "of the same arm angle above and below that do. They lie a step or so above it, as "
            "frequencies change with size. 4 : 1, of order five, is as near, but makes no notch at "
            "the smaller sizes.",
        ),
        statement(
            "fig4-12-notches.shift", _WHERE, "the larger the wobble, the farther above the "
            "resonance of the linear modes the notch lies", "ours",
            f"its middle is {first:+.4f} in K_sh away at a tilt of {TILTS[0]:g} rad, "
            f"{second:+.4f} at {TILTS[1]:g}", bool(0 <= abs(first) < second),
            "Frequencies change with the square of the size.",
        ),
    ]  # fmt: skip


@cache
def _column(angle: float) -> Column:
    return column(MODEL, angle, TILTS, _STEP, _MOST)


def _strong(angle: float, notch: tuple[float, float]) -> bool:
    """Whether a notch is that of 2 : 1."""
    at = two_to_one(MODEL, angle).stiffness
    return notch[0] - _NEAR <= at <= notch[1] + _NEAR


def _under(angle: float, notch: tuple[float, float]) -> str:
    """The resonance of least order that lies within a notch; nothing if there is none."""
    near = [
        f
        for f in unflown(MODEL, angle).resonances()
        if notch[0] - _NEAR <= f[2] <= notch[1] + _NEAR
    ]
    return min(near, key=lambda found: found[1])[0] if near else ""


def _draw() -> Figure:
    from somersault.view import charts
    from somersault.view import style as look

    picture = look.figure(9.6, 4.6)
    left, right = picture.subplots(1, 2, width_ratios=(1.15, 1))
    flown = fine_map()
    lives = np.minimum(flown["somersaults"].transpose("K_sh", "arm_angle").values, _MAP_MOST)
    shade = left.pcolormesh(
        *_MAP, lives, cmap=look.darkening(), norm="log", vmin=1, rasterized=True
    )
    picture.colorbar(shade, ax=left, label=f"somersaults (at most {_MAP_MOST})", shrink=0.8)
    curves = st.chart(
        MODEL, (ANGLE, np.linspace(0.6, 2.2, 161)), (STIFFNESS, np.linspace(0.0, 1.5, 151)),
        resonances=4,
    )  # fmt: skip
    x, y = curves[ANGLE], curves[STIFFNESS]
    left.contour(x, y, curves.stable.astype(float), [0.5], colors=[look.BLUE], linewidths=1.2)
    charts.resonance_curves(left, curves, exchange=False)
    left.legend(loc="lower left", fontsize=7.5, framealpha=0.85)
    left.set(xlabel="arm angle Γ (rad)", ylabel="shoulder stiffness $K_{sh}$")
    left.set_title(f"From a tilt of {_MAP_START[0]:g} rad")
    shown, exact = _column(_DRAWN), two_to_one(MODEL, _DRAWN)
    colors = (look.BLUE, look.GREEN, look.VERMILION)
    for k, (tilt, color) in enumerate(zip(TILTS, colors, strict=True)):
        low, high = exact.band(float(exact.burst.amplitude(tilt=tilt)))
        right.plot(shown.stiffness, shown.turns[:, k], color=color, lw=1.1, label=f"{tilt:g} rad")
        height = _MOST * 1.5 * 1.4**k
        right.plot([low, high], [height] * 2, color=color, lw=4, solid_capstyle="butt")
    for _, order, at in shown.resonances():
        right.axvline(at, color=look.GREY, lw=1.4 if order == 3 else 0.7, ls=":", zorder=0)
    right.set(yscale="log", ylim=(1, 8 * _MOST), xlim=shown.ends, xlabel="$K_{sh}$")
    right.set_ylabel(f"turns until a quarter twist (at most {_MOST})")
    right.set_title(f"Γ = {_DRAWN:g} rad; bars: predicted, 2 : 1")
    right.legend(title="tilt", loc="lower right", fontsize=8)
    return picture
