"""Figures 6-1, 6-4 and 6-5: the nominal rudi, and two flights from (−0.1, −0.1)."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault.flight import Flight, fly, landing_error, landing_target, off_nominal
from somersault.model import named_pose
from somersault.thesis._claims import number, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis._motion import Motion
from somersault.thesis.ch6 import _rudi as rudi

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_CORNER = -0.1  # rad of tilt and twist at takeoff
_FREQUENCY = rudi.THEIRS
_LARGE = 0.3  # an error that is large, and below which the nominal landing is followed
_TIMES = 4.0  # by which it must be less than with prescribed joints
_SIGNIFICANT = 0.1  # rad of a joint's deviation
_SLOW = 0.3  # of the real speed
_SHOWN = ("left_shoulder_abduction", "right_shoulder_abduction", "left_elbow")
_GROUPS = ("shoulder", "elbow", "hip", "torso")


def error(flight: Flight) -> float:
    """The landing error e of section 6.3.2."""
    return float(landing_error(landing_target(rudi.nominal()), landing_target(flight)))


@cache
def from_the_corner(frequency: float | None) -> Flight:
    """The flight from −0.1 rad of tilt and of twist."""
    takeoff = off_nominal(rudi.MODEL, rudi.strategy(frequency), tilt=_CORNER, twist=_CORNER)
    return fly(rudi.MODEL, takeoff, rudi.landing_time(), samples=401, accuracy=1e-8)


def fig_6_1() -> Result:
    """The nominal maneuver."""
    flight, end = rudi.nominal(), rudi.nominal().landing
    rate, when = rudi.twist_rate()
    arms_out = named_pose(rudi.MODEL, "T")
    off = max(
        abs(end.joints[name] - arms_out[name.removeprefix("left_").removeprefix("right_")])
        for name in rudi.joint_names()
    )
    turns, twists = end.somersault / (2 * np.pi), abs(end.twist) / (2 * np.pi)
    where = "§6.3.1, Figure 6-1"
    claims = (
        number("fig6-1.somersault", where, "it makes one somersault", 1.0, turns, "turns", 0.02),
        number(
            "fig6-1.twists", where, "it makes one and a half twists", 1.5, twists, "turns", 0.02
        ),
        number(
            "fig6-1.twist-rate", where, "the greatest twist rate", 40.2, rate, "rad/s", 6.0,
            "The motion is ours; the rate was one of several aims in finding it.",
        ),
        statement(
            "fig6-1.ends", where, "it finishes in layout with the arms straight out to the sides",
            "layout, arms out", f"every joint within {off:.0e} rad of that", off < 1e-6,
        ),
        statement(
            "fig6-1.free", where, "nothing acts from outside", "a weightless environment",
            f"inverse dynamics leaves {np.abs(flight.external_moment).max():.0e} N m on the base; "
            f"momentum is kept to {flight.momentum_drift:.0e}",
            bool(np.abs(flight.external_moment).max() < 1e-6 and flight.momentum_drift < 1e-9),
        ),
    )  # fmt: skip
    torques = np.abs(flight.joint_torques.values).max(0)
    names = flight.joint_torques["joint_speed"].values
    peaks = {g: max(t for n, t in zip(names, torques, strict=True) if g in n) for g in _GROUPS}
    return Result(
        "A front somersault with one and a half twists from an upright pike, arms out, 12.6 rad/s, "
        "by the hula movement, to a layout with arms out; programmed by hand.",
        "The thesis does not print its motion, so ours comes from differential evolution over a "
        "few timings and amplitudes (scripts/rudi.py) and is stored as data: pike, a quarter of a "
        f"hula, arms wrapped, arms out, part of a hula backwards. It lands after "
        f"{rudi.landing_time():.2f} s with a tilt of {end.tilt:.3f} rad and twists fastest, "
        f"{rate:.1f} rad/s, at {when:.2f} s. Peak joint torques: "
        + ", ".join(f"{g} {t:.0f}" for g, t in peaks.items())
        + " N m. An athlete's hips give perhaps half of what ours ask for: swinging both legs to "
        "the side in a fifth of a second is faster than any athlete. The thesis prints no torques; "
        "ch6-gentle shows what bounded ones allow.",
        claims,
        _draw_6_1(),
        Table(
            ("joint", "peak torque N m"),
            tuple((str(n), f"{t:.0f}") for n, t in zip(names, torques, strict=True)),
        ),
        Motion({"the rudi": flight}, _SLOW, {"charts": True}),
    )  # fmt: skip


def _draw_6_1() -> Figure:
    from somersault.view import contact_sheet

    return contact_sheet(rudi.nominal(), np.linspace(0, rudi.landing_time(), 12), columns=6)


def fig_6_4() -> Result:
    """Prescribed joints."""
    flight = from_the_corner(None)
    e = error(flight)
    claims = (
        statement(
            "fig6-4.error", "§6.3.3, Figure 6-4", "with prescribed joints the body's landing "
            "attitude error is large", "large", f"e = {e:.2f}", e > _LARGE,
            f"Holds when e is above {_LARGE:g}. An error of 1.0 is large, says §6.3.2; a third of "
            "it is over 70° of twist.",
        ),
    )  # fmt: skip
    return Result(
        "Prescribed joints from tilt and twist of −0.1 rad: solid lines; the nominal dashed. "
        "Joints follow exactly, the landing attitude is far off.",
        f"e = {e:.2f}: {_off(flight)}. The film has the nominal flight as a ghost; figure 6-5 has "
        "both strategies side by side.", claims, _draw_worked(flight),
        motion=Motion(
            {"prescribed": flight}, _SLOW, {"charts": True, "ghosts": rudi.nominal()}
        ),
    )  # fmt: skip


def fig_6_5() -> Result:
    """Compliant joints."""
    flight = from_the_corner(_FREQUENCY)
    e, stiff, tracking = error(flight), error(from_the_corner(None)), _tracking(flight)
    claims = (
        statement(
            "fig6-5.error", "§6.3.3, Figure 6-5", "with ω_n = 30 the landing attitude closely "
            "follows that of the nominal case", "closely", f"e = {e:.2f}, {stiff / e:.1f} times "
            "less than with prescribed joints", e < _LARGE and stiff / e > _TIMES,
            f"Holds when e is below {_LARGE:g} and over {_TIMES:g} times less than with prescribed "
            "joints: better, though not landed in the sense of the maps (fig6-5.small).",
        ),
        statement(
            "fig6-5.small", "§6.3.3, Figure 6-5", "this start lands with a small error, as nearly "
            "half of them do", "closely", f"e = {e:.2f}", e < rudi.SMALL,
            f"Holds when e is below {rudi.SMALL:g}, which is what counts as landed in figures 6-2 "
            "and 6-3; the thesis gives no number. It is one corner of the grid, at which our "
            f"motion's valley is steep; {100 * rudi.error_map(_FREQUENCY).share:.0f} % of the "
            "grid's starts land below that at this frequency.",
        ),
        statement(
            "fig6-5.joints", "§6.3.3, Figure 6-5", "joint angles incur significant errors",
            "significant", f"up to {tracking.max():.2f} rad on the way",
            float(tracking.max()) > _SIGNIFICANT,
            f"Holds when some joint is off by more than {_SIGNIFICANT:g} rad on the way.",
        ),
    )  # fmt: skip
    return Result(
        "The same start with feed-forward torques and compliance of ω_n = 30 rad/s: joints err, "
        "the landing attitude is close to the nominal one.",
        f"e = {e:.2f}: {_off(flight)}. Below {rudi.SMALL:g} counts as landed in the maps, so this "
        "start does not, though it is far better off than with prescribed joints. Gains from the "
        "outboard inertias in mid-twist.",
        claims, _draw_worked(flight),
        motion=Motion(
            {"prescribed": from_the_corner(None), "compliant": flight, "nominal": rudi.nominal()},
            _SLOW,
        ),
    )  # fmt: skip


def _off(flight: Flight) -> str:
    wanted, end = rudi.nominal().landing, flight.landing
    return (
        f"somersault off by {np.degrees(end.somersault - wanted.somersault):+.0f}°, tilt by "
        f"{np.degrees(end.tilt - wanted.tilt):+.0f}°, twist by "
        f"{np.degrees(end.twist - wanted.twist):+.0f}°"
    )


def _tracking(flight: Flight) -> Array:
    """Largest deviation of each joint from its path, rad."""
    at = np.searchsorted(rudi.nominal().times, flight.times).clip(max=800)
    nominal = rudi.nominal().dataset["joint_angle"].values[at]
    return np.abs(flight.dataset["joint_angle"].values - nominal).max(0)


def _draw_worked(flight: Flight) -> Figure:
    from somersault.view import style as look

    picture = look.figure(7.2, 7.4)
    axes = picture.subplots(4, sharex=True)
    history, nominal = flight.dataset, rudi.nominal().dataset
    units = {"somersault": "turns", "tilt": "rad", "twist": "turns"}
    for ax, (name, unit) in zip(axes, units.items(), strict=False):
        by = 1 if name == "tilt" else 2 * np.pi
        ax.plot(nominal["time"], nominal[name] / by, "--", color=look.GREY, lw=1.2)
        ax.plot(history["time"], history[name] / by, color=look.BLUE)
        ax.set_ylabel(f"{name} ({unit})")
    for name, color in zip(_SHOWN, (look.BLUE, look.VERMILION, look.GREEN), strict=True):
        ax = axes[3]
        ax.plot(nominal["time"], nominal["joint_angle"].sel(joint=name), "--", color=color, lw=1.0)
        line = history["joint_angle"].sel(joint=name)
        ax.plot(history["time"], line, color=color, label=name.replace("_", " "))
    axes[3].legend(
        title=f"{len(_SHOWN)} of the {len(rudi.joint_names())} joints", title_fontsize=8,
        alignment="left", fontsize=8, frameon=False, loc="upper left", bbox_to_anchor=(1.0, 1.0),
    )  # fmt: skip
    axes[3].set(xlabel="time (s)", ylabel=f"{len(_SHOWN)} joint angles (rad)")
    axes[0].set_title("solid: from tilt and twist of −0.1 rad; dashed: the nominal flight")
    return picture
