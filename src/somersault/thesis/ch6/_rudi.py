"""The rudi of chapter 6: its motion, and maps of how it lands from off-nominal starts.

The motion is data (rudi.json) from the search in scripts/rudi.py; the thesis's motion was
programmed by hand and is not printed. Perturbed starts keep the nominal's angular momentum in
space. There is a second motion with bounded joint torques (rudi_gentle.json), of which everything
can be computed too.
"""

from __future__ import annotations

import json
import warnings
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from typing import Any, Literal

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultWarning
from somersault.ensembles import failed, landing_derivatives, landing_map
from somersault.flight import (
    Flight,
    JointTakeoff,
    Maneuver,
    Takeoff,
    compliant,
    fly,
    with_momentum,
)
from somersault.model import load

MODEL = "gymnast"
SPAN = 0.1  # rad of tilt and twist at takeoff, figure 6-2
SMALL = 0.1  # rad of landing error that is small, as the feasibility of this comparison has it
THEIRS = 30.0  # rad/s, the thesis's best natural frequency
_STEPS = 3000  # of a flight; the nominal takes some hundreds, and one in gimbal lock no end
_ACCURACY = 1e-6
Pose = Literal["wrap", "pike", "following"]
Kept = Literal["rudi", "rudi_gentle"]


@cache
def data(kept: Kept = "rudi") -> dict[str, Any]:
    """A motion as its file has it."""
    return json.loads((files("somersault.thesis.ch6") / f"{kept}.json").read_text(encoding="utf-8"))


def landing_time(kept: Kept = "rudi") -> float:
    """When the maneuver ends, s."""
    return float(data(kept)["landing"])


@cache
def nominal_takeoff(kept: Kept = "rudi") -> Takeoff:
    """All joints prescribed, upright, at the thesis's 12.6 rad/s."""
    joints = {
        name: JointTakeoff("prescribed", times=tuple(path["times"]), angles=tuple(path["angles"]))
        for name, path in data(kept)["joints"].items()
    }
    return with_momentum(MODEL, Takeoff(spin=float(data(kept)["spin"]), joints=joints))


@cache
def nominal(kept: Kept = "rudi") -> Flight:
    """The nominal flight."""
    return fly(MODEL, nominal_takeoff(kept), landing_time(kept), samples=801)


@cache
def twist_rate(kept: Kept = "rudi") -> tuple[float, float]:
    """Greatest twist rate on the way, rad/s, and when, s."""
    history = nominal(kept).dataset
    rate = np.abs(np.gradient(history["twist"].values, history["time"].values))
    return float(rate.max()), float(history["time"][int(rate.argmax())])


def scaled(takeoff: Takeoff, factor: float) -> Takeoff:
    """The same with so many times the angular momentum; a motor tape stays as it is."""
    assert takeoff.angular_momentum is not None
    return replace(takeoff, angular_momentum=tuple(factor * h for h in takeoff.angular_momentum))


@cache
def strategy(
    frequency: float | None, pose: Pose = "wrap", tape: bool = True, kept: Kept = "rudi"
) -> Takeoff:
    """Compliant at a natural frequency (rad/s), or prescribed where that is None.

    Gains are from the outboard inertias in a `pose` of the motion: in mid-twist (wrap), at
    takeoff (pike), or following it.
    """
    if frequency is None:
        return nominal_takeoff(kept)
    at: float | Literal["following"] = "following"
    if pose != "following":
        at = 0.0 if pose == "pike" else twist_rate(kept)[1]
    return compliant(MODEL, nominal_takeoff(kept), frequency, pose=at, tape=tape)


@dataclass(frozen=True, eq=False)
class Landings:
    """Landing errors e (tilt, twist) over a grid of starts, NaN where a flight failed."""

    starts: Array
    error: Array
    failures: int

    @property
    def share(self) -> float:
        """Of all starts, those that land with a small error."""
        return float((self.error < SMALL).sum() / self.error.size)


def landings(
    takeoff: Takeoff, points: int = 21, against: Flight | None = None, kept: Kept = "rudi"
) -> Landings:
    """Flights from a grid of tilt and twist at takeoff, and the error e of section 6.3.2."""
    maneuver = Maneuver(load(MODEL), takeoff, landing_time(kept), accuracy=_ACCURACY, steps=_STEPS)
    with warnings.catch_warnings():  # of flights that broke off, which are counted here
        warnings.simplefilter("ignore", SomersaultWarning)
        flown = landing_map(maneuver, against or nominal(kept), span=SPAN, points=points).dataset
    return Landings(
        flown["takeoff_tilt"].values,
        flown["landing_error"].values,
        int(failed(flown["ended"]).sum()),
    )


@cache
def error_map(
    frequency: float | None, pose: Pose = "wrap", points: int = 21, factor: float = 1.0,
    against_unperturbed: bool = False, kept: Kept = "rudi",
) -> Landings:  # fmt: skip
    """The map of a strategy at `factor` times the momentum.

    Its errors are measured against the nominal landing, or `against_unperturbed`: against the
    landing of the unperturbed flight at that momentum.
    """
    takeoff = scaled(strategy(frequency, pose, kept=kept), factor)
    if not against_unperturbed:
        return landings(takeoff, points, kept=kept)
    alone = fly(MODEL, takeoff, landing_time(kept), samples=2, accuracy=1e-8)
    return landings(takeoff, points, alone, kept)


@cache
def sensitivity(frequency: float | None, pose: Pose = "wrap") -> Array:
    """d(somersault, tilt, twist at landing) / d(tilt, twist at takeoff), (3, 2)."""
    maneuver = Maneuver(
        load(MODEL), strategy(frequency, pose), landing_time(), accuracy=1e-10, steps=10 * _STEPS
    )
    return landing_derivatives(maneuver).values


def joint_names() -> tuple[str, ...]:
    """The thirteen joints."""
    return tuple(load(MODEL).speeds)
