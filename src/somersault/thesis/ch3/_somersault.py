"""Figures 3-2 and 3-5 and Table 3.2: a somersault from the approach to running on."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault.robot import Run
from somersault.thesis._claims import number, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis._motion import Motion
from somersault.thesis.ch3._measured import (
    apart,
    between,
    between_times,
    both,
    excerpt,
    lines,
    touched,
)
from somersault.thesis.ch3._runs import FLIP, nominal

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SHOWN = (0.0, 0.15, 0.33, 0.66, 0.80, 1.02)  # s, as the photographs of figure 3-2
_STANCE = ("flip compression", "flip thrust")
_EVENTS = ("flip compression", "tuck", "landing compression")
_G = 9.81


def fig_3_2() -> Result:
    """A somersault as a sequence of pictures."""
    from somersault.view import contact_sheet

    run = nominal()
    first = run.began("flip compression") + 0.06
    times = [first + t for t in _SHOWN]
    return Result(
        "Photographs of the robot at 0, 0.15, 0.33, 0.66, 0.80 and 1.02 s of a somersault.",
        "The simulated robot at the same times from the middle of the flip step on, seen from its "
        "left.",
        (),
        contact_sheet(run, times, columns=6, view=(90.0, 6.0)),
        motion=Motion(
            {"the somersault": excerpt(run, FLIP, FLIP + 4)}, 0.5,
            {"vectors": (), "camera": (70.0, 10.0)},
        ),
    )  # fmt: skip


def table_3_2() -> Result:
    """The control summary, and when each of its states was."""
    run = nominal()
    begun = {e.state: e.time for e in reversed(run.events)}
    order = [s for s in begun if s not in ("flight", "compression", "thrust")]
    order.sort(key=begun.__getitem__)
    hurdle = between(run, "hurdle", "flip compression")
    ordinary = between_times(run, 1.0, FLIP)
    hops = [float(run.sensed[k, 2].max()) for k in (ordinary, hurdle)]
    pitch = np.degrees(run.angles[:, 0])
    stance = between(run, "hurdle compression", "hurdle")
    feet = apart(run)
    down = [touched(run, side, run.began("flip compression") - 0.01) for side in (0, 1)]
    landed = [touched(run, side, run.began("landing compression") - 0.01) for side in (0, 1)]
    where = "§3.4, Table 3.2"
    early = slice(None, int(np.searchsorted(run.times, FLIP)))
    claims = (
        number(
            "table3-2.approach", where, "it approaches at about 1 m/s", 1.0,
            float(run.speed[run.times < FLIP][-2000:].mean()), "m/s", 0.15,
        ),
        statement(
            "table3-2.hop", where, "in the hurdle it hops with increased thrust", "higher",
            f"centre of mass up to {hops[1]:.2f} m, otherwise {hops[0]:.2f} m",
            hops[1] > hops[0] + 0.1,
        ),
        statement(
            "table3-2.pitch-up", where, "it pitches up slightly in the hurdle", "slightly",
            f"from {pitch[stance][0]:.1f}° to {pitch[stance][-1]:.1f}° in its stance",
            bool(-20 < pitch[stance][-1] < pitch[stance][0]),
        ),
        statement(
            "table3-2.both", where, "the flip step is a stance on both feet", "both feet",
            f"they touch down {1e3 * abs(down[0] - down[1]):.0f} ms apart, "
            f"{feet[between(run, *_STANCE)].mean():.2f} m from one another, otherwise the feet "
            "take turns", bool(abs(down[0] - down[1]) < 0.02 and not both(run)[early].any()),
        ),
        statement(
            "table3-2.landing-both", where, "it lands on both feet simultaneously", "at once",
            f"{1e3 * abs(landed[0] - landed[1]):.0f} ms apart", abs(landed[0] - landed[1]) < 0.02,
        ),
        statement(
            "table3-2.rate", where, "in the landing the somersault rate goes back to zero", "zero",
            _rates_around_landing(run)[1], _rates_around_landing(run)[0],
        ),
        statement(
            "table3-2.following", where, "it resumes running with alternating gait", "resumes",
            f"{int(run.outcome['steps_after'])} steps after it, at "
            f"{run.speed[run.times > run.times[-1] - 3].mean():.2f} m/s, and {run.ended}",
            bool(not run.fell and run.outcome["steps_after"] >= 15),
        ),
    )  # fmt: skip
    rows = tuple((state, f"{begun[state]:.3f}") for state in order)
    return Result(
        "Approach, hurdle, flip, landing and following, and what the controller does in each.",
        "The states of the controller in the nominal somersault, and when each begins. Each ends "
        "on a condition of what is sensed.",
        claims,
        table=Table(("state", "begins (s)"), rows),
    )


def _rates_around_landing(run: Run) -> tuple[bool, str]:
    before = np.degrees(run.outcome["landing_rate"])
    k = int(np.searchsorted(run.times, run.began("landing hop") + 0.01))
    after = float(np.degrees(run.rates[k, 4]))
    return abs(after) < 0.2 * before, f"from {before:.0f} to {after:.0f} deg/s in its stance"


def fig_3_5() -> Result:
    """Approach, flip, landing and running on."""
    run = nominal()
    lift = run.outcome
    air = between(run, "tuck", "landing compression")
    tilt = np.degrees(run.angles[air, 1])
    window = run.kept["time_left"][air][-1]
    after = (run.times > run.began("landing hop") + 1.0) & (run.times < run.times[-1])
    where = "§3.4, Figure 3-5"
    claims = (
        number(
            "fig3-5.attitude", where, "the nominal desired landing attitude is 350°, and it lands "
            "there", 350.0, float(np.degrees(lift["landing_somersault"])), "deg", 5.0,
            "The printed one lands at 325°, with an error in its landing time of 0.08 s.",
        ),
        number(
            "fig3-5.time", "§3.2, Figure 3-5", "it is in the air for about 0.7 s", 0.7,
            lift["flight_time"], "s", 0.06,
        ),
        number(
            "fig3-5.flight-time", "eq. 3.1", "the time of flight is that of a parabola from "
            "lift-off speed and the heights of the centre of mass", _parabola(run),
            lift["flight_time"], "s", 0.012, "Predicted from the state at lift-off and touchdown.",
        ),
        number(
            "fig3-5.early", where, "landing error in time, where nothing is sensed wrong", 0.0,
            float(window), "s", 0.015, "The printed somersault lands 0.080 s early.",
        ),
        statement(
            "fig3-5.tilt", where, "the oscillation in tilt does not grow in flight", "does not "
            "grow", f"between {tilt.min():.1f} and {tilt.max():.1f}°", _bounded(tilt),
        ),
        statement(
            "fig3-5.speed", where, "after the landing forward speed and posture are restored",
            "restored", f"{run.speed[after].mean():.2f} m/s, body within "
            f"{np.abs(np.degrees(run.angles[after, 0]) - 360).max():.0f}° of upright",
            bool(abs(run.speed[after].mean() - 1) < 0.2
                 and np.abs(np.degrees(run.angles[after, 0]) - 360).max() < 15),
        ),
    )  # fmt: skip
    return Result(
        "Hip height, somersault and tilt angles, and forward speed of the 3D Biped during a "
        "somersault; lines at the initiation of the flip, lift-off and landing.",
        f"The simulated robot lifts off with {lift['lift_off_speed']:.2f} m/s and lands at "
        f"{np.degrees(lift['landing_somersault']):.0f}° after {lift['flight_time']:.3f} s.",
        claims,
        _draw_3_5(run),
    )


def _bounded(tilt: Array) -> bool:
    """Whether a tilt is no greater in the second half of a flight than at most in the first, but
    for a degree, and small."""
    half = len(tilt) // 2
    return bool(np.abs(tilt[half:]).max() < np.abs(tilt[:half]).max() + 2 and np.ptp(tilt) < 30)


def _parabola(run: Run) -> float:
    """Equation 3.1 for the run's lift-off and the height at which it landed, s."""
    speed = run.outcome["lift_off_speed"]
    heights = [
        float(run.sensed[np.searchsorted(run.times, run.began(state)), 2])
        for state in ("tuck", "landing compression")
    ]
    return float((speed + np.sqrt(speed**2 + 2 * _G * (heights[0] - heights[1]))) / _G)


def _draw_3_5(run: Run) -> Figure:
    from somersault.view import style as look

    picture = look.figure(7.2, 6.4)
    axes = list(picture.subplots(4, sharex=True))
    shown = run.times < FLIP + 6
    t = run.times[shown]
    for ax, values, words in zip(
        axes,
        (
            run.positions[:, 2],
            np.degrees(run.angles[:, 0]),
            np.degrees(run.angles[:, 1]),
            run.speed,
        ),
        ("hip height (m)", "somersault (°)", "tilt (°)", "speed (m/s)"),
        strict=True,
    ):
        ax.plot(t, values[shown], color=look.BLUE)
        ax.set_ylabel(words)
    lines(run, axes, _EVENTS)
    axes[-1].set_xlabel("time (s)")
    return picture
