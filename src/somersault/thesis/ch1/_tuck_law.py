"""The posture law of a tucked somersault: how far to tuck so as to land upright (section 1.1.1).

The joints move together, from the pose of the landing (share 0) to the tuck (share 1). A tuck of
share s turns at a rate H/I(s), so that by the landing, τ from now, a body that opens last will have
turned by H (τ/I(0) + s (1/I(1) − 1/I(0)) W(τ)), where W is the time in the tuck: all but half of
the opening. The angular momentum H is fixed from the release on, and known; the law senses the
somersault angle, its rate and the hip angle, and solves for s.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np

from somersault._core.array import Array
from somersault.dynamics import Equations
from somersault.flight import JointTakeoff
from somersault.thesis.ch1._high_bar import gymnast

JOINTS = ("shoulder_flexion", "hip_flexion", "knee", "ankle")
TUCK = (0.62, 2.4, 2.4, 0.6)  # rad
ATTITUDE = 0.64  # of the trunk in the landing pose when the feet are under the centre of mass, rad
LANDING = (1.4, 1.1, 0.55, float(np.pi / 2 + ATTITUDE - 1.1 + 0.55))  # with flat feet
TUCKING, OPENING = 0.32, 0.5  # s
REACTION = 0.1  # s
EVERY = 0.02  # s
FASTEST, QUICKEST = 20.0, 600.0  # of a joint, rad/s, rad/s²
_FROM, _FULLY = 0.15, 0.3  # s after the release: when the feedback begins, and is all there
_MOST_TUCK = 1.1
_LEAST_TIME = 0.06  # s in the tuck, for which feedback still reckons


@dataclass(frozen=True)
class _Turning:
    """How the body turns along the way from the landing pose (0) to the tuck (1).

    Attributes
    ----------
    opened, tucked : float
        1/I in the landing pose, and how much more it is in the tuck, 1/(kg m²).
    shifted : ndarray, (3,)
        Polynomial, the highest power first: by how much the way from 0 to a share turns the trunk,
        rad.
    """

    opened: float
    tucked: float
    shifted: Array


@cache
def _turning() -> _Turning:
    equations, share = Equations(gymnast()), np.linspace(0.0, 1.0, 41)
    low, way = np.array(LANDING), np.array(TUCK) - np.array(LANDING)
    poses = low + share[:, None] * way
    inertia = np.array([equations.inertia(pose)[1, 1] for pose in poses])
    moved = np.concatenate([np.zeros(6), way])
    carried = np.array([equations.momentum(pose, moved)[1] for pose in poses])
    rate = carried / inertia
    steps = np.concatenate([[0.0], np.cumsum(rate[1:] + rate[:-1]) / 2 * share[1]])
    tucked, opened = np.polyfit(share, 1 / inertia, 1)
    return _Turning(float(opened), float(tucked), np.polyfit(share, steps, 2))


def _text(value: float) -> str:
    return f"({value:.9g})"


def _powers(x: str, polynomial: Array) -> str:
    a, b, c = map(_text, polynomial.tolist())
    return f"({c} + {x}*({b} + {x}*{a}))"


def _smooth(x: str) -> str:
    return f"clip({x}, 0, 1)**2*(3 - 2*clip({x}, 0, 1))"


def _share() -> str:
    """The share of the tuck: `share`, and with `gain` 1 what the flight needs.

    Sensed is the moment before the reaction time; what is reckoned with is where the body will be
    after it.
    """
    body = _turning()
    hip = JOINTS.index("hip_flexion")
    way = _text(1 / (TUCK[hip] - LANDING[hip]))
    now = f"((hip_flexion - {_text(LANDING[hip])})*{way})"
    left = f"(land - time - {REACTION})"
    opening = f"clip({left}*{_text(1 / OPENING)}, 0, 1)"
    tucked = f"(max({left} - {OPENING}, 0) + {OPENING}*{opening}**3*(1 - {opening}*0.5))"
    missing = f"(goal - somersault - {REACTION}*somersault_rate - {_powers(now, body.shifted)})"
    needed = (
        f"({missing}/momentum - max({left}, 0)*{_text(body.opened)})"
        f"/({_text(body.tucked)}*max({tucked}, {_LEAST_TIME}))"
    )
    begun = _smooth(f"(time - {_FROM})*{_text(1 / (_FULLY - _FROM))}")
    return f"clip(share + gain*({needed} - share)*{begun}, 0, {_MOST_TUCK})"


@cache
def _law(joint: str) -> str:
    """A joint's angle: from where it was let go, by way of the tuck, to that of the landing."""
    k = JOINTS.index(joint)
    begun = _smooth(f"time*{_text(1 / TUCKING)}")
    closed = _smooth(f"(land - time - {REACTION})*{_text(1 / OPENING)}")
    pose = f"{_text(LANDING[k])} + {_text(TUCK[k] - LANDING[k])}*{closed}*{_share()}"
    return f"start + {begun}*({pose} - start)"


def posture(
    start: Mapping[str, float], land: float, goal: float, momentum: float, share: float,
    gain: float, noise: Mapping[str, float] | None = None,
) -> dict[str, JointTakeoff]:  # fmt: skip
    """What the joints do in flight.

    Parameters
    ----------
    start : mapping of str to float
        Joint angles at the release, rad.
    land : float
        When to land, s.
    goal : float
        Somersault angle at that time, rad.
    momentum : float
        Angular momentum, forwards, kg m²/s.
    share : float
        Of the tuck without feedback.
    gain : float
        Of the feedback: 1, or 0 for none.
    noise : mapping of str to float, optional
        Standard deviations of what is sensed.
    """
    gains = {
        "land": land, "goal": goal, "momentum": momentum, "share": share, "gain": gain,
    }  # fmt: skip
    return {
        joint: JointTakeoff.angle_law(
            law=_law(joint), gains={**gains, "start": start[joint]}, every=EVERY, delay=REACTION,
            noise=dict(noise or {}), most_rate=FASTEST, most_acceleration=QUICKEST,
        )
        for joint in JOINTS
    }  # fmt: skip
