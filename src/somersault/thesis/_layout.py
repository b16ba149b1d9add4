"""Furrer's layout flights, one at a time and many together.

Two starts are possible where the thesis says "tilt 0.01, twist 0". "momentum": the angular
momentum is along the inertial axis 2, as on the maps of section 2.5. "rates": of the angles'
rates only the somersault's is not zero, as one would set the state of a simulation; the momentum
is then nearer to the body's own axis than the tilt says, by I3/I2.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any, Literal

import numpy as np

from somersault import stability as st
from somersault._array import Array
from somersault.attitude import unwrapped_angles
from somersault.flight import Flight, JointTakeoff, Takeoff, fly
from somersault.flight._start import start as begin
from somersault.flight._system import kinds, system
from somersault.flight._takeoff import plans
from somersault.model import load
from somersault.thesis._furrer import MODEL, shoulder_inertia

SPIN = 8.64  # rad/s: 2000 s are 2750 somersaults
TURN = 2 * np.pi / SPIN
Begun = Literal["momentum", "rates"]


def arms(angle: float, **options: Any) -> dict[str, JointTakeoff]:
    """Both shoulders at a symmetric angle (rad), with the options of `JointTakeoff`."""
    sides = (("left_shoulder", 1), ("right_shoulder", -1))
    return {name: JointTakeoff(angle=sign * angle, **options) for name, sign in sides}


def sprung(angle: float, stiffness: float, damping: float = 0.0) -> dict[str, JointTakeoff]:
    """Shoulders with springs K_sh and dampers b/(Ω I_sh), pretensioned for the steady spin."""
    k = stiffness * SPIN**2 * shoulder_inertia()
    b = damping * SPIN * shoulder_inertia()
    return arms(angle, motion="sprung", stiffness=k, damping=b, hold=True)


def takeoff(
    joints: dict[str, JointTakeoff],
    tilt: float = 0.01,
    twist: float = 0.0,
    begun: Begun = "momentum",
) -> Takeoff:
    """A layout somersault at 8.64 rad/s from a tilt and a twist, rad."""
    if begun == "rates":
        return Takeoff(tilt=tilt, twist=twist, spin=SPIN, joints=joints)
    inertia = _somersault_inertia(abs(float(np.asarray(joints["left_shoulder"].angle))))
    h = (0.0, SPIN * inertia, 0.0)
    return Takeoff(tilt=tilt, twist=twist, angular_momentum=h, joints=joints)


@cache
def _somersault_inertia(angle: float) -> float:
    return float(st.principal_inertias(MODEL, {"shoulder": angle})[1])


@cache
def passive(angle: float, stiffness: float, turns: float = 8.0) -> Flight:
    """A flight with springs from a tilt of 0.01, its momentum along inertial 2."""
    return fly(MODEL, takeoff(sprung(angle, stiffness)), turns * TURN, samples=4001)


@dataclass(frozen=True, eq=False)
class Lifetimes:
    """Somersaults until a quarter twist, at most `most`, over angles and stiffnesses.

    `nominal` counts turns of the nominal spin instead of the somersault angle; `furthest` is
    the largest |twist| on the way, rad.
    """

    somersaults: Array
    nominal: Array
    furthest: Array
    most: float


def lifetimes(
    angles: Array,
    stiffnesses: Array,
    tilt: float,
    twist: float,
    begun: Begun,
    most: float = 8.0,
    accuracy: float = 1e-9,
) -> Lifetimes:
    """A flight for each arm angle (n,) and K_sh (m,), all in one batch: arrays (n, m).

    The quarter twist, where the momentum along body axis 2 changes sign, is found as an event
    of the integration. Flights go on for a fifth longer than `most` nominal turns, so that
    one that somersaults slowly gets there too.
    """
    model = load(MODEL)
    states, numbers = [], []
    for angle in angles:
        for stiffness in stiffnesses:
            start = takeoff(sprung(float(angle), float(stiffness)), tilt, twist, begun)
            found = plans(model, start.joints)
            chosen = system(model, kinds(found), "quarter twist")
            first = begin(chosen, start, found)
            states.append(chosen.start(first.quaternion, first.omega, first.q, first.u))
            numbers.append(chosen.parameter_vector(first.plans))
    times = np.linspace(0, 1.2 * most * TURN, int(60 * most))
    flown = chosen.integrator.solve(np.array(states), np.array(numbers), times, accuracy / 20)
    whole = np.concatenate([flown.states[..., :4], flown.final[:, None, :4]], 1)
    path = unwrapped_angles(whole)
    shape = (len(angles), len(stiffnesses))
    turned = path[..., 0] / (2 * np.pi)
    before = turned <= most
    furthest = np.where(before, np.abs(path[..., 2]), 0).max(1)
    ended = np.minimum(turned[:, -1], most)
    return Lifetimes(
        ended.reshape(shape),
        np.minimum(flown.end / TURN, most).reshape(shape),
        furthest.reshape(shape),
        most,
    )
