"""Figures 6-2 and 6-3, and the scan of the natural frequency behind them."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault.thesis._claims import number, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch6 import _rudi as rudi

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FREQUENCIES = (15.0, 18.0, 20.0, 22.0, 24.0, 26.0, 28.0, 30.0, 33.0, 37.0, 45.0, 60.0, 100.0, 200.0)
_COARSE = 11  # points a side in a scan
_FEW = (24.0, 30.0, 37.0, 45.0, 60.0, 100.0, 150.0, 200.0)
_AROUND = (20.0, 24.0, 28.0, 33.0, 45.0, 100.0)
_FEWER = 7  # points a side where most flights fail, each after thousands of steps
_NARROW = 5.0  # times as sensitive to one direction as to the other: a narrow valley
_FEW_LAND = 0.25  # of the grid
_LARGE = 0.3  # as in figure 6-4
_POSES: tuple[rudi.Pose, ...] = ("wrap", "pike", "following")
_GAINS = {
    "wrap": "gains from the wrap",
    "pike": "gains from the pike",
    "following": "gains following the pose",
}
_WHERE = "§6.3.3, Figure 6-3"


@cache
def best() -> float:
    """The natural frequency with the largest share of small errors (gains from mid-twist)."""
    return max(FREQUENCIES, key=lambda f: rudi.error_map(f, points=_COARSE).share)


def fig_6_2() -> Result:
    """Prescribed motion."""
    lands = rudi.error_map(None)
    sizes = np.linalg.svd(rudi.sensitivity(None), compute_uv=False)
    middle = lands.error[len(lands.starts) // 2, len(lands.starts) // 2]
    away = float(np.median(lands.error))
    where = "§6.3.2, Figure 6-2"
    claims = (
        statement(
            "fig6-2.centre", where, "the surface's height at the nominal start is zero", "zero",
            f"e = {middle:.0e}", bool(middle < 1e-5),
        ),
        statement(
            "fig6-2.valley", where, "away from the nominal the error increases except for a narrow "
            "valley of starts along which it remains small", "a narrow valley",
            f"sensitivity to one direction of (tilt, twist) is {sizes[0] / sizes[1]:.0f} times "
            f"that to the other ({sizes[0]:.0f} and {sizes[1]:.1f}); {100 * lands.share:.0f} % of "
            "the grid is below 0.1",
            bool(sizes[0] / sizes[1] > _NARROW) and lands.share < _FEW_LAND,
            f"Holds when the one is over {_NARROW:g} times the other and less than "
            f"{100 * _FEW_LAND:.0f} % land below {rudi.SMALL:g}.",
        ),
        statement(
            "fig6-2.unreliable", where, "a prescribed motion would not produce reliable landings",
            "unreliable", f"median error {away:.2f}, {100 * lands.share:.0f} % below 0.1",
            away > _LARGE,
            f"Holds when the median is above {_LARGE:g}, the error called large in fig6-4.",
        ),
    )  # fmt: skip
    return Result(
        "The landing error of the prescribed rudi from tilts and twists within 0.1 rad.",
        f"{lands.error.size} flights with the nominal's momentum in space; {claims[1].computed}.",
        claims,
        _draw_map(lands, "prescribed joints"),
    )


def fig_6_3() -> Result:
    """Compliant motion at its best natural frequency."""
    at, rate = best(), rudi.twist_rate()[0]
    stiff, soft = rudi.error_map(None), rudi.error_map(at)
    theirs = rudi.error_map(rudi.THEIRS)
    scan = {f: rudi.error_map(f, points=_COARSE) for f in FREQUENCIES}
    place = FREQUENCIES.index(at)
    low, high = scan[FREQUENCIES[0]], scan[FREQUENCIES[-1]]
    claims = (
        number(
            "fig6-3.best", _WHERE, "the natural frequency that lands most reliably",
            rudi.THEIRS, at, "rad/s", 7.0,
            f"On a scan of {len(FREQUENCIES)} values; the motion is ours.",
        ),
        number(
            "fig6-3.ratio", "§6.5", "that frequency over the greatest twist rate", 0.75, at / rate,
            "1", 0.15,
        ),
        number(
            "fig6-3.half", _WHERE, "share of the starts that lands with small errors at 30 rad/s: "
            "nearly half", 0.5, theirs.share, "1", 0.2,
            "Small is taken as below 0.1; the thesis does not say.",
        ),
        statement(
            "fig6-3.improved", _WHERE, "reliability is markedly better than with prescribed motion",
            "marked improvement", f"{100 * soft.share:.0f} % below 0.1 against "
            f"{100 * stiff.share:.0f} %", soft.share >= 4 * stiff.share,
            "Holds when it is at least four times as many.",
        ),
        statement(
            "fig6-3.interior", _WHERE, "landing errors were worse for either smaller or larger ω_n",
            "worse on both sides", f"{100 * low.share:.0f} % at {FREQUENCIES[0]:g} rad/s "
            f"({low.failures} of {low.error.size} failed), {100 * high.share:.0f} % at "
            f"{FREQUENCIES[-1]:g}", 0 < place < len(FREQUENCIES) - 1
            and max(low.share, high.share) < soft.share / 2,
            "Holds when the best is neither the lowest nor the highest of the scan and at both "
            "ends less than half as many land below 0.1.",
        ),
    )  # fmt: skip
    return Result(
        "Feed-forward torques plus compliance from one body-clamped natural frequency: at 30 rad/s "
        "nearly half the starts land with small errors; smaller and larger values are worse.",
        f"Ours is best at {at:g} rad/s, {at / rate:.2f} of the greatest twist rate: "
        f"{100 * soft.share:.0f} % of {soft.error.size} starts below 0.1, against "
        f"{100 * stiff.share:.0f} % prescribed. Gains use the outboard inertias in mid-twist "
        "(wrap): the thesis does not say in which pose its inertias were taken, and that choice "
        "decides the result (next entry).",
        claims,
        _draw_map(soft, f"compliant, ω_n = {at:g} rad/s"),
        Table(
            ("ω_n rad/s", "share below 0.1", "median error", "failed"),
            tuple(
                (
                    f"{f:g}",
                    f"{100 * m.share:.0f} %",
                    f"{_median(m):.2f}",
                    str(m.failures),
                )
                for f, m in scan.items()
            ),
        ),
    )


def _median(lands: rudi.Landings) -> float:
    return float(np.nanmedian(lands.error))


def gain_poses() -> Result:
    """In which pose the gains' inertias are taken."""
    shares = {pose: {f: rudi.error_map(f, pose, _FEWER) for f in _FEW} for pose in _POSES}
    top = {pose: max(m.share for m in maps.values()) for pose, maps in shares.items()}
    stiff = rudi.error_map(None, points=_FEWER).share
    rows = tuple(
        (f"{f:g}", *(f"{100 * shares[p][f].share:.0f} % ({shares[p][f].failures})" for p in _POSES))
        for f in _FEW
    )
    untaped = rudi.landings(rudi.strategy(best(), tape=False), _FEWER).share
    return Result(
        "The thesis does not say in which pose the outboard inertias of its gains were "
        "taken, nor how it counted flights that failed.",
        f"Prescribed, {100 * stiff:.0f} % of the starts land below 0.1. With gains from mid-twist "
        f"up to {100 * top['wrap']:.0f} %; from the initial pike up to {100 * top['pike']:.0f} %; "
        f"following the pose {100 * top['following']:.0f} %. The inertia about the upper arm's "
        "long axis is some ten times smaller with the elbow straight, as at takeoff, than bent: "
        "gains taken there leave the bent arm too soft, and flights end in the shoulder's "
        f"gimbal lock. In brackets: how many of {_FEWER**2} flights took more steps than allowed; "
        "they count as not landed and are never averaged over. Without the motor tape "
        f"{100 * untaped:.0f} % land below 0.1.",
        (),
        _draw_scan(shares, stiff),
        Table(("ω_n rad/s", *(f"{_GAINS[p]}: share (failed)" for p in _POSES)), rows),
    )


def other_momenta() -> Result:
    """0.9 h and 1.1 h."""
    claims = []
    rows = []
    for factor in (0.9, 1.1):
        stiff = rudi.error_map(None, points=_COARSE, factor=factor, against_unperturbed=True)
        scan = {f: rudi.error_map(f, "wrap", _COARSE, factor, True) for f in _AROUND}
        top = max(scan, key=lambda f: scan[f].share)
        fixed = rudi.error_map(top, "wrap", _COARSE, factor)
        ends = [scan[_AROUND[0]].share, scan[_AROUND[-1]].share]
        claims.append(
            statement(
                f"sec6-3.h-{factor:g}", "§6.3.3", f"the basic results held true at {factor:g} h",
                "held true", f"best at {top:g} rad/s: {100 * scan[top].share:.0f} % below 0.1 of "
                f"that momentum's own unperturbed landing, prescribed {100 * stiff.share:.0f} %; "
                f"{100 * ends[0]:.0f} % and {100 * ends[1]:.0f} % at {_AROUND[0]:g} and "
                f"{_AROUND[-1]:g} rad/s",
                scan[top].share >= 4 * stiff.share and max(ends) < scan[top].share / 2,
                "Against the nominal landing the somersault itself is off by a tenth of a turn, "
                f"e = 0.3, and {100 * fixed.share:.0f} % are below 0.1. Holds when the best is "
                "four times prescribed, and twice what it is at both ends.",
            )
        )  # fmt: skip
        rows.append((
            f"{factor:g} h", f"{100 * stiff.share:.0f} %", f"{top:g}",
            f"{100 * scan[top].share:.0f} %", f"{100 * fixed.share:.0f} %",
        ))  # fmt: skip
    return Result(
        "The basic results held for variations of the angular momentum, 0.9 h to 1.1 h.",
        "With less or more momentum the whole flight turns less or more, so the error is shown "
        "both against that momentum's own unperturbed flight and against the nominal landing.",
        tuple(claims),
        None,
        Table(
            ("momentum", "prescribed, own", "best ω_n", "compliant, own", "compliant, nominal"),
            tuple(rows),
        ),
    )


def _draw_map(lands: rudi.Landings, title: str) -> Figure:
    from somersault.view import style as look

    picture = look.figure(5.6, 4.6)
    ax = picture.subplots()
    shown = ax.pcolormesh(
        lands.starts, lands.starts, lands.error.T, cmap=look.darkening(), vmin=0, vmax=1,
        shading="nearest",
    )  # fmt: skip
    ax.contour(
        lands.starts, lands.starts, np.nan_to_num(lands.error.T, nan=9.0), levels=[rudi.SMALL],
        colors=[look.VERMILION], linewidths=1.6,
    )  # fmt: skip
    ax.set(xlabel="tilt at takeoff (rad)", ylabel="twist at takeoff (rad)", title=title)
    picture.colorbar(shown, ax=ax, extend="max").set_label("landing error e (orange line: 0.1)")
    return picture


def _draw_scan(shares: dict, stiff: float) -> Figure:
    from somersault.view import style as look

    picture = look.figure(6.6, 4.2)
    ax = picture.subplots()
    for pose, color in zip(_POSES, (look.BLUE, look.VERMILION, look.GREEN), strict=True):
        values = [100 * shares[pose][f].share for f in _FEW]
        ax.plot(_FEW, values, "o-", color=color, ms=4, label=_GAINS[pose])
    ax.axhline(100 * stiff, color=look.GREY, ls="--", lw=1.2, label="prescribed")
    ax.set(xscale="log", xlabel="body-clamped natural frequency ω_n (rad/s)", ylim=(0, None))
    ax.set_ylabel("starts that land below 0.1 (%)")
    ax.set_title(f"a grid of {_FEWER} × {_FEWER} starts: each is {100 / _FEWER**2:.0f} %")
    ticks = [24, 30, 45, 60, 100, 200]
    ax.set_xticks(ticks, [str(t) for t in ticks])
    ax.minorticks_off()
    ax.legend(frameon=False)
    return picture
