"""Furrer's layout flights, one at a time.

Two starts are possible where the thesis says "tilt 0.01, twist 0". "momentum": the angular
momentum is along the inertial axis 2, as on the maps of section 2.5. "rates": only
the somersault angle changes at first, as one would set the state of a simulation; the momentum is
then nearer to the body's axis than the tilt says, by I3/I2.
"""

from __future__ import annotations

from functools import cache
from typing import Any, Literal

import numpy as np

from somersault import stability as st
from somersault.flight import Flight, JointTakeoff, Takeoff, fly
from somersault.thesis.ch4._furrer import MODEL, shoulder_inertia

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
    shoulder: Any = joints["left_shoulder"]
    inertia = _somersault_inertia(abs(float(np.asarray(shoulder.angle))))
    h = (0.0, SPIN * inertia, 0.0)
    return Takeoff(tilt=tilt, twist=twist, angular_momentum=h, joints=joints)


@cache
def _somersault_inertia(angle: float) -> float:
    return float(st.principal_inertias(MODEL, {"shoulder": angle})[1])


@cache
def passive(angle: float, stiffness: float, turns: float = 8.0) -> Flight:
    """A flight with springs from a tilt of 0.01, its momentum along inertial 2."""
    return fly(MODEL, takeoff(sprung(angle, stiffness)), turns * TURN, samples=4001)


def lifetime(angle: float, stiffness: float, begun: Begun, most: float = 8.0) -> float:
    """Turns of the nominal spin until a quarter twist, from a tilt of 0.01, at most `most`."""
    start = takeoff(sprung(angle, stiffness), begun=begun)
    return fly(MODEL, start, most * TURN, samples=2, until="quarter twist").landing.time / TURN
