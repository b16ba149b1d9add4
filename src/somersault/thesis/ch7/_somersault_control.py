"""A law of the somersault on top of what holds the twist of a layout (section 7.2)."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault.ensembles import Vary, ensemble, fraction
from somersault.flight import Flight, JointTakeoff, Report, Takeoff, flights, fly
from somersault.stability import feedback, spin
from somersault.thesis._claims import Claim, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis._motion import Motion
from somersault.thesis.ch1._stabiliser import ARMS, MODEL, MOVES, QUICK, RATE, TURN, layout

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_WHERE = "§7.2"
_STIFFNESS = 1.0  # K_sh, near the middle of what is stable for arms from 0.9 to 1.7 rad
_SOMERSAULT = TURN / RATE  # s
_TICKS, _LATE = 36, 2  # in a somersault, and how many of them a law is late
_EVERY = _SOMERSAULT / _TICKS
_DAMPING, _HOLDS = 0.13, -0.15  # B_sh, and a torque by the twist (kg m² Ω²), of both together,
_PERSONS = 8  # whose law is as late as people are
_MANY, _LANDING = 10, 3  # somersaults: of the longest flights, and until a landing
_SIZE, _SEED = 400, 4
_SCATTER, _SPIN = 0.03, 0.05  # deviation of tilt and twist (rad); spin is up to so much off

_RIGHT = 0.2  # rad: a somersault that is right
_AHEAD = "a * (somersault - pace * time)"
_TOGETHER = "('left_shoulder{0}' - 'right_shoulder{0}') / 2"
# Of arms on springs: a torque by how far the somersault is ahead, and a damper of what the arms do
# alike. Of driven arms: a rate towards an angle by the same.
_PUSHED = f"clip({_AHEAD}, -most, most) - d * {_TOGETHER.format('_rate')}"
_PUSHES = {"a": 4.0, "d": 2.0, "most": 4.0, "pace": RATE}
_TWIST = "k * twist + c * twist_rate"
_TWISTS = {"k": QUICK[0] * RATE, "c": QUICK[1]}
_LED = f"w * (arms + clip({_AHEAD}, -0.55, 0.6) - {_TOGETHER.format('')})"
_LEADS = {"a": 4.0, "w": 5.0, "arms": ARMS, "pace": RATE}

_STILL, _SPRUNG, _SPRUNG_TOO = "still", "springs", "springs + somersault law"
_BOTH, _BOTH_TOO = "both, late", "both + somersault law, late"
_ACTIVE, _ACTIVE_TOO = "twist law", "twist + somersault law"


def _outboard() -> float:
    return layout().spin.outboard_inertias["left_shoulder"]


def _springs() -> dict[str, float]:
    """Springs that hold the arms in the spin that is meant, whatever the spin of a start is."""
    holding = layout().spin.holding_torques["left_shoulder"] * RATE**2
    stiffness = _STIFFNESS * _outboard() * RATE**2
    return {"angle": ARMS, "stiffness": stiffness, "rest": ARMS, "pretension": holding}


def _cases() -> dict[str, JointTakeoff]:
    late = {"every": _EVERY, "delay": _LATE * _EVERY}
    sprung = _springs()
    led = {"angle": ARMS, "most_rate": 10.0, **late}
    damping = _DAMPING * _outboard() * RATE
    both = {**sprung, "damping": damping, "every": _EVERY, "delay": _PERSONS * _EVERY}
    gain = {"k": _HOLDS * RATE**2}
    return {
        _STILL: JointTakeoff.locked(angle=ARMS),
        _SPRUNG: JointTakeoff.sprung(**sprung),
        _SPRUNG_TOO: JointTakeoff.torque_law(law=_PUSHED, gains=_PUSHES, **sprung, **late),
        _BOTH: JointTakeoff.torque_law(law="k * twist", gains=gain, **both),
        _BOTH_TOO: JointTakeoff.torque_law(
            law=f"k * twist + {_PUSHED}", gains={**gain, **_PUSHES}, **both
        ),
        _ACTIVE: JointTakeoff.rate_law(law=_TWIST, gains=_TWISTS, **led),
        _ACTIVE_TOO: JointTakeoff.rate_law(
            law=f"{_TWIST} + {_LED}", gains={**_TWISTS, **_LEADS}, **led
        ),
    }


def _flown(arms: JointTakeoff) -> xr.Dataset:
    """What became of the starts, the same for all: until a quarter twist, with the somersault at
    the end of each one that was meant."""
    vary = {
        f"takeoff_{name}": Vary(sets=f"takeoff.{name}", normal=[0.0, _SCATTER])
        for name in ("tilt", "twist")
    }
    ends = [(1 - _SPIN) * RATE, (1 + _SPIN) * RATE]
    vary["spin"] = Vary(sets="takeoff.spin", uniform=ends)
    report = Report(("twist",), history=("somersault",), samples=_MANY + 1)
    one = flights(
        MODEL, Takeoff(spin=RATE, joints={"shoulder": arms}), _MANY * _SOMERSAULT, report=report,
        until="quarter twist",
    )  # fmt: skip
    return ensemble(one, vary=vary, size=_SIZE, seed=_SEED).dataset


@cache
def _all() -> dict[str, xr.Dataset]:
    return {name: _flown(arms) for name, arms in _cases().items()}


def _errors(data: xr.Dataset) -> Array:
    """How far the somersault is ahead at the end of each one that was meant, (starts, 11), rad."""
    meant = TURN * np.arange(_MANY + 1)
    return np.asarray(data["somersault_history"].values - meant)


def _lasted(data: xr.Dataset, somersaults: float = _MANY) -> Array:
    return np.asarray(data["time"].values > (somersaults - 1e-6) * _SOMERSAULT)


def _rms(errors: Array) -> float:
    return float(np.sqrt(np.nanmean(errors**2)))


def _right(data: xr.Dataset) -> Array:
    """Which land right: without a quarter twist, and with the somersault that was meant."""
    return _lasted(data, _LANDING) & (np.abs(_errors(data)[:, _LANDING]) < _RIGHT)


def _coupling() -> float:
    """The greatest number that couples symmetric and asymmetric motion in the linear equations, as
    a part of the greatest of all."""
    linear = layout()
    alike = np.array([n in ("somersault", "symmetric shoulder") for n in linear.coordinates])
    between = alike[:, None] != alike
    matrices = (linear.M, linear.G, linear.D, linear.K)
    return max(np.abs(m[between]).max() for m in matrices) / max(np.abs(m).max() for m in matrices)


def _end(arms: str, tilt: float, off: float) -> Array:
    """Somersault and twist after one somersault, rad."""
    takeoff = Takeoff(spin=(1 + off) * RATE, tilt=tilt, joints={"shoulder": _cases()[arms]})
    flight = fly(MODEL, takeoff, _SOMERSAULT, accuracy=1e-12, samples=2)
    return np.asarray(flight.angles[-1, [0, 2]])


def _disturbed(tilt: float = 1e-3, off: float = 5e-4) -> tuple[float, float]:
    """By what power of the tilt the somersault is disturbed, and by what power of the spin's error
    the moves against that disturb the twist for each bit of it."""
    somersault, twist = [], []
    for part in (1.0, 0.5):
        by_tilt = _end(_SPRUNG_TOO, part * tilt, off) - _end(_SPRUNG_TOO, 0.0, off)
        by_moves = _end(_SPRUNG_TOO, tilt, part * off) - _end(_SPRUNG, tilt, part * off)
        somersault.append(abs(by_tilt[0]))
        twist.append(abs(by_moves[1]))
    return float(np.log2(somersault[0] / somersault[1])), float(np.log2(twist[0] / twist[1]))


@cache
def _angles() -> tuple[float, float]:
    """Between which angles of the arms small motions decay with both, rad."""
    angles = np.linspace(0.6, 2.2, 161)
    held = []
    for arms in angles:
        linear = spin(MODEL, 2, {"shoulder": float(arms)}).linear(
            {"shoulder": _STIFFNESS}, {"shoulder": _DAMPING}
        )
        # A sampled torque holds until the next tick, and so is later by half of one.
        delay = (_PERSONS + 0.5) / _TICKS * TURN
        law = feedback(linear, MOVES, "torque", {"twist": _HOLDS})
        held.append(law.growth_rate(delay) < 0)
    good = angles[held]
    return float(good.min()), float(good.max())


def _balanced(arms: float) -> float:
    """What error of the spin arms at an angle balance, as a part of it."""
    inertia = [spin(MODEL, 2, {"shoulder": x}).principal_inertias[1] for x in (arms, ARMS)]
    return float(inertia[0] / inertia[1] - 1)


def _superposed(alone: str, too: str, called: str, words: str) -> Claim:
    """Whether a law of the somersault goes with what holds the twist, until a landing."""
    found = _all()
    kept, landed = (_lasted(found[name], _LANDING) for name in (alone, too))
    before, after = (_share(_right(found[name])) for name in (alone, too))
    return statement(
        f"sec7-2.{called}", _WHERE, "a somersault control strategy and a tilt-twist control "
        f"strategy could be superposed, until a landing after {_LANDING} somersaults: {words}",
        "superposed",
        f"{_words(after)} % have no quarter twist and a somersault within {_RIGHT} rad, "
        f"{_words(before)} % without the somersault's law; {_percent(landed)} have no quarter "
        f"twist, {_percent(kept)} without that law",
        after["low"] > before["high"] and kept.mean() - landed.mean() < 0.02,
        "Holds if more of the same starts land right (intervals of 95 % are apart), and fewer than "
        "one in fifty are lost to a quarter twist.",
    )  # fmt: skip


def somersault_control() -> Result:
    """Does a law of the somersault go with springs, or a law, that hold the twist?"""
    found = _all()
    errors = {name: _errors(data) for name, data in found.items()}
    pairs = {_SPRUNG: _SPRUNG_TOO, _BOTH: _BOTH_TOO, _ACTIVE: _ACTIVE_TOO}
    lasted = {name: _lasted(data) for name, data in found.items()}
    (low, high), off = _angles(), found[_SPRUNG_TOO]["spin"].values / RATE - 1
    least, most = _balanced(low), _balanced(high)
    within = (off > least) & (off < most)
    landed = _lasted(found[_SPRUNG], _LANDING)
    by_springs, rigid = errors[_SPRUNG][landed, _LANDING], off[landed] * _LANDING * TURN
    by_tilt, by_moves = _disturbed()
    claims = (
        statement(
            "sec7-2.decoupled", _WHERE, "the tilt, twist and asymmetric arm movement are decoupled "
            "from the somersault and symmetric arm movement", "decoupled",
            f"the greatest number between them in the linear equations is {_coupling():g}; in "
            f"flights the somersault is disturbed by the tilt to the power of {by_tilt:.2f}, and "
            "the twist by the moves against an error of the spin, for a given tilt, in proportion "
            f"to that error to the power of {by_moves:.2f}",
            _coupling() < 1e-9 and abs(by_tilt - 2) < 0.1 and abs(by_moves - 1) < 0.1,
            "Holds if what the one does to the other is a product of two small numbers. Powers "
            "from halves: flights of one somersault from 0.001 rad of tilt and a spin 0.05 % off.",
        ),
        _superposed(_SPRUNG, _SPRUNG_TOO, "springs", "springs hold the twist"),
        _superposed(
            _BOTH, _BOTH_TOO, "both", "damped springs hold it with a torque by the twist, and all "
            f"laws are {1000 * _PERSONS * _EVERY:.0f} ms late",
        ),
        _superposed(_ACTIVE, _ACTIVE_TOO, "law", "a law holds the twist"),
        statement(
            "sec7-2.lasting", _WHERE, f"the same for {_MANY} somersaults", "superposed",
            "; ".join(
                f"{name}: {_percent(lasted[name])} last, {_percent(lasted[too])} with the "
                "somersault's law"
                for name, too in pairs.items()
            ),
            all(lasted[name].mean() - lasted[too].mean() < 0.05 for name, too in pairs.items()),
            "On springs more last, with both fewer: arms that balance a slow spin come "
            f"nearer to the body than the {low:.2f} rad from which on both hold the twist. A law "
            "of the twist goes with the somersault's for as long.",
        ),
        statement(
            "sec7-2.reach", _WHERE, "what both lose they lose where arms are led to where they do "
            "not hold the twist", "not said",
            f"small motions decay with arms from {low:.2f} to {high:.2f} rad, which balance spins "
            f"that are {_off(least)} to {_off(most)} off; of the starts within, "
            f"{_percent(lasted[_BOTH_TOO][within])} last {_MANY} somersaults, of the others "
            f"{_percent(lasted[_BOTH_TOO][~within])} (without the somersault's law "
            f"{_percent(lasted[_BOTH][within])} and {_percent(lasted[_BOTH][~within])})",
            _share(lasted[_BOTH_TOO][within])["low"] > _share(lasted[_BOTH_TOO][~within])["high"],
            "Ours. Angles by linear stability, balance by the inertia about the somersault axis "
            "alone. Holds if intervals of 95 % are apart.",
        ),
        statement(
            "sec7-2.passive", _WHERE, "springs alone", "not said",
            f"the somersault's error after {_LANDING} is {_rms(by_springs):.2f} rad (rms) where it "
            f"would be {_rms(rigid):.2f} with arms that stay, in the {len(rigid)} starts that last",
            _rms(by_springs) < 0.75 * _rms(rigid),
            "Ours. A faster spin flings the arms out, which makes it slower. Springs and their "
            "pretension are those for the spin that is meant.",
        ),
    )  # fmt: skip
    return Result(
        "Control of the somersault of a layout was left open; it was thought that it could be "
        "superposed on control of tilt and twist.",
        f"{_SIZE} starts, the same in each case: tilt and twist ± {_SCATTER} rad, spin up to "
        f"{100 * _SPIN:g} % off. Arms that move alike, by how far the somersault is ahead of what "
        f"was meant; laws are {1000 * _LATE * _EVERY:.0f} ms late, with both "
        f"{1000 * _PERSONS * _EVERY:.0f} ms. Left: the somersault's error of those that have no "
        "quarter twist; what is right is shaded. Middle: how many go on. Right: which of those "
        "with both; between the dashes arms stay where both hold the twist.",
        claims,
        _draw(found, errors, pairs, off, (least, most)),
        table=_table(found),
        motion=Motion(_shown(), 0.3),
    )


def _share(good: Array) -> dict[str, float]:
    """The share of those that are good, with its interval of 95 %."""
    import xarray as xr

    found = fraction(xr.DataArray(good, dims="sample"))
    return {name: float(found[name]) for name in ("fraction", "low", "high")}


def _percent(good: Array) -> str:
    return f"{100 * good.mean():.3g} %"


def _off(part: float) -> str:
    return f"{100 * part:+.1f} %".replace("-", "−")


def _shown() -> dict[str, Flight]:
    """Flights from one start, that turns too slowly."""
    cases = _cases()
    names = (_SPRUNG, _SPRUNG_TOO, _BOTH_TOO, _ACTIVE_TOO)
    return {
        name: fly(
            MODEL,
            Takeoff(spin=0.97 * RATE, tilt=0.03, twist=0.03, joints={"shoulder": cases[name]}),
            4 * _SOMERSAULT, samples=289,
        )
        for name in names
    }  # fmt: skip


def _table(found: dict[str, xr.Dataset]) -> Table:
    rows = []
    for name, data in found.items():
        shares = (_right(data), _lasted(data, _LANDING), _lasted(data))
        rows.append((name, *(_words(_share(good)) for good in shares)))
    header = (
        "arms", f"land right after {_LANDING} somersaults (%, interval of 95 %)",
        "without a quarter twist then", f"after {_MANY}",
    )  # fmt: skip
    return Table(header, tuple(rows))


def _words(share: dict[str, float]) -> str:
    percent = {name: f"{100 * x:.0f}" for name, x in share.items()}
    return f"{percent['fraction']} ({percent['low']} to {percent['high']})"


def _draw(
    found: dict[str, xr.Dataset],
    errors: dict[str, Array],
    pairs: dict[str, str],
    off: Array,
    balanced: tuple[float, float],
) -> Figure:
    from somersault.view import style as look

    picture = look.figure(11.0, 3.9)
    left, middle, right = picture.subplots(1, 3)
    colors = (
        look.BLACK, look.SKY, look.BLUE, look.YELLOW, look.GREEN, look.ORANGE, look.VERMILION,
    )  # fmt: skip
    shown = dict(zip(found, colors, strict=True))
    for name, color in shown.items():
        if name in (_SPRUNG, *pairs.values()):
            error = np.where(_lasted(found[name], _LANDING), errors[name][:, _LANDING], np.nan)
            left.plot(100 * off, error, ".", color=color, ms=4)
        times = np.linspace(0, _MANY, 501)
        going = [100 * _lasted(found[name], t).mean() for t in times]
        middle.plot(times, going, color=color, label=name)
    ends = 100 * _SPIN * np.array([-1, 1])
    left.plot(ends, ends / 100 * _LANDING * TURN, color=look.BLACK)
    look.label(left, ends[1] - 0.3, 0.9, "arms that stay", look.BLACK, ha="right", va="bottom")
    left.axhspan(-_RIGHT, _RIGHT, color=look.GREY, alpha=0.15, lw=0)
    left.set(xlabel="error of the spin, %", ylabel=f"somersault's error after {_LANDING}, rad")
    left.set_title("Too early, too late")
    middle.set(xlabel="somersaults", ylabel="still without a quarter twist, %", xlim=(0, _MANY))
    middle.set(ylim=(-2, 104))
    middle.legend(fontsize=8, loc="lower left", bbox_to_anchor=(0.22, 0.08), edgecolor="none")
    middle.set_title("Held in twist")
    for name, marker in ((_BOTH, "."), (_BOTH_TOO, "x")):
        turns = found[name]["time"].values / _SOMERSAULT
        right.plot(100 * off, turns, marker, color=shown[name], ms=4, ls="", label=name)
    for edge in balanced:
        right.axvline(100 * edge, color=look.GREY, lw=1, ls="--")
    right.set(xlabel="error of the spin, %", ylabel="somersaults until a quarter twist")
    right.set(ylim=(0, _MANY + 0.5))
    right.set_title("Lives with both")
    return picture
