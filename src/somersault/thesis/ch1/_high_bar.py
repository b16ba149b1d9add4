"""A gymnast on the high bar: the giant swing, and what is known as the bar is let go."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from somersault._core.array import Array
from somersault.flight import JointTakeoff, Release, Swing, released, swing
from somersault.model import GROUND, Body, Joint, Model, Mount, athlete, mounted, sagittal

STATURE, MASS = 1.67, 64.0  # m, kg
BAR = 2.8  # m above the floor
GRIP = 0.61  # from the shoulder to the middle of the hands, m
# The giant: where the body is at the start (rad past the handstand) and how fast (rad/s), and the
# path of the hips (s, rad): arched in the swing down, kicked in the swing up.
_BEGIN, _BEGUN = -0.15, -0.3
_TIMES, _HIPS = (0.2, 0.9, 1.1, 1.32), (0.1, -0.4, -0.4, 0.4)
_SHOULDERS = np.pi - 0.05
_LONGEST = 1.6  # s
LANDING_HEIGHT = (
    0.9  # of the centre of mass as the feet come down, m: what the gymnast reckons with
)
GRAVITY = 9.81


@cache
def gymnast() -> Model:
    """Seen from the side."""
    return sagittal(athlete(STATURE, MASS, knees=True, ankles=True))


@cache
def on_the_bar() -> Mount:
    """Held by the hands."""
    none = (0.0, 0.0, 0.0)
    bar = Body(
        "bar", GROUND, 0.0, none, (none, none, none), position=(0.0, 0.0, BAR),
        joints=(Joint("bar", "hinge", (0.0, 1.0, 0.0)),),
    )  # fmt: skip
    return mounted(gymnast(), bar, (0.0, 0.0, GRIP), body="upper_arm")


@cache
def giant() -> Swing:
    """The giant swing, to beyond where anybody would let go."""
    joints = {
        "shoulder_flexion": JointTakeoff.locked(angle=_SHOULDERS),
        "hip_flexion": JointTakeoff.prescribed(times=_TIMES, angles=_HIPS),
        "knee": JointTakeoff.locked(angle=0.0),
        "ankle": JointTakeoff.locked(angle=0.0),
    }
    return swing(
        on_the_bar().held, {"bar": _BEGIN}, _LONGEST, rates={"bar": _BEGUN}, joints=joints,
        samples=321,
    )  # fmt: skip


def until(time: float, faster: float = 1.0) -> Swing:
    """The giant until a time (s), and there turning so many times as fast."""
    whole = giant()
    k = int(np.searchsorted(whole.times, time))
    share = (time - whole.times[k - 1]) / (whole.times[k] - whole.times[k - 1])

    def cut(rows: Array) -> Array:
        return np.concatenate([rows[:k], [rows[k - 1] + share * (rows[k] - rows[k - 1])]])

    rates = cut(whole.u)
    rates[-1] *= faster
    return replace(
        whole, times=cut(whole.times), q=cut(whole.q), u=rates,
        joint_torques=cut(whole.joint_torques),
    )  # fmt: skip


@dataclass(frozen=True)
class Seen:
    """What is known of the flight as the bar is let go.

    Attributes
    ----------
    release : Release
    time : float
        In the air, s.
    ahead : float
        How far in front of the centre of mass the feet must come down so that the floor's push,
        through both, stops the fall, the way along and the turn together, m.
    momentum : float
        Angular momentum, forwards, kg m²/s.
    """

    release: Release
    time: float
    ahead: float
    momentum: float


def let_go(swung: Swing) -> Seen:
    """The release at the end of a swing."""
    from somersault.flight import fly

    release = released(swung, on_the_bar())
    along, _, up = release.takeoff.velocity
    drop = release.centre[2] - LANDING_HEIGHT
    falling = float(np.sqrt(up**2 + 2 * GRAVITY * drop))
    momentum = float(fly(gymnast(), release.takeoff, 1e-3, samples=2).angular_momentum[0, 1])
    ahead = (momentum / MASS + LANDING_HEIGHT * along) / falling
    return Seen(release, (up + falling) / GRAVITY, ahead, momentum)
