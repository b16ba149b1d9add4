"""The layout somersault held by springs, by a law, and by both (section 7.4)."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault.ensembles import Vary, ended_by, ensemble, fraction
from somersault.flight import Flight, JointTakeoff, Takeoff, flights, fly
from somersault.stability import DelayedFeedback, LinearSpin, feedback
from somersault.thesis._claims import statement
from somersault.thesis._entries import Result, Table
from somersault.thesis._motion import Motion
from somersault.thesis.ch1._stabiliser import (
    ARMS,
    MODEL,
    MOVES,
    PATIENT,
    QUICK,
    RATE,
    TURN,
    layout,
    longest,
    loop,
    moved,
)

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_WHERE = "§7.4"
STIFFNESS, DAMPING = 1.2, 0.13  # K_sh and B_sh; the damper is figure 4-7's 0.1 kg m²
SOMERSAULT = TURN / RATE  # s
TICKS = 36  # in a somersault
EVERY = SOMERSAULT / TICKS
MANY = 10  # somersaults
_SIZE, _SEED, _SCATTER = 200, 4, 0.03  # starts, and the deviation of tilt and twist, rad
FASTEST = 10.0  # rad/s of arms that a law alone moves
HELD = -0.1, -0.2  # torques of each arm by the twist, kg m² Ω²


def sprung(gain: float, ticks: int, damping: float = DAMPING) -> JointTakeoff:
    """Arms on springs and dampers, with a torque by the twist."""
    return JointTakeoff.torque_law(
        angle=ARMS, K=STIFFNESS, B=damping, hold=True, law="k * twist", every=EVERY,
        delay=ticks * EVERY, gains={"k": gain * RATE**2},
    )  # fmt: skip


def _cases() -> dict[str, JointTakeoff]:
    return {
        "rigid": JointTakeoff.locked(angle=ARMS),
        "passive": JointTakeoff.sprung(angle=ARMS, K=STIFFNESS, hold=True),
        "passive, damped": JointTakeoff.sprung(angle=ARMS, K=STIFFNESS, B=DAMPING, hold=True),
        "active, 2/36 late": moved(QUICK, EVERY, 2, most_rate=FASTEST),
        "active, 8/36 late": moved(PATIENT, EVERY, 8, most_rate=FASTEST),
        "both, 2/36 late": sprung(HELD[0], 2),
        "both, 8/36 late": sprung(HELD[1], 8),
        "both, 12/36 late": sprung(HELD[1], 12),
    }


@cache
def _lives() -> dict[str, xr.Dataset]:
    """What became of the same starts in each case, until a quarter twist."""
    vary = {
        f"takeoff_{name}": Vary(sets=f"takeoff.{name}", normal=[0.0, _SCATTER])
        for name in ("tilt", "twist")
    }
    found = {}
    for name, arms in _cases().items():
        takeoff = Takeoff(spin=RATE, joints={"shoulder": arms})
        one = flights(MODEL, takeoff, MANY * SOMERSAULT, report=["twist"], until="quarter twist")
        found[name] = ensemble(one, vary=vary, size=_SIZE, seed=_SEED).dataset
    return found


def _layout(stiffness: float, damping: float = 0.0) -> LinearSpin:
    return layout().spin.linear({"shoulder": stiffness}, {"shoulder": damping})


def held(gain: float, damping: float = DAMPING) -> DelayedFeedback:
    """The sprung and damped layout with a torque by the twist."""
    return feedback(_layout(STIFFNESS, damping), MOVES, "torque", {"twist": gain})


def _arms_over_twist() -> tuple[Array, Array]:
    """The arms' angle over the twist, complex, in the oscillations of the passive and of the active
    layout."""
    part = _layout(STIFFNESS).subsystem("tilt")
    names = part.coordinates
    passive = [
        mode.shape[names.index(MOVES)] / mode.shape[names.index("twist")]
        for mode in part.modes
        if mode.name != "stroboscopic" and mode.root.imag > 0
    ]
    late, (k, c) = 2 * TURN / TICKS, QUICK
    roots = loop(*QUICK).roots(late, 4)
    active = [(k + c * s) * np.exp(-s * late) / s for s in roots if 0.1 < s.imag < 3]
    return np.array(passive), np.array(active)


def passive_and_active() -> Result:
    """The same starts, held by springs, by a law, and by both."""
    lives = _lives()
    share = {name: _share(data) for name, data in lives.items()}
    damped = [held(gain).stable_delays(2 * TURN) for gain in HELD]
    alone = longest()
    latest = max(
        (ranges[0][1] / TURN, gain)
        for gain in np.linspace(-0.4, -0.01, 40)
        if (ranges := held(float(gain)).stable_delays(2 * TURN))
    )
    passive, active = _arms_over_twist()
    ahead = [np.degrees(np.angle(x)) for x in (passive, active)]
    claims = (
        statement(
            "sec7-4.same", _WHERE, "the active controller used the same control effect as the "
            "passive strategy: arm tilt to control twist", "the same",
            f"arms lead the twist by {_listed(ahead[0])}° passively and by {_listed(ahead[1])}° "
            f"actively, {_listed(np.abs(passive), 1)} and {_listed(np.abs(active), 1)} times as "
            "far", bool(np.all(np.abs(np.concatenate(ahead) - 90) < 30)),
            "Holds if both are within 30° of a quarter of a swing. In the oscillations of small "
            "motions.",
        ),
        statement(
            "sec7-4.subset", _WHERE, "passive dynamic control is a subset of active controllers "
            "that need little computation", "a subset",
            "a torque law that senses the arm's own angle without delay is the spring: roots "
            f"differ by {_as_spring():.0e} Ω", _as_spring() < 1e-6,
        ),
        statement(
            "sec7-4.alone", _WHERE, "which is the more reliable, the passive or the active one",
            "not said", f"of {_SIZE} starts within {_SCATTER} rad (standard deviation) ten "
            f"somersaults last {percent(share['passive'])} passively, "
            f"{percent(share['active, 2/36 late'])} actively with {2000 * EVERY:.0f} ms of "
            f"delay, "
            f"{percent(share['active, 8/36 late'])} with {8000 * EVERY:.0f} ms",
            share["active, 2/36 late"] > share["passive"] > share["active, 8/36 late"],
            "Ours. Holds if a quick law does better than springs, and one as late as people are "
            "does worse.",
        ),
        statement(
            "sec7-4.damping", "§4.3.2, 7.4", "damped shoulders destroy the passive stability",
            "destroy", f"{percent(share['passive, damped'])} last ten somersaults, undamped "
            f"{percent(share['passive'])}",
            share["passive, damped"] < 0.5 * share["passive"],
            f"B_sh = {DAMPING}.",
        ),
        statement(
            "sec7-4.cheapest", _WHERE, "the cheapest feedback that makes damped shoulders stable",
            "not said", f"a torque of −{-HELD[0]:g} kg m² Ω² times the twist of each arm, which "
            f"makes {HELD[0] * RATE**2:.1f} N m/rad: stable with delays "
            + " and ".join(_range(r) for r in damped[0]), bool(damped[0]),
            "Ours. The twist angle alone is sensed, by which no law holds arms without springs.",
        ),
        statement(
            "sec7-4.late", _WHERE, "a law on sprung and damped arms may act later than any law "
            "could alone", "not said",
            f"up to {latest[0]:.2f} of a somersault with a gain of {latest[1]:.2f} kg m² Ω², "
            f"{alone:.2f} alone", latest[0] > 1.5 * alone,
            "Ours. Springs make the slow oscillation, dampers take from one mode and give to the "
            "other, and a late torque by the twist is the damper that the other one lacks.",
        ),
        statement(
            "sec7-4.both", _WHERE, "both together", "not said",
            f"{percent(share['both, 2/36 late'])} last with {2000 * EVERY:.0f} ms of delay, "
            f"{percent(share['both, 8/36 late'])} with {8000 * EVERY:.0f} ms and "
            f"{percent(share['both, 12/36 late'])} with {12000 * EVERY:.0f} ms",
            min(share["both, 8/36 late"], share["both, 12/36 late"]) > share["passive"],
            "Ours. Holds if even the late ones last more often than springs alone.",
        ),
    )  # fmt: skip
    return Result(
        "The thesis compares an active and a passive layout in words.",
        f"The same {_SIZE} starts in Furrer's layout with the arms at {ARMS} rad, until a quarter "
        f"twist or {MANY} somersaults. Left: how many still go on. Right: growth of small "
        "motions with the delay of the law.",
        claims,
        _draw(lives),
        table=_table(lives, share),
        motion=Motion(_shown(), 0.3),
    )


def _as_spring() -> float:
    """How far the roots of a spring and of a torque by the arm's own angle are apart, Ω."""
    sprung = _layout(STIFFNESS)
    arm = sprung.coordinates.index(MOVES)
    gain = -sprung.K_springs[arm, arm] / 2  # of each arm
    law = feedback(layout(), MOVES, "torque", {MOVES: gain}).roots(0.0)
    springs = feedback(sprung, MOVES, "torque", {"twist": 0.0}).roots(0.0)
    return float(max(np.abs(springs - root).min() for root in law))


def _shown() -> dict[str, Flight]:
    """Flights from one start of four cases."""
    names = {
        "rigid": "rigid", "passive": "passive, damped", "active": "active, 8/36 late",
        "both": "both, 8/36 late",
    }  # fmt: skip
    cases = _cases()
    return {
        title: fly(
            MODEL, Takeoff(spin=RATE, tilt=0.03, twist=0.03, joints={"shoulder": cases[name]}),
            5 * SOMERSAULT, samples=361,
        )
        for title, name in names.items()
    }  # fmt: skip


def _share(data: xr.Dataset) -> float:
    return float(fraction(ended_by(data["ended"], "duration"), data["ended"])["fraction"])


def percent(share: float) -> str:
    return f"{100 * share:.0f} %"


def _listed(values: Array, digits: int = 0) -> str:
    return " and ".join(f"{x:.{digits}f}" for x in values)


def _range(ends: tuple[float, float]) -> str:
    return f"from {ends[0] / TURN:.2f} to {ends[1] / TURN:.2f} somersaults"


def _table(lives: dict[str, xr.Dataset], share: dict[str, float]) -> Table:
    rows = []
    for name, data in lives.items():
        interval = fraction(ended_by(data["ended"], "duration"), data["ended"])
        turns = data["time"].values / SOMERSAULT
        rows.append((
            name, f"{100 * share[name]:.0f}",
            f"{100 * float(interval['low']):.0f} to {100 * float(interval['high']):.0f}",
            f"{np.nanmedian(turns):.2f}",
        ))  # fmt: skip
    header = ("arms", "last ten somersaults (%)", "95 % confidence", "median life (somersaults)")
    return Table(header, tuple(rows))


def _draw(lives: dict[str, xr.Dataset]) -> Figure:
    from somersault.view import style as look

    picture = look.figure(9.2, 4.4)
    ax, right = picture.subplots(1, 2, width_ratios=(1.15, 1))
    colors = (
        look.BLACK, look.BLUE, look.SKY, look.VERMILION, look.ORANGE, look.GREEN, look.PURPLE,
        look.YELLOW,
    )  # fmt: skip
    for (name, data), color in zip(lives.items(), colors, strict=True):
        turns = np.sort(data["time"].values / SOMERSAULT)
        left = 100 * (1 - np.arange(len(turns)) / len(turns))
        ax.step([0, *turns], [100, *left], where="post", color=color, label=name)
    ax.legend(fontsize=8, loc="center", bbox_to_anchor=(0.56, 0.33), edgecolor="none")
    ax.set(xlabel="somersaults", ylabel="still without a quarter twist, %", xlim=(0, MANY))
    ax.set_title(f"{_SIZE} starts, tilt and twist ± {_SCATTER} rad")
    lags = np.linspace(0.005, 0.7, 70)
    both = ((HELD[0], look.GREEN, "both, −0.1", 0.56), (HELD[1], look.PURPLE, "both, −0.2", 0.3))
    for gain, color, words, at in both:
        growth = [held(gain).growth_rate(float(x * TURN)) for x in lags]
        right.plot(lags, growth, color=color)
        look.label(right, at, growth[round(at / 0.01)] - 0.01, words, color, va="top")
    laws = ((QUICK, look.VERMILION, "quick"), (PATIENT, look.ORANGE, "patient"))
    for gains, color, words in laws:
        growth = [loop(*gains).growth_rate(float(x * TURN)) for x in lags]
        right.plot(lags, growth, color=color)
        look.label(right, lags[26], growth[26], f"active, {words}", color, va="bottom")
    right.axhline(0, color=look.GREY, lw=0.8)
    right.set(xlabel="delay, somersaults", ylabel="greatest growth rate, units of Ω")
    right.set_title("Small motions")
    return picture
