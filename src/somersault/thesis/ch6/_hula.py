"""Section 6.3: the hula movement, which tilts a somersault at takeoff."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault.flight import (
    Flight,
    hula,
    principal_attitude,
    rigid_continuation,
)
from somersault.thesis._claims import Claim, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis._motion import Motion

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WHERE = "§6.3"
HOLDS = np.arange(0.0, 1.231, 0.03)  # s between hula and extension
_BEGIN, _QUARTER, _EXTEND = 0.05, 0.2, 0.2  # s
_RATE = 9.0  # rad/s of somersault in the pike
ABDUCTED, ADDUCTED = "T", "layout"
_STYLES: tuple[dict[str, float], ...] = ({}, {"pike": 0.8}, {"pike": 2.0}, {"extend": 0.3})


@dataclass(frozen=True, eq=False)
class Extensions:
    """Hulas that differ in when the hips extend (flight,).

    `moment` is how far the principal axes have twisted, in turns, in the middle of the extension;
    `tilt` (rad) the mean of theirs over a twist once the body is straight; `swung` how far the
    hula alone tilts them; `twists` per somersault afterwards.
    """

    moment: Array
    tilt: Array
    swung: float
    twists: Array

    @property
    def inside(self) -> Array:
        """Which extend between 1/4 and 3/4 twist."""
        return (self.moment >= 0.25) & (self.moment <= 0.75)


@cache
def extensions(arms: str = ABDUCTED, **style: float) -> Extensions:
    """The gymnast's hulas with the arms as in a pose until he extends, then at his sides."""
    rows = []
    swung = 0.0
    for hold in HOLDS.tolist():
        times = {"begin": _BEGIN, "quarter": _QUARTER, "hold": hold, "extend": _EXTEND} | style
        middle = _BEGIN + _QUARTER + hold + times["extend"] / 2
        maneuver = hula(spin=_RATE, arms=arms, duration=middle + times["extend"] / 2, **times)
        flown = maneuver.fly(accuracy=1e-9, samples=200)
        tilt, twist = principal_attitude(flown)
        turned = np.interp(middle, flown.times, np.unwrap(twist))
        if hold == 0.0:
            swung = float(np.interp(_BEGIN + _QUARTER, flown.times, tilt))
        after = rigid_continuation(flown)
        rows.append((abs(turned) / (2 * np.pi), after.mean_tilt, after.twists_per_somersault))
    moment, final, twists = np.array(rows).T
    return Extensions(moment, final, swung, twists)


def spread(hulas: Extensions) -> tuple[float, float, float]:
    """Least, greatest and mean tilt of those that extend between 1/4 and 3/4 twist, rad."""
    tilt = np.abs(hulas.tilt[hulas.inside])
    return float(tilt.min()), float(tilt.max()), float(tilt.mean())


def sec_6_3_hula() -> Result:
    """The hula's tilt, the extension's moment and the arms."""
    hulas = extensions()
    least, most, mean = np.degrees(spread(hulas))
    claims = (*_tilt_claims(hulas), _timing_claim(), _best_claim(hulas), _arms_claim(hulas))
    rows = []
    for style in _STYLES:
        other = extensions(**style)
        low, high, middle = np.degrees(spread(other))
        words = ", ".join(f"{k} {v:g}" for k, v in style.items()) or "pike 1.4, extend 0.2"
        rows.append((words, f"{np.degrees(abs(other.swung)):.1f}°", f"{low:.1f}°", f"{high:.1f}°",
                     f"{middle:.1f}°", f"{100 * (high - low) / middle:.0f} %"))  # fmt: skip
    return Result(
        "A quarter cycle of hula in a piked somersault tilts the principal axes, more so with the "
        "arms abducted. The hips should extend between 1/4 and 3/4 twist for the most tilt; "
        "between these, says Yeadon, the moment is not critical.",
        f"The gymnast at {_RATE:g} rad/s in a pike of 1.4 rad; in 0.2 s his legs swing from in "
        "front of him to 30° left of him, and some time later he extends in 0.2 s, arms to his "
        "sides (the "
        "thesis prints none of this). The moment is the twist of his principal axes in the middle "
        f"of the extension. Between 1/4 and 3/4 the tilt is {least:.1f} to {most:.1f}°, "
        f"{mean:.1f}° on average.",
        claims,
        _draw_6_3(),
        Table(("hula", "tilt before extending", "least, 1/4 to 3/4", "most", "mean", "spread"),
              tuple(rows)),
        Motion({"hula, then straight": _shown()}, 0.3, {"charts": True}),
    )  # fmt: skip


def _shown() -> Flight:
    """The hula that is drawn and filmed."""
    return hula(spin=_RATE, hold=0.16, duration=1.0).fly()


def _tilt_claims(hulas: Extensions) -> tuple[Claim, ...]:
    before = _before()
    sides = hula(side=-np.pi / 6).fly().landing
    other = hula().fly().landing
    mirrored = abs(sides.tilt + other.tilt) + abs(sides.twist + other.twist)
    return (
        statement(
            "sec6-3-hula.tilts", _WHERE, "a quarter cycle of hula in a piked somersault tilts the "
            "principal axes", "tilted", f"from {abs(np.degrees(before)):.2f}° to "
            f"{np.degrees(hulas.swung):.2f}° when the legs are at the side; if he extends at once, "
            f"{np.degrees(hulas.tilt[0]):.2f}° afterwards",
            bool(abs(before) < 1e-6 and abs(hulas.swung) > 0.05 and abs(hulas.tilt[0]) > 0.05),
        ),
        statement(
            "sec6-3-hula.side", _WHERE, "the side to which the hips swing decides that of the "
            "twist", "not said", f"legs to the left, {other.twist / (2 * np.pi):.2f} twists; to "
            f"the right the mirror image to {mirrored:.0e} rad",
            bool(mirrored < 1e-6 and abs(other.twist) > np.pi),
        ),
    )  # fmt: skip


def _before() -> float:
    flown = hula().fly()
    return float(np.interp(_BEGIN, flown.times, principal_attitude(flown)[0]))


def _timing_claim() -> Claim:
    shares, words = [], []
    for style in _STYLES:
        least, most, mean = spread(extensions(**style))
        shares.append((most - least) / mean)
        words.append(f"{np.degrees(least):.1f} to {np.degrees(most):.1f}°")
    listed = ", ".join(f"{100 * share:.0f} %" for share in shares)
    low, high, _ = spread(extensions(ADDUCTED))
    return statement(
        "sec6-3-hula.timing", _WHERE, "between 1/4 and 3/4 twist the moment of the extension is "
        "not critical to the final tilt (Yeadon)", "not critical",
        f"tilts of {words[0]}, a spread of {listed} of the mean in four styles of hula",
        bool(max(shares) < 0.25),
        "Holds when greatest and least differ by less than a quarter of the mean. With the arms at "
        f"the sides it is critical: {np.degrees(low):.1f} to {np.degrees(high):.1f}°.",
    )  # fmt: skip


def _best_claim(hulas: Extensions) -> Claim:
    least, most, mean = np.degrees(spread(hulas))
    outside = np.degrees(np.abs(hulas.tilt[~hulas.inside]))
    best = hulas.moment[np.argmax(np.abs(hulas.tilt))]
    return statement(
        "sec6-3-hula.best", _WHERE, "extending between 1/4 and 3/4 twist makes the net tilt "
        "greatest", "greatest", f"greatest at {best:.2f} twists; {least:.1f} to {most:.1f}° "
        f"between 1/4 and 3/4 ({mean:.1f}° on average), {outside.min():.1f} to "
        f"{outside.max():.1f}° ({outside.mean():.1f}°) before and after, from "
        f"{hulas.moment.min():.2f} to {hulas.moment.max():.2f}",
        bool(0.25 <= best <= 0.75 and mean > outside.mean() and least > outside.min()),
        "Holds when the greatest is between, and mean and least there exceed those outside. At "
        "half a twist there is a dip, where the bent body's own tilt is least.",
    )  # fmt: skip


def _arms_claim(hulas: Extensions) -> Claim:
    other = extensions(ADDUCTED)
    abducted, adducted = np.degrees([abs(hulas.swung), abs(other.swung)])
    best = np.degrees([np.abs(x.tilt).max() for x in (hulas, other)])
    return statement(
        "sec6-3-hula.arms", _WHERE, "the effect is increased if the arms are abducted during the "
        "hula", "increased", f"arms straight out {abducted:.2f}° when the legs are at the side and "
        f"at most {best[0]:.2f}° in the end; at the sides {adducted:.2f}° and {best[1]:.2f}°",
        bool(abducted > adducted and best[0] > best[1]),
        "With the arms at the sides the bent body turns back by itself at "
        f"{other.moment.max():.2f} twists, so that it never extends later than that.",
    )  # fmt: skip


def _draw_6_3() -> Figure:
    from somersault.view import strip
    from somersault.view import style as look

    picture = look.figure(9.4, 6.0)
    grid = picture.add_gridspec(2, 2, height_ratios=(1, 1.35))
    above, left, right = (picture.add_subplot(g) for g in (grid[0, :], grid[1, 0], grid[1, 1]))
    shown = _shown()
    times = np.array([0.0, 0.12, 0.25, 0.41, 0.51, 0.61, 0.71, 0.81, 0.91])
    strip(above, shown, times, view=(20.0, 12.0), words=False)
    size = above.get_ylim()[1] / 1.1
    for place, time in enumerate(times):
        look.label(above, 1.7 * size * place, -1.15 * size, f"{time:.2f} s", look.GREY,
                   ha="center", fontsize=8)  # fmt: skip
    above.set_title("legs from before the body to its side, and straight")
    left.axvspan(0.25, 0.75, color=look.PALE, lw=0)
    for arms, color, words, spot in (
        (ABDUCTED, look.BLUE, "arms straight out", (0.62, 14.8)),
        (ADDUCTED, look.VERMILION, "arms at the sides", (0.47, 5.6)),
    ):
        hulas = extensions(arms)
        on = slice(0, int(np.argmax(hulas.moment)) + 1)  # then it turns back
        final = np.degrees(np.abs(hulas.tilt[on]))
        left.plot(hulas.moment[on], final, ".-", color=color, ms=4, lw=1)
        look.label(left, *spot, words, color)
    look.label(left, 0.5, 0.8, "1/4 to 3/4 twist", look.GREY, ha="center")
    left.set(xlabel="twist in the middle of the extension", ylim=(0, 16), xlim=(0, 1.02))
    left.set_ylabel("mean tilt after it (°)")
    for hold, color, height in (
        (0.0, look.SKY, 7.6), (0.16, look.BLUE, 14.7), (0.4, look.BLACK, 10.3)
    ):  # fmt: skip
        flown = hula(spin=_RATE, hold=hold, duration=1.4).fly()
        right.plot(flown.times, np.degrees(np.abs(principal_attitude(flown)[0])), color=color)
        end = _BEGIN + _QUARTER + hold
        here = np.degrees(np.interp(end, flown.times, np.abs(principal_attitude(flown)[0])))
        right.plot(end, here, "o", color=color, ms=6)
        look.label(
            right, 1.0, height, f"after a hold of {hold:g} s" if hold else "without a hold", color
        )
    right.set(xlabel="time (s)", ylabel="tilt of the principal axes (°)", ylim=(0, 16))
    look.label(right, 0.55, 2.0, "dots: the hips begin to extend", look.GREY)
    return picture
