"""The rudi with a replay rate that perceived errors adjust (section 7.3)."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultWarning
from somersault.ensembles import Vary, ensemble
from somersault.flight import (
    Flight,
    Replay,
    Takeoff,
    flights,
    fly,
    landing_error,
    landing_target,
    off_nominal,
)
from somersault.thesis._claims import statement
from somersault.thesis._entries import Result, Table
from somersault.thesis._motion import Motion
from somersault.thesis.ch6 import _rudi as rudi

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

_WHERE = "§7.3"
_ERRORS = ("somersault", "tilt", "twist", "somersault_rate", "tilt_rate", "twist_rate")
_DELAYS = (0.0, 0.1, 0.2)  # s
_LATE = _DELAYS[-1]
_OF_ANGLES = (0.15, 0.3, 0.6, 1.2, 2.4)  # gains of either sign that are tried, 1/rad,
_OF_RATES = (0.02, 0.04, 0.08, 0.16, 0.32)  # and s/rad
_TRIED, _HELD_OUT = 64, 400  # starts
_SEED, _OTHER_SEED = 5, 6
_STEPS, _ACCURACY = 3000, 1e-6  # as in chapter 6
_NOISE = {"": 0.03, "_rate": 0.3}  # rad and rad/s, standard deviations
_MOMENTUM = 0.03  # of it, a standard deviation
_SURE = 1.96  # standard errors of 95 %
_MENDED, _OF_FIGURE_6_5 = (rudi.SPAN, -rudi.SPAN), (-rudi.SPAN, -rudi.SPAN)  # tilt, twist
_BODIES = {"compliant": rudi.THEIRS, "prescribed": None}


@dataclass(frozen=True)
class _Choice:
    """A law with one gain, and the share of the tried starts that it lands."""

    error: str
    gain: float
    share: float


def _replay(delay: float, gains: Mapping[str, float], noisy: bool = False) -> Replay:
    """A rate of 1 and a gain times each of the errors, which share their equations."""
    law = " + ".join(["1", *(f"k_{name} * {name}_error" for name in _ERRORS)])
    noise = {f"{name}_error": _NOISE["_rate" if name.endswith("_rate") else ""] for name in _ERRORS}
    return Replay(
        law=law, gains={f"k_{name}": gains.get(name, 0.0) for name in _ERRORS}, delay=delay,
        noise=noise if noisy else {},
    )  # fmt: skip


def _starts(spun: bool = False) -> dict[str, Vary]:
    """The scatter of figure 6-3; where they are `spun` with another momentum too."""
    vary = {
        f"takeoff_{name}": Vary(adds_to=f"takeoff.{name}", uniform=[-rudi.SPAN, rudi.SPAN])
        for name in ("tilt", "twist")
    }
    if spun:
        h = rudi.nominal_takeoff().angular_momentum
        assert h is not None
        of = {f"takeoff.angular_momentum.{k + 1}": x for k, x in enumerate(h)}
        greatest = max(of, key=lambda name: abs(of[name]))
        vary["momentum"] = Vary(adds_to=greatest, normal=[0.0, _MOMENTUM], scale=of[greatest])
    return vary


def _landed(
    body: str, replay: Replay | None, vary: Mapping[str, Vary], size: int, seed: int
) -> xr.DataArray:
    """Landing errors, infinite where a flight failed."""
    takeoff = replace(rudi.strategy(_BODIES[body]), replay=replay)
    runs = flights(
        rudi.MODEL, takeoff, rudi.landing_time(), report=["landing_error"],
        against=rudi.nominal(), accuracy=_ACCURACY, steps=_STEPS,
    )  # fmt: skip
    with warnings.catch_warnings():  # of flights that broke off, which count as not landed
        warnings.simplefilter("ignore", SomersaultWarning)
        found = ensemble(runs, vary=vary, size=size, seed=seed, sequence="sobol")
    return found.dataset["landing_error"].fillna(np.inf)


@cache
def _tried(body: str, delay: float, spun: bool = False) -> tuple[_Choice, ...]:
    """The best gain of each error: the one that lands most starts, and of those that land as many
    the smallest."""
    best = []
    for error in _ERRORS:
        sizes = _OF_RATES if error.endswith("_rate") else _OF_ANGLES
        gains = sorted([*sizes, *(-x for x in sizes)], key=abs)
        vary = {**_starts(spun), "gain": Vary(sets=f"replay.gains.k_{error}", values=gains)}
        errors = _landed(body, _replay(delay, {}), vary, _TRIED, _SEED)
        shares = (errors < rudi.SMALL).mean("sample").values
        k = int(shares.argmax())
        best.append(_Choice(error, gains[k], float(shares[k])))
    return tuple(best)


def _best(body: str, delay: float, spun: bool = False) -> _Choice:
    return max(_tried(body, delay, spun), key=lambda one: one.share)


@cache
def _held_out(body: str, delay: float | None, noisy: bool = False, spun: bool = False) -> Array:
    """Landing errors of other starts, the same for all, with the best law of a delay or none."""
    replay = None
    if delay is not None:
        best = _best(body, delay, spun)
        replay = _replay(delay, {best.error: best.gain}, noisy)
    vary = _starts(spun)
    if noisy:
        vary["senses"] = Vary(sets="takeoff.noise", uniform=[0.0, 1.0])
    return _landed(body, replay, vary, _HELD_OUT, _OTHER_SEED).values


def _more(one: Array, other: Array) -> tuple[float, float]:
    """By how much more of the same starts land small with one than with another, and the half
    width of its 95 % interval."""
    by = (one < rudi.SMALL).astype(float) - (other < rudi.SMALL)
    return float(by.mean()), float(_SURE * by.std(ddof=1) / np.sqrt(len(by)))


def replay_rate() -> Result:
    """Which perceived error, with which gain and delay, lands more rudis."""
    soft, stiff = _held_out("compliant", None), _held_out("prescribed", None)
    quick, late = (_held_out("compliant", delay) for delay in (_DELAYS[0], _LATE))
    noisy = _held_out("compliant", _LATE, noisy=True)
    spun = [_held_out("compliant", delay, spun=True) for delay in (None, _LATE)]
    alone = max((_held_out("prescribed", d) for d in _DELAYS), key=_share)
    tail = [float(np.quantile(errors, 0.95)) for errors in (soft, late)]
    claims = (
        statement(
            "sec7-3.adds", _WHERE, "a controller of the replay rate could further improve the "
            "reliability of the compliant maneuver", "perhaps",
            f"{_count(quick)} starts land below {rudi.SMALL:g}, "
            f"{_count(soft)} without: {_by(quick, soft)}. The rate is "
            f"{_law(_best('compliant', _DELAYS[0]))}", _surely(quick, soft),
            "Holds if the interval is above 0. The gain was chosen by other starts.",
        ),
        statement(
            "sec7-3.late", _WHERE, "it also does when it acts as late as people react", "not said",
            f"{1000 * _LATE:.0f} ms late {_percent(_share(late))} land, {_by(late, soft)}, by "
            f"{_law(_best('compliant', _LATE))}", _surely(late, soft),
            "Ours. Holds if the interval is above 0.",
        ),
        statement(
            "sec7-3.noisy", _WHERE, "it also does when errors are perceived with noise",
            "not said", f"{1000 * _LATE:.0f} ms late, with {_NOISE['']:g} rad and "
            f"{_NOISE['_rate']:g} rad/s (standard deviations) {_percent(_share(noisy))} land, "
            f"{_by(noisy, soft)}", _surely(noisy, soft), "Ours. Holds if the interval is above 0.",
        ),
        statement(
            "sec7-3.region", _WHERE, "could it improve reliability where landings were seriously "
            "degraded", "a question",
            f"of the starts that land with more than {rudi.SMALL:g} without it, "
            f"{_percent(float((late[soft >= rudi.SMALL] < rudi.SMALL).mean()))} land below it with "
            f"the law that is {1000 * _LATE:.0f} ms late, and "
            f"{_percent(float((late[soft < rudi.SMALL] >= rudi.SMALL).mean()))} of the others no "
            f"longer; 95 % land below {tail[1]:.2f} instead of {tail[0]:.2f}",
            bool(tail[1] < tail[0]) and bool((late[soft >= rudi.SMALL] < rudi.SMALL).mean() > 0.5),
            "Holds if it lands most of them, and 95 % of all starts land with a smaller error.",
        ),
        statement(
            "sec7-3.timing", _WHERE, "a law of the replay rate gets the timing right where the "
            "body spins faster or slower", "the timing 'right'",
            f"with the momentum off by {_percent(_MOMENTUM)} too (standard deviation) "
            f"{_percent(_share(spun[1]))} land instead of {_percent(_share(spun[0]))}, "
            f"{_by(spun[1], spun[0])}, {1000 * _LATE:.0f} ms late, by "
            f"{_law(_best('compliant', _LATE, spun=True))}", _surely(spun[1], spun[0]),
            "Ours. Holds if the interval is above 0. The gain was chosen by such starts. Most is "
            "out of its reach: the moment of landing is given, and how far the body turns until "
            "then goes with its momentum.",
        ),
        statement(
            "sec7-3.instead", _WHERE, "it complements the passive dynamics, and does not replace "
            "them", "complement", f"with prescribed joints it lands {_percent(_share(alone))}, at "
            f"the best of the delays, {_percent(_share(stiff))} without it; compliance alone lands "
            f"{_percent(_share(soft))}", _surely(soft, alone) and _surely(alone, stiff),
            "Holds if it improves prescribed joints, and compliance alone lands more than that.",
        ),
    )  # fmt: skip
    return Result(
        "Perhaps a simple active controller that changed the replay rate of a set of pre-recorded "
        "actions based on perceived errors could get the timing right to further improve "
        "reliability.",
        f"The rudi of chapter 6, compliant at {rudi.THEIRS:g} rad/s and prescribed, from tilts and "
        f"twists within {rudi.SPAN:g} rad. Fifty times a second the replay rate is 1 plus a gain "
        "times one error against the nominal flight at the same phase, between 0.5 and 2. Left: "
        f"the best of {2 * len(_OF_ANGLES)} gains by {_TRIED} starts. Right: {_HELD_OUT} other "
        f"starts. {1000 * _LATE:.0f} ms late, not all is mended. {_from_corners()}",
        claims,
        _draw(),
        table=_table(),
        motion=Motion(_from(*_MENDED), 0.3),
    )


def _surely(one: Array, other: Array) -> bool:
    by, half = _more(one, other)
    return by - half > 0


def _share(errors: Array) -> float:
    return float((errors < rudi.SMALL).mean())


def _count(errors: Array) -> str:
    return f"{int((errors < rudi.SMALL).sum())} of {len(errors)}"


def _by(one: Array, other: Array) -> str:
    by, half = _more(one, other)
    return f"{100 * (by - half):.0f} to {100 * (by + half):.0f} points more"


def _percent(share: float) -> str:
    return f"{100 * share:.0f} %"


def _law(choice: _Choice) -> str:
    unit = "s/rad" if choice.error.endswith("_rate") else "1/rad"
    sign = "−" if choice.gain < 0 else "+"
    return f"1 {sign} {abs(choice.gain):g} {unit} × {_words(choice.error)} error"


def _words(error: str) -> str:
    return error.replace("_", " ")


def _table() -> Table:
    rows = []
    for body in _BODIES:
        without = _held_out(body, None)
        rows.append((body, "none", "", f"{100 * _share(without):.0f}", ""))
        for delay in _DELAYS:
            errors = _held_out(body, delay)
            rows.append((
                body, _law(_best(body, delay)), f"{1000 * delay:.0f}",
                f"{100 * _share(errors):.0f}", _by(errors, without),
            ))  # fmt: skip
    header = ("joints", "replay rate", "delay (ms)", "land below 0.1 (%)", "95 % confidence")
    return Table(header, tuple(rows))


@cache
def _from(tilt: float, twist: float) -> dict[str, Flight]:
    """Compliant flights from a corner of the starts, without a law and with the late one."""
    best = _best("compliant", _LATE)
    laws = {"compliant": None, "with a replay rate": _replay(_LATE, {best.error: best.gain})}
    flown = {}
    for name, replay in laws.items():
        takeoff: Takeoff = replace(rudi.strategy(rudi.THEIRS), replay=replay)
        off = off_nominal(rudi.MODEL, takeoff, tilt=tilt, twist=twist)
        flown[name] = fly(rudi.MODEL, off, rudi.landing_time(), samples=161, accuracy=1e-8)
    return flown


def _from_corners() -> str:
    """What becomes of two corners."""
    words = []
    for tilt, twist in (_MENDED, _OF_FIGURE_6_5):
        without, with_law = (
            landing_error(landing_target(rudi.nominal()), landing_target(flight))
            for flight in _from(tilt, twist).values()
        )
        words.append(f"from ({tilt:g}, {twist:g}) e is {with_law:.2f} instead of {without:.2f}")
    text = f"In tilt and twist (rad), {words[0]}, as the film shows, and {words[1]}."
    return text.replace("-", "−")


def _draw() -> Figure:
    from somersault.view import style as look

    picture = look.figure(9.2, 4.4)
    left, right = picture.subplots(1, 2, width_ratios=(1.15, 1))
    colors = (look.BLUE, look.GREEN, look.ORANGE)
    for k, (delay, color) in enumerate(zip(_DELAYS, colors, strict=True)):
        shares = [one.share for one in _tried("compliant", delay)]
        at = np.arange(len(_ERRORS)) + 0.27 * (k - 1)
        words = f"{1000 * delay:.0f} ms late"
        left.bar(at, [100 * x for x in shares], 0.25, color=color, label=words)
    without = _landed("compliant", None, _starts(), _TRIED, _SEED)
    level = 100 * _share(without.values)
    left.axhline(level, color=look.BLACK, lw=1.2, ls="--", label="no law")
    names = [_words(error).replace(" ", "\n") for error in _ERRORS]
    left.set_xticks(range(len(names)), names, fontsize=8)
    left.set(ylim=(0, 128), ylabel=f"starts that land below {rudi.SMALL:g}, %")
    left.set_yticks(range(0, 101, 20))
    left.legend(ncols=2, loc="upper center", edgecolor="none", fontsize=8)
    left.set_title("Compliant: the error that the law perceives")
    helped = max(_DELAYS, key=lambda delay: _share(_held_out("prescribed", delay)))
    curves: tuple[tuple[str, float | None, str, str], ...] = (
        ("prescribed", None, look.GREY, "prescribed"),
        ("prescribed", helped, look.PURPLE, f"prescribed, {1000 * helped:.0f} ms late"),
        ("compliant", None, look.BLACK, "compliant"),
        *(
            ("compliant", d, c, f"compliant, {1000 * d:.0f} ms late")
            for d, c in zip(_DELAYS, colors, strict=True)
        ),
    )  # fmt: skip
    for body, late, color, words in curves:
        errors = np.sort(_held_out(body, late))
        percent = 100 * np.arange(1, len(errors) + 1) / len(errors)
        landed = np.isfinite(errors)
        right.step(errors[landed], percent[landed], where="post", color=color, label=words)
    right.axvline(rudi.SMALL, color=look.GREY, lw=0.8, ls=":")
    right.set(xlim=(0, 0.4), ylim=(0, 102), xlabel="landing error e", ylabel="starts below it, %")
    right.legend(fontsize=7.5, loc="lower right", edgecolor="none", handlelength=1.2)
    right.set_title(f"{_HELD_OUT} other starts")
    return picture
