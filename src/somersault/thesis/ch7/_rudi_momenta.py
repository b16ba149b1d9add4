"""One compliance of the rudi for all its angular momenta (sections 6.3.3, 7.5).

What was found is data (rudi_momenta.json), from scripts/rudi_momenta.py: the natural frequencies of
seven groups of joints, with ζ = 0.7 or with damping ratios chosen too, for the least landing errors
over starts at h, 0.9 h and 1.1 h, each against that momentum's own unperturbed landing; and for the
gentle motion at 0.9 h alone ("slow"), with ζ = 0.7.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Literal

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.ensembles import Vary, ended_by, ensemble, fraction
from somersault.flight import Flight, Maneuver, Report, Takeoff, compliant, flights
from somersault.model import load
from somersault.thesis._claims import Claim, statement
from somersault.thesis.ch6 import _rudi as rudi

if TYPE_CHECKING:
    import xarray as xr

FACTORS = (1.0, 0.9, 1.1)  # of the nominal angular momentum
GROUPS = ("shoulder", "elbow", "hip", "torso")
_WHERE = "§6.3.3, 7.5"
_SIZE, _SEED = 512, 2
_STEPS = 3_000
_RATIO = 0.7
_ENOUGH, _LEAST = 95.0, 0.03  # % of flights with a small error; rad of mean error
Case = Literal["fixed", "damped", "slow"]


def scatter(span: float = rudi.SPAN) -> dict[str, Vary]:
    """Tilt and twist at takeoff, as in figure 6-2."""
    return {
        f"takeoff_{name}": Vary(adds_to=f"takeoff.{name}", uniform=[-span, span])
        for name in ("tilt", "twist")
    }


def soft(kept: rudi.Kept, gains: dict[str, float], factor: float) -> Takeoff:
    """The compliant takeoff at a momentum, of natural frequencies and damping ratios by group."""
    takeoff = compliant(
        rudi.MODEL, rudi.nominal_takeoff(kept), *by_joint(gains), pose=rudi.twist_rate(kept)[1]
    )
    return rudi.scaled(takeoff, factor)


def by_joint(gains: Mapping[str, float]) -> tuple[dict[str, float], dict[str, float] | float]:
    """Natural frequencies and damping ratios as `compliant` takes them, of "frequency_hip" …"""
    by: dict[str, dict[str, float]] = {"frequency": {}, "damping": {}}
    for name, value in gains.items():
        what, group = name.split("_", 1)
        by[what][f"*{group}*"] = value
    return by["frequency"], by["damping"] or _RATIO


def strongest(data: xr.Dataset, group: str) -> Array:
    """The greatest torque of the joints of a group in each flight, N m."""
    return np.max(
        [
            np.abs(data[f"{which}_{name}_torque"].values)
            for name in rudi.joint_names()
            if group in name
            for which in ("least", "greatest")
        ],
        0,
    )


def mean_error(errors: Array) -> float:
    """Of flights (N,), rad; one that broke off, NaN, counts as 1."""
    return float(np.where(np.isnan(errors), 1.0, errors).mean())


def percent(good: Array) -> tuple[float, float, float]:
    """The share of flights (N,) that are good, and the interval of that, %."""
    import xarray as xr

    share = fraction(xr.DataArray(good, dims="sample"))
    return tuple(100 * float(share[n]) for n in ("fraction", "low", "high"))  # type: ignore[return-value]


def own_landing(kept: rudi.Kept, takeoff: Takeoff) -> Flight:
    """The unperturbed flight at a takeoff's momentum; SomersaultError for one that breaks off."""
    flight = Maneuver(
        load(rudi.MODEL), takeoff, rudi.landing_time(kept), accuracy=1e-6, samples=2, steps=_STEPS
    ).fly()
    if flight.ended != "duration":
        raise SomersaultError(f"unperturbed it breaks off ({flight.ended}): it has no landing")
    return flight


@dataclass(frozen=True, eq=False)
class Judged:
    """How a compliance does at one momentum: errors (N,) from held-out starts, and the greatest
    torque (N m) of each group."""

    errors: Array
    torques: dict[str, float]

    @property
    def share(self) -> tuple[float, float, float]:
        """The flights with a small error, and the interval of that, %."""
        return percent(self.errors < rudi.SMALL)

    @property
    def mean(self) -> float:
        """The mean error, rad; a flight that broke off counts as 1."""
        return mean_error(self.errors)


@cache
def found(kept: rudi.Kept, case: Case) -> dict[str, float]:
    """The natural frequencies (rad/s) and damping ratios by group."""
    text = (files("somersault.thesis.ch7") / "rudi_momenta.json").read_text(encoding="utf-8")
    return json.loads(text)[kept][case]


@cache
def judged(kept: rudi.Kept, case: Case, factor: float) -> Judged:
    """A compliance at a momentum, from starts that its search has not seen."""
    takeoff = soft(kept, found(kept, case), factor)
    names = rudi.joint_names()
    report = Report(("landing_error",), extremes=tuple(f"{name}_torque" for name in names))
    runs = flights(
        rudi.MODEL, takeoff, rudi.landing_time(kept), report=report,
        against=own_landing(kept, takeoff), accuracy=1e-6, steps=_STEPS,
    )  # fmt: skip
    flown = ensemble(runs, vary=scatter(), size=_SIZE, seed=_SEED, sequence="sobol").dataset
    good = ended_by(flown["ended"], "duration").values
    torques = {group: float(strongest(flown, group)[good].max()) for group in GROUPS}
    return Judged(np.where(good, flown["landing_error"].values, np.nan), torques)


def claims() -> tuple[Claim, ...]:
    """That one compliance serves all momenta."""
    row = []
    for kept, name in (("rudi", "the nominal motion"), ("rudi_gentle", "the gentle motion")):
        fixed, damped = (
            {factor: judged(kept, case, factor) for factor in FACTORS}
            for case in ("fixed", "damped")
        )
        row += [
            statement(
                f"sec7-5.momenta-{kept}", _WHERE, f"{name}: one compliance with ζ = 0.7 lands at "
                "h, 0.9 h and 1.1 h", "not said",
                "; ".join(
                    f"{factor:g} h: {one.share[0]:.1f} % ({one.share[1]:.1f} to "
                    f"{one.share[2]:.1f}), mean {one.mean:.3f} rad"
                    for factor, one in fixed.items()
                ),
                min(one.share[1] for one in fixed.values()) >= _ENOUGH,
                f"Ours: seven natural frequencies, chosen over all three. Holds if the confidence "
                f"interval of each is above {_ENOUGH:g} %.",
            ),
            statement(
                f"sec7-5.momenta-damped-{kept}", _WHERE, f"{name}: with damping chosen too, the "
                "mean error is small at h, 0.9 h and 1.1 h", "not said",
                "; ".join(
                    f"{factor:g} h: {one.mean:.4f} rad, {one.share[0]:.1f} %"
                    for factor, one in damped.items()
                ),
                max(one.mean for one in damped.values()) <= _LEAST,
                f"Ours: ζ from 0.3 to 2. Holds if the mean of each is at most {_LEAST:g} rad.",
            ),
        ]  # fmt: skip
    slow = judged("rudi_gentle", "slow", 0.9)
    row.append(
        statement(
            "sec7-5.slow", _WHERE, "the gentle motion: a compliance for 0.9 h alone, with ζ = 0.7",
            "not said", f"{slow.share[0]:.1f} % ({slow.share[1]:.1f} to {slow.share[2]:.1f}), mean "
            f"{slow.mean:.3f} rad",
            slow.share[0] >= _ENOUGH, f"Ours. Holds from {_ENOUGH:g} %.",
        )
    )  # fmt: skip
    return tuple(row)


def rows() -> list[tuple[str, ...]]:
    """Of a table: design, shares below 0.05 and 0.1 rad, interval, mean error, and torques."""
    return [
        (
            f"{kept.replace('rudi_gentle', 'gentle')} at {factor:g} h: ω_n of seven groups "
            + ("and ζ, over three momenta" if case == "damped" else "over three momenta, ζ = 0.7"),
            f"{100 * np.mean(one.errors < 0.05):.1f}", f"{one.share[0]:.1f}",
            f"{one.share[1]:.1f} to {one.share[2]:.1f}", f"{one.mean:.4f}",
            ", ".join(f"{group} {most:.0f}" for group, most in one.torques.items()),
        )
        for kept in ("rudi", "rudi_gentle")
        for case in ("fixed", "damped")
        for factor in FACTORS
        for one in (judged(kept, case, factor),)
    ]  # fmt: skip
