"""A rudi with bounded joint torques: how fast it twists, and whether compliance serves it too."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault.model import named_pose
from somersault.thesis._claims import Claim, number, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis._motion import Motion
from somersault.thesis.ch6 import _rudi as rudi

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_KEPT: rudi.Kept = "rudi_gentle"
_FREQUENCIES = (15.0, 17.0, 19.0, 21.0, 24.0, 28.0, 37.0, 60.0, 200.0)
_COARSE = 7  # points a side in the scan
_TILT = 0.05  # rad at landing that is small
_RATE = 40.2  # rad/s, the thesis's greatest twist rate
_WHERE = "§6.3.3, Figure 6-3"


def peaks(kept: rudi.Kept = _KEPT) -> dict[str, float]:
    """Greatest torque of each group of joints on the nominal way, N m."""
    torques = rudi.nominal(kept).joint_torques
    names = [str(name) for name in torques["joint_speed"].values]
    most = dict(zip(names, np.abs(torques.values).max(0).tolist(), strict=True))
    return {g: max(t for n, t in most.items() if g in n) for g in rudi.data(_KEPT)["bounds"]}


def _map(frequency: float | None, points: int = _COARSE) -> rudi.Landings:
    return rudi.error_map(frequency, points=points, kept=_KEPT)


@cache
def best() -> float:
    """The natural frequency with the largest share of small errors."""
    return max(_FREQUENCIES, key=lambda f: _map(f).share)


def bounded_torques() -> Result:
    """The gentler motion, its front and its maps."""
    at, (rate, when) = best(), rudi.twist_rate(_KEPT)
    soft, stiff = _map(at, 21), _map(None, 21)
    front = rudi.data(_KEPT)["front"]
    most = ", ".join(f"{group} {torque:.0f}" for group, torque in peaks().items())
    return Result(
        "The thesis prints no torques. Its motion's greatest twist rate is 40.2 rad/s.",
        "The nominal rudi asks for more than an athlete has. This one has the same start, "
        "technique and end, and is the fastest that a search found with torques bounded at "
        + ", ".join(f"{g} {b:.0f}" for g, b in rudi.data(_KEPT)["bounds"].items())
        + " N m (scripts/rudi.py, which says where they come from). It lands after "
        f"{rudi.landing_time(_KEPT):.2f} s with a tilt of "
        f"{rudi.nominal(_KEPT).landing.tilt:.3f} rad and twists fastest, {rate:.1f} rad/s, at "
        f"{when:.2f} s; peak torques: {most} N m. With the bounds times "
        + ", ".join(f"{one['times_bounds']:g} it is {one['twist_rate']:.1f}" for one in front[1:])
        + f" rad/s. Compliant, {100 * soft.share:.0f} % of {soft.error.size} starts land below 0.1 "
        f"at its own best ω_n of {at:g} rad/s, {at / rate:.2f} of its greatest twist rate, against "
        f"{100 * stiff.share:.0f} % prescribed.",
        (*_of_the_motion(rate), *_of_the_maps(at, rate, soft, stiff)),
        _draw(front, stiff),
        Table(
            ("bounds", "greatest twist rate rad/s", "landing s", "tilt rad", "peak torques N m"),
            tuple(
                (
                    f"× {one['times_bounds']:g}",
                    f"{one['twist_rate']:.1f}",
                    f"{one['numbers']['landing']:.2f}",
                    f"{one['tilt']:.3f}",
                    ", ".join(f"{group} {torque:.0f}" for group, torque in one["peaks"].items()),
                )
                for one in front
            ),
        ),
        Motion(
            {"an athlete's torques": rudi.nominal(_KEPT), "the nominal rudi": rudi.nominal()}, 0.3
        ),
    )


def _of_the_motion(rate: float) -> tuple[Claim, ...]:
    end, bounds, torques = rudi.nominal(_KEPT).landing, rudi.data(_KEPT)["bounds"], peaks()
    arms_out = named_pose(rudi.MODEL, "T")
    off = max(
        abs(end.joints[name] - arms_out[name.removeprefix("left_").removeprefix("right_")])
        for name in rudi.joint_names()
    )
    turns, twists = end.somersault / (2 * np.pi), abs(end.twist) / (2 * np.pi)
    front = rudi.data(_KEPT)["front"]
    reached = [one["times_bounds"] for one in front if one["twist_rate"] >= _RATE]
    return (
        statement(
            "gentle.lands", "§6.3.1", "it makes one somersault and one and a half twists, and "
            "finishes in layout with the arms straight out", "1 and 1½ turns, upright, arms out",
            f"{turns:.3f} and {twists:.3f} turns, tilt {end.tilt:.3f} rad, joints within "
            f"{off:.0e} rad",
            max(abs(turns - 1), abs(twists - 1.5)) < 0.01 and abs(end.tilt) < _TILT and off < 1e-6,
            "Holds with turns to 0.01, and less than 0.05 rad of tilt.",
        ),
        statement(
            "gentle.torques", "§6.3.1", "its torques are such as an athlete may have",
            "(not in the thesis)",
            "; ".join(f"{g} {t:.0f} of {bounds[g]:.0f} N m" for g, t in torques.items()),
            all(torque <= bounds[group] for group, torque in torques.items()),
            "Holds when none is over its bound."
        ),
        number(
            "gentle.rate", "§6.3.1", "the greatest twist rate", _RATE, rate, "rad/s", 6.0,
            "No motion was found within these torques that twists so fast. The thesis's had more "
            "torque, another technique, or the search missed it.",
        ),
        statement(
            "gentle.front", "§6.3.1", "the thesis's twist rate takes more than twice these torques",
            "(not in the thesis)",
            "; ".join(f"× {one['times_bounds']:g}: {one['twist_rate']:.1f} rad/s" for one in front),
            not reached,
            "By the search as it is; a better motion within the bounds would refute it.",
        ),
    )  # fmt: skip


def _of_the_maps(
    at: float, rate: float, soft: rudi.Landings, stiff: rudi.Landings
) -> tuple[Claim, ...]:
    low, high = _map(_FREQUENCIES[0]), _map(_FREQUENCIES[-1])
    place, top = _FREQUENCIES.index(at), _map(at).share
    return (
        statement(
            "gentle.improved", _WHERE, "reliability is markedly better than with prescribed motion",
            "marked improvement", f"{100 * soft.share:.0f} % below 0.1 against "
            f"{100 * stiff.share:.0f} %", soft.share >= 4 * stiff.share,
            "Holds when it is at least four times as many.",
        ),
        statement(
            "gentle.interior", _WHERE, "landing errors were worse for either smaller or larger ω_n",
            "worse on both sides", f"best at {at:g} rad/s; {100 * low.share:.0f} % at "
            f"{_FREQUENCIES[0]:g} ({low.failures} of {low.error.size} failed), "
            f"{100 * high.share:.0f} % at {_FREQUENCIES[-1]:g}",
            0 < place < len(_FREQUENCIES) - 1 and max(low.share, high.share) < top / 2,
            "Holds when both ends of the scan have less than half of the best.",
        ),
        number(
            "gentle.ratio", "§6.5", "the best natural frequency over the greatest twist rate", 0.75,
            at / rate, "1", 0.15,
        ),
        number(
            "gentle.half", _WHERE, "share of the starts that lands with small errors at the best "
            "ω_n: nearly half", 0.5, soft.share, "1", 0.2,
            "More than half of this motion's starts do: how many is each motion's own.",
        ),
    )  # fmt: skip


def _draw(front: list[dict], stiff: rudi.Landings) -> Figure:
    from somersault.view import style as look

    picture = look.figure(8.4, 3.9)
    left, right = picture.subplots(1, 2)
    rates = [one["twist_rate"] for one in front]
    left.plot([one["times_bounds"] for one in front], rates, "o-", color=look.BLUE, ms=5)
    left.axhline(_RATE, color=look.GREY, ls="--", lw=1.2, label="the thesis's motion")
    hips = peaks("rudi")["hip"] / rudi.data(_KEPT)["bounds"]["hip"]
    left.plot(
        hips, rudi.twist_rate()[0], "s", color=look.VERMILION, label="the nominal rudi, by its hips"
    )
    left.set(xlabel="torques allowed, over an athlete's", ylim=(0, None))
    left.set_ylabel("greatest twist rate (rad/s)")
    left.legend(frameon=False, fontsize=8, loc="lower right")
    shares = [100 * _map(f).share for f in _FREQUENCIES]
    right.plot(_FREQUENCIES, shares, "o-", color=look.BLUE, ms=4, label="compliant")
    right.axhline(100 * stiff.share, color=look.GREY, ls="--", lw=1.2, label="prescribed")
    right.set(xscale="log", xlabel="body-clamped natural frequency ω_n (rad/s)", ylim=(0, None))
    right.set_ylabel("starts that land below 0.1 (%)")
    ticks = [15, 20, 30, 60, 100, 200]
    right.set_xticks(ticks, [str(t) for t in ticks])
    right.minorticks_off()
    right.legend(frameon=False, fontsize=8)
    return picture
