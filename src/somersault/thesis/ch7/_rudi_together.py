"""A rudi whose motion and compliance are designed together, within an athlete's torques (§7.5).

What was found is data (rudi_together.json), from examples/rudi_design.py: numbers of `flight.rudi`
and the natural frequencies of seven groups of joints, with ζ = 0.7 or with damping ratios chosen
too. The bounds of the torques are those of the gentle motion of chapter 6.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Literal

import numpy as np

from somersault._core.array import Array
from somersault.ensembles import Vary, ended_by, ensemble
from somersault.flight import Flight, Maneuver, Report, flights, rudi
from somersault.model import named_pose
from somersault.thesis._claims import Claim, statement
from somersault.thesis._entries import Result, Table
from somersault.thesis._motion import Motion
from somersault.thesis.ch6 import _rudi as kept
from somersault.thesis.ch7 import _rudi_momenta as momenta

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WHERE = "§6.3.3, 7.5"
_POINTS = 21  # a side: the starts of figure 6-3
_SIZE, _SEED = 1_024, 2
_STEPS = 3_000
_CORNER = -0.1  # rad of tilt and twist, the start of figures 6-4 and 6-5
_ENOUGH = 90.0  # % of the starts
_CLOSE = 0.03  # rad
Case = Literal["gentle", "fixed", "damped"]
_WORDS = {
    "gentle": "the gentle motion, its compliance chosen, ζ = 0.7",
    "fixed": "motion and compliance together, ζ = 0.7",
    "damped": "motion, compliance and damping together",
}

_SHORT = {
    "gentle": "gentle motion", "fixed": "together,\nζ = 0.7", "damped": "together,\nζ chosen",
}  # fmt: skip


def bounds() -> dict[str, float]:
    """The torques of an athlete, N m, by group of joints."""
    return kept.data("rudi_gentle")["bounds"]


@cache
def numbers(case: Case) -> dict[str, float]:
    """What was chosen, as `maneuver` in examples/rudi_design.py takes it."""
    text = (files("somersault.thesis.ch7") / "rudi_together.json").read_text(encoding="utf-8")
    return json.loads(text)[case]


def _is_gain(name: str) -> bool:
    return name.startswith(("frequency_", "damping_"))


@cache
def nominal(case: Case) -> Maneuver:
    """The motion itself, all joints prescribed."""
    moves = {name: x for name, x in numbers(case).items() if not _is_gain(name)}
    return rudi(kept.MODEL, **moves)


@cache
def soft(case: Case) -> Maneuver:
    """The motion of a body that gives way about it."""
    if case == "gentle":
        takeoff = momenta.soft("rudi_gentle", momenta.found("rudi_gentle", "fixed"), 1.0)
        return Maneuver(nominal("fixed").model, takeoff, kept.landing_time("rudi_gentle"))
    gains = {name: x for name, x in numbers(case).items() if _is_gain(name)}
    return nominal(case).compliant(*momenta.by_joint(gains), pose="wrap")


@cache
def landing(case: Case) -> Flight:
    """The nominal flight."""
    if case == "gentle":
        return kept.nominal("rudi_gentle")
    return nominal(case).fly(samples=801)


@dataclass(frozen=True, eq=False)
class Flown:
    """Errors (N,) of flights, NaN where one broke off, and the greatest torque in each as a part of
    an athlete's, by group, (N,) each."""

    errors: Array
    strain: dict[str, Array]

    @property
    def small(self) -> Array:
        """Which flights land with a small error."""
        return self.errors < kept.SMALL

    @property
    def able(self) -> Array:
        """Which flights stay within an athlete's torques."""
        return np.max(list(self.strain.values()), 0) <= 1

    @property
    def torques(self) -> dict[str, float]:
        """The greatest torque of each group in all of them, N m."""
        return {g: bounds()[g] * float(np.nanmax(x)) for g, x in self.strain.items()}

    @property
    def mean(self) -> float:
        """The mean error, rad; a flight that broke off counts as 1."""
        return momenta.mean_error(self.errors)


@cache
def flown(case: Case, over: Literal["figure", "others"]) -> Flown:
    """Flights from the starts of figure 6-3, or from others as far off; errors are those of
    section 6.3.2, against the motion's own nominal landing."""
    names = kept.joint_names()
    report = Report(("landing_error",), extremes=tuple(f"{name}_torque" for name in names))
    one = soft(case)
    runs = flights(
        one.model, one.takeoff, one.duration, report=report, against=landing(case), accuracy=1e-6,
        steps=_STEPS,
    )  # fmt: skip
    grid = {"from": -kept.SPAN, "to": kept.SPAN, "count": _POINTS}
    if over == "figure":
        vary = {
            f"takeoff_{n}": Vary(adds_to=f"takeoff.{n}", values=grid) for n in ("tilt", "twist")
        }
        data = ensemble(runs, vary=vary).dataset
    else:
        data = ensemble(
            runs, vary=momenta.scatter(), size=_SIZE, seed=_SEED, sequence="sobol"
        ).dataset
    good = ended_by(data["ended"], "duration").values.ravel()

    def strain(group: str) -> Array:
        return np.where(good, momenta.strongest(data, group).ravel() / bounds()[group], np.inf)

    errors = np.where(good, data["landing_error"].values.ravel(), np.nan)
    return Flown(errors, {group: strain(group) for group in bounds()})


def together() -> Result:
    """What the two designs reach, beside the gentle motion."""
    cases: tuple[Case, ...] = ("gentle", "fixed", "damped")
    figure = {case: flown(case, "figure") for case in cases}
    others = {case: flown(case, "others") for case in cases}
    return Result(
        "About half the starts of figure 6-3 land with small errors; the thesis says nothing of "
        "torques, and that its nominal motion was programmed by hand.",
        "Motion and compliance are searched for at once: twenty timings and amplitudes, and the "
        "natural frequencies (and damping ratios from 0.3 to 2) of seven groups of joints, for the "
        "least mean error against upright after one turn and one and a half twists, while no "
        "torque of any flight is beyond "
        + ", ".join(f"{group} {most:.0f}" for group, most in bounds().items())
        + " N m; each candidate has the motor tape of its own motion. The gentle motion of chapter "
        "6 leaves its compliance nothing: its hips are at the bound already when nothing is off.",
        (*_of_the_motion(), *_of_the_starts(figure, others)),
        _draw(figure),
        Table(
            (
                "design", "figure 6-3: below 0.1 (%)", "within the torques (%)", "both (%)",
                "1,024 others: below 0.1 (%)", "both (%)", "mean error (rad)",
                "greatest torques (N m)",
            ),
            tuple(_row(case, figure[case], others[case]) for case in cases),
        ),
        _films(),
    )  # fmt: skip


def _of_the_motion() -> tuple[Claim, ...]:
    end, flight = landing("fixed").landing, landing("fixed")
    out = named_pose(kept.MODEL, "T")
    off = max(
        abs(end.joints[name] - out.get(name.split("_", 1)[1], 0.0)) for name in kept.joint_names()
    )
    most = np.abs(flight.joint_torques.values).max(0)
    names = [str(name) for name in flight.joint_torques["joint_speed"].values]
    need = {g: max(t for n, t in zip(names, most, strict=True) if g in n) for g in bounds()}
    turns, twists = end.somersault / (2 * np.pi), abs(end.twist) / (2 * np.pi)
    return (
        statement(
            "together.lands", "§6.3.1", "it makes one somersault and one and a half twists, and "
            "finishes in layout with the arms straight out", "1 and 1½ turns, upright, arms out",
            f"{turns:.3f} and {twists:.3f} turns, tilt {end.tilt:.3f} rad, joints within "
            f"{off:.0e} rad",
            max(abs(turns - 1), abs(twists - 1.5)) < 0.01 and abs(end.tilt) < 0.05 and off < 1e-6,
            "The motion for ζ = 0.7. Holds with turns to 0.01, and less than 0.05 rad of tilt.",
        ),
        statement(
            "together.reserve", _WHERE, "it leaves its compliance some torque", "not said",
            "; ".join(f"{g} {t:.0f} of {bounds()[g]:.0f} N m" for g, t in need.items()),
            all(need[g] <= 0.95 * bounds()[g] for g in need),
            "Ours. Holds if nothing needs more than 95 % of its bound unless it is off nominal.",
        ),
    )  # fmt: skip


def _of_the_starts(figure: dict[Case, Flown], others: dict[Case, Flown]) -> tuple[Claim, ...]:
    fixed, damped, gentle = others["fixed"], others["damped"], figure["gentle"]
    drawn = momenta.percent(fixed.small & fixed.able)
    return (
        statement(
            "together.figure", _WHERE, "of the starts of figure 6-3 nine in ten land with e < 0.1 "
            "within an athlete's torques, with ζ = 0.7", "nearly half, torques not said",
            f"{_percent(figure['fixed'].small & figure['fixed'].able):.1f} % of "
            f"{figure['fixed'].errors.size}; by the error alone "
            f"{_percent(figure['fixed'].small):.1f} %, by the torques alone "
            f"{_percent(figure['fixed'].able):.1f} %",
            _percent(figure["fixed"].small & figure["fixed"].able) >= _ENOUGH,
            f"Ours. Holds from {_ENOUGH:g} %.",
        ),
        statement(
            "together.others", _WHERE, "and so of starts that the search has not seen", "not said",
            f"{drawn[0]:.1f} % ({drawn[1]:.1f} to {drawn[2]:.1f}) of {_SIZE:,}, mean error "
            f"{fixed.mean:.3f} rad; at most "
            + ", ".join(f"{group} {most:.0f}" for group, most in fixed.torques.items()) + " N m",
            drawn[1] >= _ENOUGH, f"Ours. Holds if the whole interval is above {_ENOUGH:g} %.",
        ),
        statement(
            "together.damped", _WHERE, "with damping chosen too the mean error is 0.03 rad or "
            "less, within the torques", "not said",
            f"mean error {damped.mean:.4f} rad; {_percent(damped.small & damped.able):.1f} % land "
            "with e < 0.1 within the torques; at most "
            + ", ".join(f"{group} {most:.0f}" for group, most in damped.torques.items()) + " N m",
            damped.mean <= _CLOSE and _percent(damped.small & damped.able) >= _ENOUGH,
            f"Ours. ζ may be 0.3 to 2. Holds with {_ENOUGH:g} % within the torques.",
        ),
        statement(
            "together.hips", _WHERE, "the gentle motion, whose compliance alone was chosen, is not "
            "kept from that by its errors but by its hips", "not said",
            f"{_percent(gentle.small):.1f} % of the starts of figure 6-3 land with e < 0.1, and "
            f"{_percent(gentle.able):.1f} % stay within the torques; hips up to "
            f"{gentle.torques['hip']:.0f} of {bounds()['hip']:.0f} N m",
            _percent(gentle.small) >= _ENOUGH
            and _percent(gentle.able) < _ENOUGH
            and all(gentle.torques[g] <= bounds()[g] for g in bounds() if g != "hip"),
            "Ours. Holds if enough land, too few within the torques, and the hips alone are beyond "
            "theirs.",
        ),
    )  # fmt: skip


def _percent(good: Array) -> float:
    return 100 * float(good.mean())


def _row(case: Case, figure: Flown, others: Flown) -> tuple[str, ...]:
    return (
        _WORDS[case], f"{_percent(figure.small):.1f}", f"{_percent(figure.able):.1f}",
        f"{_percent(figure.small & figure.able):.1f}", f"{_percent(others.small):.1f}",
        f"{_percent(others.small & others.able):.1f}", f"{others.mean:.4f}",
        ", ".join(f"{group} {most:.0f}" for group, most in others.torques.items()),
    )  # fmt: skip


def _films() -> Motion:
    """From the corner of figures 6-4 and 6-5: joints that follow exactly, and that give way."""
    off = {"tilt": _CORNER, "twist": _CORNER}
    return Motion(
        {
            "nominal": landing("fixed"),
            "off, followed exactly": nominal("fixed").off_nominal(**off).fly(samples=201),
            "off, compliant": soft("fixed").off_nominal(**off).fly(samples=201),
        },
        0.3,
    )


def _draw(figure: dict[Case, Flown]) -> Figure:
    from somersault.view import style as look

    picture = look.figure(11.4, 3.9)
    at, left, right = picture.subplots(1, 3)
    starts = np.linspace(-kept.SPAN, kept.SPAN, _POINTS)
    error = figure["fixed"].errors.reshape(_POINTS, _POINTS)
    shown = at.pcolormesh(
        starts, starts, error.T, cmap=look.darkening(), vmin=0, vmax=0.15, shading="nearest"
    )
    at.contour(
        starts, starts, np.nan_to_num(error.T, nan=9.0), levels=[kept.SMALL],
        colors=[look.VERMILION], linewidths=1.6,
    )  # fmt: skip
    at.set(xlabel="tilt at takeoff (rad)", ylabel="twist at takeoff (rad)")
    at.set_title("together, ζ = 0.7")
    picture.colorbar(shown, ax=at, extend="max").set_label("landing error e (orange: 0.1)")
    colors = (look.GREY, look.BLUE, look.GREEN)
    for (case, one), color in zip(figure.items(), colors, strict=True):
        share = 100 * np.arange(1, one.errors.size + 1) / one.errors.size
        left.plot(
            np.sort(np.nan_to_num(one.errors, nan=9.0)), share, color=color, label=_SHORT[case]
        )
        worst = np.sort(np.max(list(one.strain.values()), 0))
        right.plot(100 * worst, share, color=color)
    left.axvline(kept.SMALL, color=look.BLACK, lw=0.8, ls="--")
    left.set(xlabel="landing error (rad)", ylabel="starts of figure 6-3 below (%)", xlim=(0, 0.2))
    right.axvline(100, color=look.BLACK, lw=0.8, ls="--")
    right.set(xlabel="greatest torque (% of an athlete's)", ylabel="starts below (%)")
    left.legend(fontsize=8, frameon=False, loc="lower right")
    return picture
