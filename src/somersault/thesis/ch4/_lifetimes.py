"""Figure 4-12: somersaults until a quarter twist, over arm angle and shoulder stiffness."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault import stability as st
from somersault._core.array import Array
from somersault.ensembles import Vary, ensemble
from somersault.flight import JointTakeoff, Report, Takeoff
from somersault.thesis._claims import Claim, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch4._furrer import ANGLE, GROWS, MODEL, STIFFNESS, both, shoulder_inertia
from somersault.thesis.ch4._layout_takeoff import SPIN, TURN

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Tilt and twist at the start, rad; the thesis does not print those of its three plots.
MOST = 8.0  # somersaults that are counted
STARTS = ((0.01, 0.0), (0.05, 0.0), (0.0, 0.05))
ANGLES = np.round(np.linspace(0.4, 2.2, 19), 10)
STIFFNESSES = np.round(np.linspace(0.0, 1.8, 19), 10)
_WHERE = "§4.3.3, Figure 4-12"


@dataclass(frozen=True, eq=False)
class Lifetimes:
    """Somersaults until a quarter twist, at most `MOST`, over angles and stiffnesses.

    `furthest` is the largest |twist| on the way there, rad.
    """

    somersaults: Array
    furthest: Array


@cache
def flights(tilt: float, twist: float) -> Lifetimes:
    """The 361 flights of one start."""
    return lifetimes(ANGLES, STIFFNESSES, tilt, twist)


def lifetimes(
    angles: Array, stiffnesses: Array, tilt: float, twist: float, accuracy: float = 1e-9
) -> Lifetimes:
    """A flight for each arm angle (n,) and K_sh (m,): arrays (n, m).

    The quarter twist, where the momentum along body axis 2 changes sign, is an event of the
    integration. Flights go on for a fifth longer than eight nominal turns, so that one
    that somersaults slowly gets there too.
    """
    vary = {
        "arm_angle": Vary(sets="joints.shoulder.angle", values=angles, unit="rad"),
        "K_sh": Vary(
            sets="joints.shoulder.stiffness", values=stiffnesses, unit="1",
            scale=SPIN**2 * shoulder_inertia(),
        ),
    }  # fmt: skip
    flown = ensemble(
        MODEL,
        _start(tilt, twist),
        1.2 * MOST * TURN,
        vary,
        report=Report(("somersaults",), history=("somersault", "twist"), samples=int(60 * MOST)),
        accuracy=accuracy,
        until="quarter twist",
    ).dataset
    before = flown["somersault_history"] <= 2 * np.pi * MOST
    furthest = abs(flown["twist_history"]).where(before).max("history_time")
    return Lifetimes(np.minimum(flown["somersaults"].values, MOST), furthest.values)


def _start(tilt: float, twist: float) -> Takeoff:
    joint = JointTakeoff("sprung", angle=float(ANGLES[0]), stiffness=0.0, hold=True)
    return Takeoff(tilt=tilt, twist=twist, spin=SPIN, joints={"shoulder": joint})


@cache
def predicted() -> Array:
    """Where the linear 5-d.o.f. system is stable, on the same points."""
    rates = st.growth_rates(MODEL, {ANGLE: ANGLES[:, None], STIFFNESS: STIFFNESSES[None, :]})
    return rates <= GROWS


def ridge(lives: Lifetimes) -> Array:
    """Points that reach the limit of eight."""
    return lives.somersaults >= MOST - 1e-9


def widened(region: Array) -> Array:
    """A region and the points next to it, diagonally too."""
    around = np.pad(region, 1)
    n, m = region.shape
    return np.any([around[i : i + n, j : j + m] for i in range(3) for j in range(3)], 0)


def fig_4_12() -> Result:
    """Three starts."""
    region = predicted()
    claims: list[Claim] = []
    rows = []
    counts = []
    close = min(float(widened(region)[ridge(flights(*start))].mean()) for start in STARTS)
    for tilt, twist in STARTS:
        lives = flights(tilt, twist)
        top = ridge(lives)
        counts.append(int(top.sum()))
        claims += _start_claims(tilt, twist, lives, top, region)
        common = int((top & region).sum())
        rows.append((
            f"{tilt:g}", f"{twist:g}", str(counts[-1]), f"{100 * common / top.sum():.0f} %",
            f"{100 * (top & widened(region)).sum() / top.sum():.0f} %",
            f"{100 * common / region.sum():.0f} %",
            f"{lives.somersaults[region].mean():.1f}", f"{lives.somersaults[~region].mean():.1f}",
        ))  # fmt: skip
    claims += _joint_claims(counts)
    return Result(
        "Stable somersaults, at most eight, that the five-d.o.f. model does before a quarter "
        "twist, over Γ from 0.4 to 2.2 rad and K_sh from 0 to 1.8, for three starts: the region "
        "that the linear analysis predicted to be stable (figure 4-9) is also the one that "
        "produces the most stable somersaults, and their number is sensitive to the initial tilt "
        "and twist.",
        "Starts (ours; the thesis's are not printed): tilt 0.01 rad; tilt 0.05 rad; twist 0.05 "
        f"rad; only the somersault angle changes at first, at {SPIN} rad/s; springs pretensioned; "
        "K_sh = 0 is a constant torque. The quarter twist is an event of the integration: angular "
        "momentum along body axis 2 changes sign. Of the flights that reach eight at least "
        f"{100 * close:.0f} % lie on the linear region or next to it, from any of the starts; how "
        f"many reach it: {', '.join(map(str, counts))}.",
        tuple(claims),
        _draw_4_12(),
        Table(
            ("tilt", "twist", "reach eight", "of these in the linear region", "or next to it",
             "linear region that reaches eight", "mean inside", "mean outside"), tuple(rows),
        ),
    )  # fmt: skip


def _start_claims(
    tilt: float, twist: float, lives: Lifetimes, top: Array, region: Array
) -> list[Claim]:
    name = f"fig4-12.tilt-{tilt:g}-twist-{twist:g}"
    start = f"from tilt {tilt:g}, twist {twist:g} rad"
    inside = float((top & region).sum() / top.sum())
    close = float((top & widened(region)).sum() / top.sum())
    cover = float((top & region).sum() / region.sum())
    within, without = (float(lives.somersaults[x].mean()) for x in (region, ~region))
    survivors = lives.furthest[top]
    clear = float((survivors < np.pi / 4).mean())
    return [
        statement(
            f"{name}-ridge", _WHERE, f"{start}: the ridge lies on the region of figure 4-9",
            "the same region", f"{int(top.sum())} of {top.size} flights reach eight: "
            f"{100 * inside:.0f} % of them in the region, {100 * close:.0f} % in it or on a next "
            f"point; they are {100 * cover:.0f} % of the region's {int(region.sum())} points",
            inside > 0.5 and close > 0.95,
            "Holds when most are inside and nearly all within one step of 0.1 of the grid.",
        ),
        statement(
            f"{name}-most", _WHERE, f"{start}: the linearly stable region produces the most stable "
            "somersaults", "the most", f"on average {within:.2f} in it, {without:.2f} outside",
            within > 2 * without,
        ),
        statement(
            f"{name}-clear", "§4.3.3", f"{start}: little ambiguity between stable and unstable; "
            "twist stays small or grows beyond a quarter twist", "little ambiguity",
            f"{100 * clear:.0f} % of the flights that reach eight stay below an eighth of a twist, "
            f"half of them below {np.degrees(np.median(survivors)):.0f}°", clear > 0.9,
        ),
    ]  # fmt: skip


def _joint_claims(counts: list[int]) -> list[Claim]:
    fates = [flights(*start).somersaults for start in STARTS]
    apart = float(np.mean([np.abs(a - fates[0]).mean() for a in fates[1:]]))
    return [
        statement(
            "fig4-12.sensitive", _WHERE, "the number of stable somersaults is sensitive to the "
            "initial tilt and twist", "sensitive", f"{', '.join(map(str, counts))} flights reach "
            f"eight; lifetimes differ by {apart:.1f} somersaults on average",
            len(set(counts)) == len(counts) and apart > 0.2,
        ),
        statement(
            "fig4-12.limit", "§4.3.3", "several simulations exceeded the limit of eight",
            "several", f"{counts[0]} from the first start", counts[0] > 2,
        ),
    ]  # fmt: skip


def _draw_4_12() -> Figure:
    from somersault.view import style as look

    picture = look.figure(9.6, 4.1)
    grid = picture.subplots(1, 3, sharey=True)
    region = both().transpose(STIFFNESS, ANGLE)
    for ax, (tilt, twist) in zip(grid, STARTS, strict=True):
        lives = flights(tilt, twist)
        shown = ax.pcolormesh(
            ANGLES, STIFFNESSES, lives.somersaults.T, cmap=look.darkening(), vmin=0, vmax=8,
            edgecolors="white", linewidth=0.3,
        )  # fmt: skip
        ax.contour(
            region[ANGLE], region[STIFFNESS], region.astype(float), levels=[0.5],
            colors=[look.VERMILION], linewidths=1.6,
        )  # fmt: skip
        ax.set(xlim=(0.35, 2.25), ylim=(-0.05, 1.85), xlabel="arm angle Γ (rad)")
        ax.set_title(f"tilt {tilt:g}, twist {twist:g} rad")
    grid[0].set_ylabel("shoulder stiffness $K_{sh}$")
    bar = picture.colorbar(shown, ax=grid, shrink=0.8)
    bar.set_label("somersaults until a quarter twist (at most 8)")
    look.label(
        grid[0], 0.45, 0.12, "outlined: stable by the\nlinear analysis (fig. 4-9)", look.VERMILION
    )
    return picture
