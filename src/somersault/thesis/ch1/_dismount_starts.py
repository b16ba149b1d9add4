"""Dismounts from scattered releases, with and without the posture feedback (section 1.1.1)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from somersault._core.array import Array
from somersault.flight import Flight, fly, released
from somersault.ground import LandingLaw, Stance, land
from somersault.thesis.ch1._high_bar import (
    GRAVITY,
    LANDING_HEIGHT,
    gymnast,
    let_go,
    on_the_bar,
    until,
)
from somersault.thesis.ch1._tuck_law import ATTITUDE, JOINTS, posture

RELEASE = 1.39  # s
SCATTER = 0.02, 0.03  # standard deviations of the release, s, and of the rate there, 1
STARTS, _SEED = 100, 1
NOISE = {"somersault": 0.02, "somersault_rate": 0.1, "hip_flexion": 0.02}
MISJUDGED = 0.03, 0.01  # standard deviations: of the angular momentum, 1, and of the time, s
_TURNS = 2
_PLACING = 0.65  # how much of that comes by leaning: ankles are set, and feet should be flat
_LATER = 0.3  # s of flight beyond the landing that is reckoned with
_SHARES = 0.6, 0.85  # between which the tuck without feedback is searched


@dataclass(frozen=True)
class Case:
    """What a gymnast knows and does in the air.

    Attributes
    ----------
    sees : bool
        Whether momentum, time and attitude of the landing are those of this release, or of the
        nominal one.
    gain : float
        Of the posture feedback.
    rough : bool
        Whether senses are noisy and the release is misjudged.
    """

    sees: bool = True
    gain: float = 1.0
    rough: bool = False


WITHOUT, WITH, ROUGH = "by heart", "posture feedback", "noisy senses"
CASES = {WITHOUT: Case(sees=False, gain=0.0), WITH: Case(), ROUGH: Case(rough=True)}


@dataclass(frozen=True)
class Start:
    """A release, and how it is judged.

    Attributes
    ----------
    later : float
        Than the nominal, s.
    faster : float
        How many times as fast the gymnast turns.
    momentum, time : float
        Errors of judgement, 1 and s.
    noise : float
        Which noise the senses have.
    """

    later: float = 0.0
    faster: float = 1.0
    momentum: float = 0.0
    time: float = 0.0
    noise: float = 0.0


@dataclass(frozen=True, eq=False)
class Dismount:
    """One dismount.

    Attributes
    ----------
    flight : Flight
    stance : Stance
    error : float
        Of the somersault angle at touchdown, from that in which the feet are where the floor's push
        stops all motion, rad; positive where it has not turned enough.
    """

    flight: Flight
    stance: Stance
    error: float


def _goal(ahead: float) -> float:
    """Somersault angle for landing with the feet so far ahead of the centre of mass."""
    return ATTITUDE - _PLACING * ahead / LANDING_HEIGHT - 2 * np.pi * _TURNS


def flown(case: Case, start: Start, share: float | None = None) -> tuple[Flight, float]:
    """A flight, and the somersault angle at which it should land."""
    swung = until(RELEASE + start.later, start.faster)
    seen = let_go(swung)
    known = seen if case.sees else let_go(until(RELEASE))
    wrong = (start.momentum, start.time) if case.rough else (0.0, 0.0)
    angles = {name: float(swung.q[-1, swung.model.coordinate_slice(name).start]) for name in JOINTS}
    joints = posture(
        angles, known.time + wrong[1], _goal(known.ahead), known.momentum * (1 + wrong[0]),
        tuck() if share is None else share, case.gain, NOISE if case.rough else None,
    )  # fmt: skip
    takeoff = replace(released(swung, on_the_bar(), joints).takeoff, noise=start.noise)
    longest, falls = seen.time + _LATER, (0.0, 0.0, -GRAVITY)
    flight = fly(gymnast(), takeoff, longest, samples=301, gravity=falls)
    return flight, _goal(seen.ahead)


@cache
def tuck() -> float:
    """The share of the tuck with which the nominal flight lands as it does with feedback."""
    from scipy.optimize import brentq

    time = let_go(until(RELEASE)).time

    def lands(gain: float, share: float) -> float:
        flight, _ = flown(Case(gain=gain), Start(), share)
        return float(np.interp(time, flight.times, flight.angles[:, 0]))

    wanted = lands(1.0, sum(_SHARES) / 2)
    return float(brentq(lambda share: lands(0.0, share) - wanted, *_SHARES, xtol=1e-4))


def dismount(case: Case, start: Start = Start(), law: LandingLaw | None = None) -> Dismount:
    """A flight and its landing."""
    flight, goal = flown(case, start)
    stance = land(flight, law=law)
    return Dismount(flight, stance, float(stance.angles[0, 0] - goal))


@cache
def starts() -> tuple[Start, ...]:
    """The same for all cases."""
    drawn = np.random.default_rng(_SEED).standard_normal((STARTS, 4))
    drawn = drawn * (*SCATTER, *MISJUDGED) + (0.0, 1.0, 0.0, 0.0)
    return tuple(
        Start(later, faster, momentum, time, float(k))
        for k, (later, faster, momentum, time) in enumerate(drawn.tolist())
    )


@dataclass(frozen=True, eq=False)
class Outcomes:
    """What became of the starts.

    Attributes
    ----------
    stood : ndarray of bool, (starts,)
    error : ndarray, (starts,)
        rad, as in `Dismount`.
    """

    stood: Array
    error: Array

    @property
    def spread(self) -> float:
        """Standard deviation of the error, rad."""
        return float(np.std(self.error))


@cache
def outcomes(name: str, law: LandingLaw | None = None, count: int = STARTS) -> Outcomes:
    """Of a case, from the starts or the first of them."""
    ran = [dismount(CASES[name], start, law) for start in starts()[:count]]
    return Outcomes(np.array([d.stance.stood for d in ran]), np.array([d.error for d in ran]))
