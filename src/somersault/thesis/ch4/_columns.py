"""How long layout somersaults last with every spring at one arm angle, and the resonances there."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from somersault import stability as st
from somersault._core.array import Array
from somersault.ensembles import Vary, ended_by, ensemble
from somersault.flight import JointTakeoff, Report, Takeoff
from somersault.thesis.ch4._furrer import ANGLE, HIGH, LOW, STIFFNESS
from somersault.thesis.ch4._layout_takeoff import SPIN, TURN

ORDER = 5
_JOINED = 0.01  # of K_sh: losses that are no farther apart are one notch
_FINE = 0.002  # of K_sh, where resonances are looked for
_ACCURACY = 1e-8  # rad


@dataclass(frozen=True, eq=False)
class Column:
    """Turns (K_sh, tilt) that a model with sprung shoulders does at one arm angle, of `most`, with
    springs between two ends."""

    model: str
    angle: float
    ends: tuple[float, float]
    stiffness: Array
    turns: Array
    most: int

    def notches(self, tilt: int) -> list[tuple[float, float]]:
        """Ranges of K_sh in which spins are lost, those at the ends left aside."""
        lost = self.stiffness[self.turns[:, tilt] < self.most]
        low, high = self.ends
        points = np.concatenate([[low], lost, [high]])
        runs = np.split(points, np.flatnonzero(np.diff(points) > _JOINED) + 1)
        return [(float(r[0]), float(r[-1])) for r in runs if r[0] != low and r[-1] != high]

    def resonances(self) -> list[tuple[str, int, float]]:
        """Name, order and K_sh of each explosive resonance, from the linear modes."""
        chart = st.chart(
            self.model, (ANGLE, [self.angle]), (STIFFNESS, self.stiffness), resonances=ORDER
        )
        found = []
        for k, name in enumerate(chart.resonance.values.tolist()):
            off = chart.detuning.values[k, :, 0]
            for i in np.flatnonzero((off[1:] * off[:-1] <= 0) & chart.explosive.values[k, 1:, 0]):
                at = np.interp(0.0, *_ascending(off[i : i + 2], self.stiffness[i : i + 2]))
                found.append((name, int(chart.order[k]), float(at)))
        return found


def _ascending(x: Array, y: Array) -> tuple[Array, Array]:
    order = np.argsort(x)
    return x[order], y[order]


@cache
def column(
    model: str, angle: float, tilts: tuple[float, ...], step: float, most: int,
    between: tuple[float, float] | None = None,
) -> Column:  # fmt: skip
    """So many turns, or until a quarter twist, with springs within the region or between two, from
    each tilt (rad) with the momentum along the inertial axis 2. Lives do not depend on the rate."""
    low, high = between or edges(model, angle)
    stiffness = np.arange(low + step / 2, high, step)
    steady = st.spin(model, pose={"shoulder": angle})
    springs = Vary(
        sets="joints.shoulder.stiffness", values=stiffness, unit="1",
        scale=SPIN**2 * steady.outboard_inertias["left_shoulder"],
    )  # fmt: skip
    start = Takeoff(
        angular_momentum=(0.0, SPIN * float(steady.principal_inertias[1]), 0.0),
        joints={"shoulder": JointTakeoff("sprung", angle=angle, stiffness=0.0, hold=True)},
    )
    flown = ensemble(
        model, start, most * TURN,
        {"K_sh": springs, "leant": Vary(sets="takeoff.tilt", values=tilts, unit="rad")},
        report=Report(("somersaults",)), accuracy=_ACCURACY, until="quarter twist", steps=1_000_000,
    ).dataset  # fmt: skip
    lasts = ended_by(flown["ended"], "duration").values
    turns = np.where(lasts, most, flown["time"].values / TURN)
    return Column(model, angle, (low, high), stiffness, turns, most)


@cache
def unflown(model: str, angle: float) -> Column:
    """The same of the whole region without flights, for its resonances."""
    ends = edges(model, angle)
    return Column(model, angle, ends, np.arange(*ends, _FINE), np.empty(0), 0)


def edges(model: str, angle: float) -> tuple[float, float]:
    """K_sh at the edges of the region."""
    (ends, *_) = st.stable_ranges(model, (STIFFNESS, LOW, HIGH), pose={"shoulder": angle})
    return ends
