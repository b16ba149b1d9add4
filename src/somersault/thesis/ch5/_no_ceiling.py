"""What the laboratory could not see: the doll's flights with no ceiling above them."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault.thesis._claims import Claim, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis.ch4._two_to_one import two_to_one
from somersault.thesis.ch5 import _doll as doll
from somersault.thesis.ch5 import _simulated_launches as experiment
from somersault.thesis.ch5._doll import BEST, WEIGHTED
from somersault.thesis.ch5._launcher import ARMS, SPIN
from somersault.thesis.ch5._pulleys import BEST_AT, OMITTED
from somersault.thesis.ch5._simulated_launches import SCATTER, Outcome, Scatter

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST = 30  # somersaults that are counted
STIFFNESSES = np.round(np.arange(0.5, 1.62, 0.04), 10)
SHARES = (1.0, 0.5, 0.25, 0.1)  # of the scatter of the laboratory
_DRAWN = 128  # launches a spring
_BETWEEN = (STIFFNESSES > 0.8) & (STIFFNESSES < 1.2)  # where all of little scatter would last
_KEEPS = 0.9  # of the best spring's share, within its margin


def scaled(share: float) -> Scatter:
    """The laboratory's scatter, all of it smaller."""
    return Scatter(
        share * SCATTER.attitude, share * SCATTER.rates, share * SCATTER.arms,
        share * SCATTER.pretension,
    )  # fmt: skip


@cache
def flown(share: float) -> Outcome:
    """Launches with each of STIFFNESSES for thirty somersaults' time."""
    return experiment.sprung(
        STIFFNESSES.tolist(), scaled(share), _DRAWN, duration=MOST * 2 * np.pi / SPIN,
        sequence="sobol",
    )  # fmt: skip


def margin(share: float) -> tuple[float, list[tuple[float, float]]]:
    """The best K_sh, and the ranges in which nine tenths as many launches last.

    The best is the middle of those that are first, as several may be. The resonance may cut the
    range in two.
    """
    stable = flown(share).share
    good = np.flatnonzero(stable >= _KEEPS * stable.max())
    runs = np.split(good, np.flatnonzero(np.diff(good) > 1) + 1)
    ranges = [(float(STIFFNESSES[run[0]]), float(STIFFNESSES[run[-1]])) for run in runs]
    return float(np.median(STIFFNESSES[stable == stable.max()])), ranges


def _spoken(ranges: list[tuple[float, float]]) -> str:
    return " and ".join(f"{a:.2f} to {b:.2f}" if b > a else f"{a:.2f}" for a, b in ranges)


def resonance() -> float:
    """The K_sh at which the arms' symmetric oscillation is twice as fast as the slow wobble."""
    return two_to_one(WEIGHTED, ARMS).stiffness


def no_ceiling() -> Result:
    """Lifetimes."""
    (low, high), *_ = doll.springs(WEIGHTED, ARMS)
    at = int(np.argmin(np.abs(STIFFNESSES - BEST)))
    rows = []
    for share in SHARES:
        outcome, (best, ranges) = flown(share), margin(share)
        middle = np.median(outcome.somersaults[at])
        rows.append((
            f"{share:g}", f"{100 * outcome.share[at]:.0f} %", _count(middle), f"{best:.2f}",
            f"{100 * outcome.share.max():.0f} %", _spoken(ranges),
        ))  # fmt: skip
    best, ranges = margin(0.5)
    return Result(
        "If we could have observed more somersaults, the doll may have exhibited a variance more "
        "in accordance with the remaining data (§5.5): the ceiling hid how long it lasts.",
        "Flights long enough for thirty somersaults, at the laboratory's scatter and less. With "
        "half of it the best "
        f"springs are about K_sh = {best:.2f}, and {_spoken(ranges)} do nine tenths as "
        f"well; the linear theory's range at Γ = {ARMS:g} is {low:.2f} to {high:.2f}. The "
        f"laboratory's 0.82 is low in both. Near {resonance():.2f} the symmetric and the "
        "antisymmetric oscillation are in resonance, 2 : 1.",
        tuple(_claims(at)),
        _draw(),
        Table(("scatter, of the laboratory's", "0.82: stable for 30", "its median somersaults",
               "best K_sh", "stable for 30", "nine tenths as many"), tuple(rows)),
    )  # fmt: skip


def _count(somersaults: float) -> str:
    return f"{somersaults:.1f}" if somersaults < 0.97 * MOST else f"{MOST} or more"


def _claims(at: int) -> list[Claim]:
    usual = flown(1.0)
    seen = float(experiment.many().share[BEST_AT])
    (low, high), *_ = doll.springs(WEIGHTED, ARMS)
    shares = [flown(share).share for share in SHARES]
    deviation = float(usual.deviation[at])
    inside = np.abs(STIFFNESSES - (low + high) / 2) < (high - low) / 2
    best, ranges = margin(0.5)
    first = int(np.argmin(np.abs(STIFFNESSES - best)))
    half = flown(0.5).share
    middle = np.flatnonzero(_BETWEEN)
    dip = int(middle[np.argmin(np.where(np.abs(STIFFNESSES[middle] - 1) < 0.1, half[middle], 2))])
    calm = flown(SHARES[-1]).share
    return [
        statement(
            "ch5-ceiling.variance", "§5.5", "with more somersaults to see, 0.82 would have had a "
            "variance like the other springs'", "more in accordance", f"a deviation of "
            f"{deviation:.1f} somersaults of {usual.mean[at]:.1f} over thirty, "
            f"{experiment.many().deviation[BEST_AT]:.2f} under the ceiling; "
            f"{100 * usual.share[at]:.0f} % stay stable for thirty, {100 * seen:.0f} % to the "
            "catch", deviation > 5 * experiment.many().deviation[BEST_AT],
        ),
        statement(
            "ch5-ceiling.indefinite", "ch. 4, summary", "stability may last indefinitely as long "
            "as energy is conserved", "indefinitely", f"without friction and at a tenth of the "
            f"scatter, {100 * calm[inside].mean():.0f} % of all launches with springs of the "
            f"linear range are still stable after thirty somersaults (with the worst of these "
            f"springs {100 * calm[inside].min():.0f} %, with the best "
            f"{100 * calm[inside].max():.0f} %), and {100 * calm[~inside].max():.0f} % with the "
            "best spring outside it",
            bool(calm[inside].max() > 0.99 and calm[inside].mean() > 0.8 > calm[~inside].max()),
            "Thirty somersaults are ten times what the laboratory saw, not for ever. Would fail "
            "if energy alone did not keep them: if no spring of the range kept 99 % of launches "
            "for so long, if the range kept less than 80 % on average, or if a spring outside it "
            "kept 80 %.",
        ),
        statement(
            "ch5-ceiling.scatter", "§4.3.3", "the number of stable somersaults is sensitive to the "
            "start", "sensitive", "with 0.82 "
            + ", ".join(f"{100 * x[at]:.0f} %" for x in shares)
            + " last for thirty at scatters of " + ", ".join(f"{x:g}" for x in SHARES)
            + " of the laboratory's", bool(shares[0][at] < shares[-1][at] - 0.3),
        ),
        statement(
            "ch5-ceiling.best", "§5.6", "the best spring for this doll is 0.82", "0.82",
            f"{best:.2f}: {100 * usual.share[first]:.0f} % of launches last for thirty "
            f"somersaults, with 0.82 {100 * usual.share[at]:.0f} %; at half the scatter "
            f"{_spoken(ranges)} are nine tenths as good as the best",
            any(a <= BEST <= b for a, b in ranges),
            "0.82 was the best of the five springs, and under the ceiling nearly as good as any. "
            f"The best for this doll lies near {best:.2f}, in the upper half of the linear range "
            f"of {low:.2f} to {high:.2f}: by the parts it has, 0.82's linear spring on the middle "
            f"pulley ({OMITTED:.2f}). Holds when 0.82 is within the margin at half the scatter.",
        ),
        statement(
            "ch5-ceiling.resonance", "§5.3", "every spring of the linear range stabilises the doll",
            "0.7 to 1.4", f"at half the scatter one launch in {1 / (1 - half[dip]):.0f} is lost at "
            f"K_sh = {STIFFNESSES[dip]:.2f}, in the middle of the range, and hardly any at "
            f"{STIFFNESSES[dip - 3]:.2f} and {STIFFNESSES[dip + 3]:.2f}",
            bool(half[dip] > 0.9 * min(half[dip - 3], half[dip + 3])),
            "Not linear: the arms' symmetric oscillation is exactly twice as fast as the slow "
            f"wobble at K_sh = {resonance():.2f}, and the two exchange energy, the more the larger "
            "they are. Too slow to be seen under the ceiling. Holds when there is no such gap.",
        ),
    ]  # fmt: skip


def _draw() -> Figure:
    from somersault.view import style as look

    picture = look.figure(9.2, 4.2)
    left, right = picture.subplots(1, 2)
    (low, high), *_ = doll.springs(WEIGHTED, ARMS)
    names = ("the laboratory's scatter", "half of it", "a quarter", "a tenth")
    colors: list[str] = [look.BLUE, look.VERMILION, look.GREEN, look.BLACK]
    lines = ("-", "--", "-.", ":")
    for share, color, line, name in zip(SHARES, colors, lines, names, strict=True):
        outcome = flown(share)
        left.plot(STIFFNESSES, 100 * outcome.share, color=color, ls=line, label=name)
        right.plot(
            STIFFNESSES, np.median(outcome.somersaults, 1), color=color, ls=line, label=name
        )  # fmt: skip
    for ax in (left, right):
        ax.axvspan(low, high, color=look.PALE, zorder=0)
        ax.axvline(BEST, color=look.GREY, lw=0.8, ls=":")
        ax.set(xlim=(STIFFNESSES[0], STIFFNESSES[-1]), xlabel="shoulder stiffness $K_{sh}$")
    left.set(ylim=(0, 128), ylabel=f"stable for {MOST} somersaults (%)")
    left.set_yticks([0, 25, 50, 75, 100])
    left.legend(loc="upper center", ncol=2, frameon=False, fontsize=8.5)
    right.set(ylim=(0, 33), ylabel="median somersaults until a quarter twist")
    look.label(right, (low + high) / 2, 2.0, "stable by linear theory", look.GREY, ha="center")
    look.label(left, BEST + 0.01, 5, "0.82", look.GREY)
    look.pointer(left, (resonance(), 60), (resonance(), 22), "2 : 1 resonance", ha="center")
    return picture
