"""The experiment of section 5.4 as a simulation: launches of the doll with scatter.

The launcher (`_launcher`) gives the nominal release; what differs from launch to launch is drawn.
Gravity moves the centre of mass alone, so a flight is one of attitude, until the catch or a
quarter twist. SI units and radians.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy import stats

from somersault._core.array import Array
from somersault.ensembles import Vary, ended_by, ensemble
from somersault.flight import JointTakeoff
from somersault.thesis.ch5 import _launcher as launcher
from somersault.thesis.ch5._doll import BEST, WEIGHTED, shoulder_inertia
from somersault.thesis.ch5._launcher import ARMS, SPIN, launch
from somersault.thesis.ch5._pulleys import SPRINGS

LAUNCHES = 20  # a condition (§5.4)
MANY = 2000  # a condition, of ours
SEED = 1994
_ACCURACY = 1e-6  # rad


@dataclass(frozen=True)
class Scatter:
    """Standard deviations from launch to launch, all independent and normal about the nominal.

    `attitude` of tilt and of twist (rad), `rates` of their rates (rad/s), `arms` of the nominal arm
    angle (rad; both arms together, in balance where they are), `pretension` of both springs'
    torque about what balances the spin (of it).
    """

    attitude: float
    rates: float
    arms: float
    pretension: float

    def vary(self, sprung: bool) -> dict[str, Vary]:
        """The varied quantities of an ensemble."""
        varied = {
            "tilted": (("takeoff.tilt",), self.attitude, "rad"),
            "twisted": (("takeoff.twist",), self.attitude, "rad"),
            "tilting": (("takeoff.tilt_rate",), self.rates, "rad/s"),
            "twisting": (("takeoff.twist_rate",), self.rates, "rad/s"),
            "arms": (("joints.shoulder.angle",), self.arms, "rad"),
        }
        if sprung:
            size = self.pretension * -launch().pretension
            varied["tension"] = (("joints.shoulder.pretension",), size, "N m")
        return {
            name: Vary(adds_to=what, normal=(0.0, deviation), unit=unit)
            for name, (what, deviation, unit) in varied.items()
            if deviation > 0
        }


# What the laboratory's results are matched with: see `_scatter`, which estimates it.
SCATTER = Scatter(attitude=0.03, rates=0.4, arms=0.1, pretension=0.04)


@dataclass(frozen=True, eq=False)
class Outcome:
    """Launches of several conditions: `somersaults` and `stable` (conditions, launches)."""

    somersaults: Array
    stable: Array

    @property
    def share(self) -> Array:
        """Of stable launches, (conditions,)."""
        return self.stable.mean(1)

    @property
    def mean(self) -> Array:
        """Somersaults, (conditions,)."""
        return self.somersaults.mean(1)

    @property
    def deviation(self) -> Array:
        """Standard deviation of somersaults, (conditions,)."""
        return self.somersaults.std(1, ddof=1)

    def with_(self, other: Outcome) -> Outcome:
        """These conditions, then the other's."""
        return Outcome(
            np.concatenate([self.somersaults, other.somersaults]),
            np.concatenate([self.stable, other.stable]),
        )


def sprung(
    springs: Iterable[float], scatter: Scatter, count: int, seed: int = SEED,
    duration: float | None = None, damping: float = 0.0, sequence: str = "random",
) -> Outcome:  # fmt: skip
    """`count` launches for each spring K_sh, with the same draws; dampers b/(Ω I_sh).

    Flights last for `duration` (s), by default until the catch, or end with a quarter twist.
    """
    inertia = shoulder_inertia(WEIGHTED)
    arm = JointTakeoff(
        "sprung", angle=ARMS, stiffness=BEST * SPIN**2 * inertia, damping=damping * SPIN * inertia,
        hold=True,
    )  # fmt: skip
    grid = Vary(
        sets="joints.shoulder.stiffness", values=tuple(springs), scale=SPIN**2 * inertia, unit="1"
    )
    varied = {"K_sh": grid, **scatter.vary(True)}
    return _flown(arm, varied, count, seed, duration, sequence)


def clamped(
    scatter: Scatter, count: int, seed: int = SEED, duration: float | None = None,
    sequence: str = "random",
) -> Outcome:  # fmt: skip
    """`count` launches with the arms clamped."""
    arm = JointTakeoff("locked", angle=ARMS)
    return _flown(arm, scatter.vary(False), count, seed, duration, sequence)


def _flown(
    arm: JointTakeoff, vary: dict[str, Vary], count: int, seed: int, duration: float | None,
    sequence: str,
) -> Outcome:  # fmt: skip
    flown = ensemble(
        WEIGHTED,
        launcher.takeoff({"shoulder": arm}),
        launch().time() if duration is None else duration,
        vary,
        size=count,
        seed=seed,
        sequence=sequence,
        report=["somersaults"],
        accuracy=_ACCURACY,
        until="quarter twist",
    ).dataset
    rows = (-1, count)
    stable = ended_by(flown["ended"], "duration").values
    return Outcome(flown["somersaults"].values.reshape(rows), stable.reshape(rows))


@cache
def many() -> Outcome:
    """The six conditions with `MANY` launches each, the clamped arms last."""
    return sprung(SPRINGS, SCATTER, MANY).with_(clamped(SCATTER, MANY))


@cache
def twenty(seed: int = SEED) -> Outcome:
    """The laboratory's sequence: twenty launches for each condition, each with its own draws."""
    conditions = [sprung([k], SCATTER, LAUNCHES, seed + i) for i, k in enumerate(SPRINGS)]
    whole = conditions[0]
    for more in (*conditions[1:], clamped(SCATTER, LAUNCHES, seed + len(SPRINGS))):
        whole = whole.with_(more)
    return whole


def at_least(share: Array, hits: int, of: int = LAUNCHES) -> Array:
    """The probability of at least `hits` stable launches, each being stable with a probability."""
    return np.asarray(stats.binom.sf(hits - 1, of, share))
