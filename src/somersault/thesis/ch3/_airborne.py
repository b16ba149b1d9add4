"""Figures 3-6 and 3-7: from the flip to the landing, and what turns the body."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault.robot import Run
from somersault.thesis._claims import number, statement
from somersault.thesis._entries import Result
from somersault.thesis._motion import Motion
from somersault.thesis.ch3._measured import (
    between,
    between_times,
    degrees,
    excerpt,
    hip_rate,
    leg_length,
    lines,
)
from somersault.thesis.ch3._runs import FLIP, nominal, over_rotated

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def fig_3_6() -> Result:
    """The same somersault from flip to landing, and the tuck servo at work."""
    run = nominal()
    air, servo = between(run, "tuck", "landing compression"), between(run, "servo", "window")
    rate, hip = np.degrees(run.rates[:, 4]), hip_rate(run)
    wanted, leg = run.kept["servo_length"], leg_length(run)
    settled = servo[len(servo) // 2 :]
    error = run.kept["time_left"] - run.kept["turning_left"]
    begin = run.began("tuck")
    soon = between_times(run, begin + 0.005, begin + 0.06)
    change = np.corrcoef(rate[soon], hip[soon])[0, 1]
    started = float(rate[servo[0]])
    where = "§3.4, Figure 3-6"
    claims = (
        statement(
            "fig3-6.stance", where, "between flip and lift-off somersault rate, hip rate and leg "
            "length all increase in magnitude", "increase", *_growth(run),
        ),
        statement(
            "fig3-6.declines", where, "at lift-off the somersault rate declines rapidly as the "
            "legs are accelerated", "declines", f"from {rate[air[0]]:.0f} to "
            f"{rate[soon].min():.0f} deg/s within {1e3 * (0.06):.0f} ms",
            bool(rate[soon].min() < 0.75 * rate[air[0]]),
        ),
        statement(
            "fig3-6.symmetry", where, "momentum makes body rate and hip rate mirror images of "
            "each other", "mirrored", f"correlated by {change:.2f} while the hips swing",
            bool(change < -0.9),
        ),
        statement(
            "fig3-6.tuck", where, "meanwhile the legs are tucked as short as they can be", "tucked",
            f"{leg[servo[0]]:.3f} m as the servo begins", bool(leg[servo[0]] < 0.66),
        ),
        number(
            "fig3-6.rate", "Table 3.3, Figure 3-6", "somersault rate in flight; 503 to 553 deg/s "
            "in ten attempts", 537.0, started, "deg/s", 40.0, "As the tuck servo begins. The text "
            "has 606 deg/s for its figure.",
        ),
        statement(
            "fig3-6.slows", where, "the tuck servo extends the legs, and the rotation slows down",
            "606 to 463 deg/s", f"{started:.0f} to {rate[settled].mean():.0f} deg/s with legs from "
            f"{leg[servo[0]]:.3f} to {leg[settled].mean():.3f} m",
            bool(rate[settled].mean() < started - 10
                 and leg[settled].mean() > leg[servo[0]] + 0.02),
        ),
        statement(
            "fig3-6.by-inertia", "§3.3", "that is by as much as the inertia grows, at most to 81 %",
            "by inertia", *_by_inertia(run, servo[0], settled),
            "606 to 463 deg/s is 76 %, more than leg length alone can give.",
        ),
        statement(
            "fig3-6.meet", where, "then it is estimated to land at the desired attitude: the two "
            "times agree", "agree", f"{1e3 * error[servo[0]]:.0f} ms apart at first, "
            f"{1e3 * np.abs(error[settled]).max():.1f} ms later",
            bool(abs(error[servo[0]]) > 0.01 and np.abs(error[settled]).max() < 0.006),
        ),
        statement(
            "fig3-6.constant", "§3.3.1", "once reached, the desired leg length stays what it is",
            "stays", f"within {1e3 * np.ptp(wanted[settled]):.1f} mm over the second half",
            bool(np.ptp(wanted[settled]) < 0.01),
        ),
    )  # fmt: skip
    return Result(
        "Somersault angle, absolute somersault rate and relative hip rate, the times until "
        "touchdown and until the desired somersault attitude, and the leg's length.",
        f"The servo begins at {started:.0f} deg/s and settles at {rate[settled].mean():.0f} deg/s.",
        claims,
        _draw_air(run, all_four=True),
    )


def _growth(run: Run) -> tuple[str, bool]:
    """Magnitudes at the beginning of the flip's thrust and at lift-off."""
    a, b = (int(np.searchsorted(run.times, run.began(state))) for state in ("flip thrust", "tuck"))
    rows = [(np.degrees(run.rates[k, 4]), hip_rate(run)[k], leg_length(run)[k]) for k in (a, b)]
    rates, hips, lengths = zip(*rows, strict=True)
    words = (
        f"{rates[0]:.0f} to {rates[1]:.0f} deg/s, {hips[0]:.0f} to {hips[1]:.0f} deg/s, "
        f"{lengths[0]:.3f} to {lengths[1]:.3f} m"
    )
    return words, bool(
        rates[1] > rates[0] and abs(hips[1]) > abs(hips[0]) and lengths[1] > lengths[0]
    )


def _by_inertia(run: Run, first: int, settled: Array) -> tuple[str, bool]:
    machine = run.robot.machine
    lengths = leg_length(run)[first], float(leg_length(run)[settled].mean())
    inertias = [
        machine.inertia + machine.lower_leg * (length - machine.offset) ** 2 for length in lengths
    ]
    rates = float(run.rates[first, 4]), float(run.rates[settled, 4].mean())
    swing = np.radians(hip_rate(run)[first])
    legs = machine.leg_inertia + machine.lower_leg * (lengths[0] - machine.offset) ** 2
    momentum = inertias[0] * rates[0] + legs * swing
    expected = momentum / inertias[1]
    return (
        f"{rates[1] / rates[0]:.3f}; momentum and the inertia of {lengths[1]:.3f} m give "
        f"{expected / rates[0]:.3f}",
        bool(abs(rates[1] / expected - 1) < 0.02 and rates[1] / rates[0] > 0.8),
    )


def fig_3_7() -> Result:
    """A somersault that was over-rotating, and the feet swept forward to track the ground."""
    run = over_rotated()
    ours, end = degrees(run), int(np.searchsorted(run.times, run.began("landing compression"))) - 2
    sweep = between(run, "window", "landing compression")
    hip, rate = hip_rate(run), np.degrees(run.rates[:, 4])
    error = abs(ours["landing_inclination"] - ours["landing_wanted"])
    where = "§3.4, Figure 3-7"
    claims = (
        statement(
            "fig3-7.over", where, "it over-rotates: the desired attitude was 350°", "391°",
            f"{ours['landing_somersault']:.0f}°", ours["landing_somersault"] > 365,
        ),
        statement(
            "fig3-7.long", where, "although its legs are as long as they can be", "longest",
            f"{leg_length(run)[sweep[0]]:.3f} m", bool(leg_length(run)[sweep[0]] > 0.84),
        ),
        statement(
            "fig3-7.sweep", where, "the feet are swept forward quickly before landing", "quickly",
            f"hips at {hip[sweep].min():.0f} deg/s", bool(hip[sweep].min() < -300),
        ),
        statement(
            "fig3-7.faster", where, "which increases the somersault rate, as momentum is kept",
            "increases", f"from {rate[sweep[0]]:.0f} to {rate[end]:.0f} deg/s",
            bool(rate[end] > 1.1 * rate[sweep[0]]),
        ),
        number(
            "fig3-7.inclination", where, "the legs land much nearer to their desired inclination "
            "than the body to its attitude: error of the legs", 2.7, error, "deg", 3.0,
            f"−3.2° for −5.9°; ours {ours['landing_inclination']:.1f}° for "
            f"{ours['landing_wanted']:.1f}°, with the body "
            f"{ours['landing_somersault'] - 350:.0f}° off.",
        ),
        statement(
            "fig3-7.runs-on", where, "nearly successful", "supported by ropes for a moment",
            f"{int(run.outcome['steps_after'])} steps after it; {run.ended}",
            run.outcome["steps_after"] >= 3,
        ),
    )  # fmt: skip
    return Result(
        "A somersault that was over-rotating, so that the feet were swept forward at the end.",
        f"The flip's torque is 16 % too great. It lands at {ours['landing_somersault']:.0f}° with "
        f"legs inclined by {ours['landing_inclination']:.1f}°.",
        claims,
        _draw_air(run, all_four=False),
        motion=Motion(
            {"it over-rotates": excerpt(run, FLIP, FLIP + 4)}, 0.5,
            {"vectors": (), "camera": (70.0, 10.0)},
        ),
    )  # fmt: skip


def _draw_air(run: Run, all_four: bool) -> Figure:
    """From the flip to the landing; figure 3-7 has two of figure 3-6's four panels."""
    from somersault.view import style as look

    picture = look.figure(7.2, 7.0 if all_four else 4.2)
    axes = list(picture.subplots(4 if all_four else 2, sharex=True))
    first, last = run.began("flip compression") - 0.05, run.began("landing compression") + 0.05
    k = between_times(run, first, last)
    air = between(run, "tuck", "landing compression")
    t = run.times[k]
    rates, times = (axes[1], axes[2]) if all_four else axes
    rates.plot(t, np.degrees(run.rates[k, 4]), color=look.BLUE)
    rates.plot(t, hip_rate(run)[k], color=look.VERMILION, ls="--")
    rates.set_ylabel("body, hips (deg/s)")
    times.plot(run.times[air], run.kept["time_left"][air], color=look.BLUE)
    times.plot(run.times[air], run.kept["turning_left"][air], color=look.VERMILION, ls="--")
    times.set_ylabel("until touchdown,\nuntil attitude (s)")
    if all_four:
        axes[0].plot(t, np.degrees(run.angles[k, 0]), color=look.BLUE)
        axes[0].set_ylabel("somersault (°)")
        axes[3].plot(t, leg_length(run)[k], color=look.BLUE)
        axes[3].plot(t, run.kept["left_piston"][k], color=look.VERMILION, ls="--")
        axes[3].set_ylabel("leg, desired (m)")
    lines(run, axes, ("flip compression", "tuck", "servo", "landing compression"))
    axes[-1].set_xlabel("time (s)")
    return picture
