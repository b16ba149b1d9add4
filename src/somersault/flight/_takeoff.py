"""How a flight begins: attitude, what spins it, and what each joint does."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from somersault._core.checks import by_name, instance
from somersault._core.degrees import MOST_TURNS, note_degrees, note_degrees_per_second
from somersault._core.errors import SomersaultError
from somersault._core.numbers import MOST, number, numbers
from somersault.flight._replay import Replay
from somersault.flight.behaviours import JointTakeoff


@dataclass(frozen=True)
class Takeoff:
    """The start of a flight. SI units and radians.

    Attitude by `somersault`, `tilt`, `twist`, or by a `quaternion`; rotation by one of `spin`,
    `angular_velocity` and `angular_momentum`.

    Parameters
    ----------
    somersault, tilt, twist : float
        rad, about the model's `axes` (2, 1, 3 unless it says otherwise).
    quaternion : sequence of float, (4,), optional
        Body to inertial, scalar first, of any length.
    spin : float, optional
        rad/s about the inertial axis of somersault, the rate of the nominal steady spin: Φ̇ = spin,
        and Θ̇ and Ψ̇ are `tilt_rate` and `twist_rate`, whatever the attitude.
    tilt_rate, twist_rate : float
        rad/s, with `spin`.
    angular_velocity : sequence of float, (3,), optional
        rad/s, in body axes.
    angular_momentum : sequence of float, (3,), optional
        kg m²/s, in inertial axes.
    position, velocity : sequence of float, (3,)
        Of the centre of mass, m and m/s.
    tape : sequence of float, (3,), optional
        The angular momentum (body axes, kg m²/s) at takeoff of the nominal flight whose joint
        torques are replayed to compliant joints: that of the same paths, exactly followed.
    replay : Replay, optional
        How fast the paths of joints and the tape are played, by a law; without it as they are.
    noise : float
        Which noise laws sense: another number gives another noise, the same number
        the same.
    joints : mapping of str to JointTakeoff
        What each joint does; a left–right pair by its common name, with the left side's angles.

    Raises
    ------
    SomersaultError
        For numbers that are none, and for an attitude or a rotation given twice.

    Examples
    --------
    >>> import somersault as so
    >>> takeoff = so.Takeoff(tilt=0.01, spin=8.64, joints={"shoulder": so.JointTakeoff(angle=1.4)})
    """

    somersault: float = 0.0
    tilt: float = 0.0
    twist: float = 0.0
    quaternion: Sequence[float] | None = None
    spin: float | None = None
    tilt_rate: float = 0.0
    twist_rate: float = 0.0
    angular_velocity: Sequence[float] | None = None
    angular_momentum: Sequence[float] | None = None
    position: Sequence[float] = (0.0, 0.0, 0.0)
    velocity: Sequence[float] = (0.0, 0.0, 0.0)
    tape: Sequence[float] | None = None
    replay: Replay | None = None
    noise: float = 0.0
    joints: Mapping[str, JointTakeoff] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "joints", by_name("takeoff joints", self.joints))
        for name, joint in self.joints.items():
            instance(f"takeoff of joint {name}", joint, JointTakeoff)
        if self.replay is not None:
            instance("takeoff replay", self.replay, Replay)
        for name in ("somersault", "tilt", "twist", "tilt_rate", "twist_rate", "noise"):
            number(f"takeoff {name}", getattr(self, name))
        for name, turns in (("somersault", MOST_TURNS), ("tilt", 1), ("twist", MOST_TURNS)):
            note_degrees(f"takeoff {name}", getattr(self, name), turns)
        for name, size in (
            ("quaternion", 4),
            ("angular_velocity", 3),
            ("angular_momentum", 3),
            ("position", 3),
            ("velocity", 3),
            ("tape", 3),
        ):
            if getattr(self, name) is not None or name in ("position", "velocity"):
                most = np.inf if name == "quaternion" else MOST  # of any length
                numbers(f"takeoff {name}", getattr(self, name), size, most)
        given = [
            name
            for name in ("spin", "angular_velocity", "angular_momentum")
            if getattr(self, name) is not None
        ]
        if len(given) > 1:
            raise SomersaultError(f"takeoff gives {' and '.join(given)}; give one of them")
        if self.spin is not None and number("takeoff spin", self.spin) == 0:
            raise SomersaultError("takeoff spin must be a rate in rad/s that is not zero")
        for name in ("spin", "tilt_rate", "twist_rate", "angular_velocity"):
            if getattr(self, name) is not None:
                note_degrees_per_second(f"takeoff {name}", getattr(self, name))
        if self.spin is None and (self.tilt_rate or self.twist_rate):
            raise SomersaultError("takeoff tilt_rate and twist_rate go with spin; give that too")
        if self.quaternion is not None:
            if self.somersault or self.tilt or self.twist:
                raise SomersaultError("takeoff gives both angles and a quaternion; give one")
            if not np.any(self.quaternion):
                raise SomersaultError("takeoff quaternion is zero, which is no attitude")


def require_takeoff(takeoff: Any) -> None:
    """SomersaultError for anything that is not a takeoff."""
    instance("a takeoff", takeoff, Takeoff)
