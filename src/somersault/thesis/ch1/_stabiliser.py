"""Yeadon's stabiliser of the layout (section 1.1.1): arms that move by what is sensed."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault.flight import Flight, JointTakeoff, Takeoff, fly
from somersault.stability import DelayedFeedback, LinearSpin, feedback, spin
from somersault.thesis._claims import number, statement
from somersault.thesis._entries import Result
from somersault.thesis._motion import Motion

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WHERE = "§1.1.1"
MODEL, ARMS, RATE = "furrer", 1.3, 8.64  # arm angle (rad) and somersault rate (rad/s) of ch. 4
MOVES = "antisymmetric shoulder"
TURN = 2 * np.pi  # of a somersault, in units of 1/Ω
_EVERY = 0.002  # s between ticks of the flights
# Gains by twist and twist rate (Ω, 1): of the flights, and nearly those for the longest delay.
QUICK, PATIENT = (-1.5, -1.5), (-0.76, -1.25)
_SECONDS = 3.0


@cache
def layout(arms: float = ARMS) -> LinearSpin:
    return spin(MODEL, 2, {"shoulder": arms}).linear()


def loop(twist: float = 0.0, twist_rate: float = 0.0, **more: float) -> DelayedFeedback:
    gains = {"twist": twist, "twist_rate": twist_rate, **more}
    return feedback(layout(), MOVES, "rate", gains)


def _growth(arms: float = ARMS) -> float:
    """Of the rigid layout, in units of Ω."""
    return spin(MODEL, 2, {"shoulder": arms}).linear(lock="all").growth_rate


def longest(arms: float = ARMS) -> float:
    """The longest delay, in somersaults, that any arm rate by twist and twist rate can have."""
    return float(np.sqrt(2) / _growth(arms) / TURN)


def moved(gains: tuple[float, float], every: float, ticks: int, **more: float) -> JointTakeoff:
    """Arms that move at a rate by twist and twist rate, so many ticks later."""
    twist, twist_rate = gains
    return JointTakeoff.rate_law(
        angle=ARMS, law="k * twist + c * twist_rate", every=every, delay=ticks * every,
        gains={"k": twist * RATE, "c": twist_rate}, **more,
    )  # fmt: skip


@cache
def _map() -> tuple[Array, Array, Array]:
    """Gains, and the longest stable delay in somersaults with each pair of them."""
    twist, rate = np.linspace(-2.5, 0.5, 61), np.linspace(-3.0, 0.5, 71)
    delays = np.zeros((len(rate), len(twist)))
    for i, c in enumerate(rate):
        for j, k in enumerate(twist):
            ranges = loop(float(k), float(c)).stable_delays(TURN)
            delays[i, j] = ranges[0][1] / TURN if ranges and ranges[0][0] == 0 else 0.0
    return twist, rate, delays


@cache
def _flown(delay: float, law: bool = True) -> Flight:
    """The layout with arms that move by the law after a delay (somersaults), or stay."""
    ticks = round(delay * TURN / RATE / _EVERY)
    arms = moved(QUICK, _EVERY, ticks) if law else JointTakeoff.locked(angle=ARMS)
    momentum = layout().spin.principal_inertias[1] * RATE
    takeoff = Takeoff(twist=0.01, angular_momentum=[0.0, momentum, 0.0], joints={"shoulder": arms})
    return fly(MODEL, takeoff, _SECONDS, samples=301)


def stabiliser() -> Result:
    """How late a law may act, and what it has to sense."""
    twist, rate, delays = _map()
    best = longest()
    by_twist = [loop(float(k)).stable_delays() for k in np.linspace(-5, 5, 201)]
    by_rate = [loop(0.0, float(c)).stable_delays() for c in np.linspace(-5, 5, 201)]
    arms = [longest(float(x)) for x in np.linspace(0.0, 1.6, 33)]
    limit = -(_growth() ** 2) / loop(1.0).polynomials[1][-1]
    ours = loop(*QUICK).stable_delays()[0][1] / TURN
    early, late, still = _flown(0.6 * ours), _flown(1.3 * ours), _flown(0.0, law=False)
    home, away = (
        [bool(loop(*QUICK, **{MOVES: sign * k}).stable_delays()) for k in (0.01, 0.03, 0.1)]
        for sign in (-1.0, 1.0)
    )
    claims = (
        number(
            "sec1-1.delay", _WHERE, "the athlete would have to respond within so much of a "
            "somersault", 0.28, best, "somersaults", 0.015,
            f"√2/σ, σ being the rigid layout's growth rate; {min(arms):.3f} to {max(arms):.3f} "
            "with the arms from 0 to 1.6 rad. The delay itself, not an approximation of it.",
        ),
        number(
            "sec1-1.time", _WHERE, "that is about 200 ms", 0.2, best * TURN / RATE, "s", 0.02,
            f"At {RATE} rad/s.",
        ),
        statement(
            "sec1-1.gains", _WHERE, "a controller of arm abduction rates could be used to "
            "stabilise rotation about the middle axis", "stabilises",
            f"{int((delays > 0).sum())} of {delays.size} pairs of gains on a grid do, the best "
            f"with a delay up to {delays.max():.3f} of a somersault", bool((delays > 0).any()),
            f"Arm rates by twist and twist rate; the gain by twist must be beyond {limit:.3f} Ω.",
        ),
        statement(
            "sec1-1.twist", _WHERE, "the sensed twist angle was the feedback signal for the arms' "
            "rates", "by the twist angle",
            f"{sum(map(bool, by_twist))} of {len(by_twist)} gains from −5 to 5 Ω stabilise with "
            "any delay", any(by_twist),
            "By the twist alone the layout is at best an undamped oscillator, and any delay "
            "makes it grow. The law has to know the twist rate too, as §7.4 has it.",
        ),
        statement(
            "sec7-4.rate", "§7.4", "the technique depended upon sensing the twist rate",
            "by the twist rate", f"{sum(map(bool, by_rate))} of {len(by_rate)} gains from −5 to 5 "
            "stabilise by it alone", any(by_rate),
            "By the twist rate alone one real root stays positive, whatever the gain. Both are "
            "needed.",
        ),
        statement(
            "sec1-1.flights", _WHERE, "it must respond within the delay in order to maintain "
            "stability", "within the delay",
            f"from a twist of 0.01 rad, in {_SECONDS:g} s: to {_end(early):.1e} rad at 0.6 of the "
            f"longest delay of these gains, to {_end(late):.2g} rad at 1.3 of it, to "
            f"{_end(still):.2g} rad without arms", _end(early) < 1e-3 < 0.1 < _end(late),
            "Flights of the whole equations, sampled five hundred times a second.",
        ),
        statement(
            "sec1-1.home", _WHERE, "a law that also pulls the arms back to where they were",
            "not said", f"stable with {sum(home)} of {len(home)} gains that pull them back, with "
            f"{sum(away)} of {len(away)} that push them away", not any(home) and any(away),
            "Ours, not the thesis's. As a cart under a pole must first go the wrong way, arms that "
            "are to come home have to be driven further out first.",
        ),
    )  # fmt: skip
    return Result(
        "Yeadon: arms driven by the sensed twist stabilise the layout if they respond within 0.28 "
        "of a somersault.",
        "Left: the longest delay with which arm rates by twist and twist rate stabilise Furrer's "
        f"layout (arms at {ARMS} rad); none is longer than √2/σ. Right: how fast a twist grows or "
        "decays as the delay becomes longer, and without a law.",
        claims,
        _draw(twist, rate, delays),
        motion=Motion({"acts in time": early, "acts too late": late, "arms still": still}, 0.3),
    )


def _end(flight: Flight) -> float:
    """The greatest twist in its last half second, rad."""
    return float(np.abs(flight.angles[flight.times > _SECONDS - 0.5, 2]).max())


def _draw(twist: Array, rate: Array, delays: Array) -> Figure:
    from somersault.view import style as look

    picture = look.figure(9.2, 4.4)
    ax, right = picture.subplots(1, 2, width_ratios=(1.15, 1))
    levels = [0.001, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3]
    from matplotlib.colors import LinearSegmentedColormap

    shades = LinearSegmentedColormap.from_list("delays", look.LIGHT_TO_DARK)
    filled = ax.contourf(twist, rate, delays, levels, cmap=shades)
    picture.colorbar(filled, ax=ax, label="longest delay, somersaults")
    laws = ((QUICK, look.VERMILION, "flown"), (PATIENT, look.GREEN, "patient"))
    for (k, c), color, words in laws:
        ax.plot(k, c, "o", color=color, mec="white")
        look.label(ax, k + 0.07, c, words, color)
    ax.set(xlabel="gain by twist, units of Ω", ylabel="gain by twist rate")
    ax.set_title("Arm rates by twist and twist rate")
    lags = np.linspace(0.005, 0.4, 80)
    for (k, c), color, words in laws:
        growth = [loop(k, c).growth_rate(float(x * TURN)) for x in lags]
        right.plot(lags, growth, color=color)
        look.label(right, lags[5], growth[5], words, color, va="bottom")
    right.axhline(0, color=look.GREY, lw=0.8)
    right.axhline(_growth(), color=look.BLACK, lw=1.2, ls="--")
    look.label(right, 0.01, _growth(), "arms still", look.BLACK, va="bottom")
    right.axvline(longest(), color=look.BLACK, lw=0.8, ls=":")
    look.label(right, longest() - 0.005, -0.5, "√2/σ", look.BLACK, ha="right")
    right.set(xlabel="delay, somersaults", ylabel="greatest growth rate, units of Ω")
    right.set_title("Growth of a small twist")
    return picture
