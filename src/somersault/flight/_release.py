"""What swings is let go: the takeoff of a body at the last moment of its swing.

Letting go changes no position and no velocity.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import by_name, instance
from somersault._core.errors import SomersaultError
from somersault.attitude import quaternion_from_matrix
from somersault.dynamics import Equations
from somersault.flight._broken import BROKEN
from somersault.flight._swing import Swing
from somersault.flight._takeoff import Takeoff
from somersault.flight.behaviours import JointTakeoff
from somersault.history import Recording
from somersault.model import Joint, Model, Mount, body_frames, body_velocities, centre_of_mass


@dataclass(frozen=True)
class Release:
    """A body that has been let go.

    Attributes
    ----------
    takeoff : Takeoff
        Of the free body, with the position of its centre of mass.
    centre : ndarray, (3,)
        Where its centre of mass is, in the ground's axes, m.
    time : float
        When, s.
    """

    takeoff: Takeoff
    centre: Array
    time: float


def released(
    swung: Swing, mount: Mount, joints: Mapping[str, JointTakeoff] | None = None
) -> Release:
    """The takeoff of the body that a mount lets go at the end of a swing.

    Letting go changes no position and no velocity: attitude, angular velocity, the velocity of the
    centre of mass, joint angles and rates are those of the last moment.

    Parameters
    ----------
    swung : Swing
        Of `mount.held`.
    mount : Mount
    joints : mapping of str to JointTakeoff, optional
        What each joint does in flight; its angle and rate are filled in. A joint that is not named
        keeps its spring and damper.

    Returns
    -------
    Release

    Raises
    ------
    SomersaultError
        For the swing of another model.

    Examples
    --------
    >>> import somersault as so
    >>> none = (0.0, 0.0, 0.0)
    >>> bar = so.Joint("bar", "hinge", axis=(0.0, 1.0, 0.0))
    >>> clamp = so.Body("clamp", -1, 0.0, none, (none, none, none), joints=(bar,))
    >>> mount = so.mounted(so.load("doll"), clamp, position=(0.0, 0.0, -0.3))
    >>> let_go = so.released(so.swing(mount.held, {"bar": 2.0}, 0.2), mount)
    >>> let_go.time
    0.2
    """
    _require_of(swung, mount)
    q, u = swung.q[-1], swung.u[-1]
    turn, origin, omega, velocity = _base_motion(mount, q, u)
    rider, places = mount.rider, _places(mount)
    own, own_rates = q[places], u[places]
    still = np.concatenate([omega, velocity, own_rates])
    linear = _equations(rider).momentum(own, still)[3:] / rider.mass
    setups = by_name("joints", joints)
    for name, setup in setups.items():
        instance(f"takeoff of joint {name}", setup, JointTakeoff)
        rider.joint(name)
    takeoffs = {
        joint.name: _let_go(joint, setups.get(joint.name), own[k], own_rates[k])
        for k, joint in enumerate(rider.joints)
    }
    centre = origin + turn @ centre_of_mass(rider, own)
    takeoff = Takeoff(
        quaternion=quaternion_from_matrix(turn).tolist(),
        angular_velocity=omega.tolist(),
        position=centre.tolist(),
        velocity=(turn @ linear).tolist(),
        joints=takeoffs,
    )
    return Release(takeoff, centre, float(swung.times[-1]))


def ridden(swung: Swing, mount: Mount) -> Recording:
    """The swing as a motion of the rider, who is free afterwards.

    Parameters
    ----------
    swung : Swing
        Of `mount.held`.
    mount : Mount

    Returns
    -------
    Recording
        Of `mount.rider`, which can be joined with its flight.

    Raises
    ------
    SomersaultError
        For the swing of another model.

    Examples
    --------
    >>> import somersault as so
    >>> none = (0.0, 0.0, 0.0)
    >>> bar = so.Joint("bar", "hinge", axis=(0.0, 1.0, 0.0))
    >>> clamp = so.Body("clamp", -1, 0.0, none, (none, none, none), joints=(bar,))
    >>> mount = so.mounted(so.load("doll"), clamp, position=(0.0, 0.0, -0.3))
    >>> so.flight.ridden(so.swing(mount.held, {"bar": 2.0}, 0.2, samples=3), mount).model.name
    'doll'
    """
    _require_of(swung, mount)
    turns, origins = _base_frames(mount, swung.q)
    attitudes = np.stack([quaternion_from_matrix(turn) for turn in turns])
    return Recording(mount.rider, swung.times, origins, attitudes, swung.q[:, _places(mount)])


def _require_of(swung: Swing, mount: Mount) -> None:
    instance("what is released", swung, Swing)
    instance("mount", mount, Mount)
    if swung.ended in BROKEN:
        raise SomersaultError(
            f"this swing broke off after {swung.times[-1]:.4g} s ({swung.ended}), so there is "
            "nothing to let go; swing for less time"
        )
    if swung.model != mount.held:
        raise SomersaultError(f"this is a swing of {swung.model.name}, not of the mount given")


@lru_cache(maxsize=8)
def _equations(model: Model) -> Equations:
    """Compiled once for all that is let go."""
    return Equations(model)


def _places(mount: Mount) -> list[int]:
    """Of the rider's joints among those of the whole."""
    return [mount.held.coordinate_slice(joint.name).start for joint in mount.rider.joints]


def _base_frames(mount: Mount, q: Array) -> tuple[Array, Array]:
    """The rider's base turned in the ground's axes, (…, 3, 3), and its origin there, (…, 3)."""
    turns, feet = body_frames(mount.held, q)
    carrier = turns[..., mount.place, :, :]
    arm = carrier @ np.array(mount.position)
    return carrier @ np.array(mount.rotation), feet[..., mount.place, :] + arm


def _base_motion(mount: Mount, q: Array, u: Array) -> tuple[Array, Array, Array, Array]:
    """`_base_frames`, and the base's angular velocity and its origin's velocity in its own axes."""
    turn, origin = _base_frames(mount, q)
    spin, rate = (x[mount.place] for x in body_velocities(mount.held, q, u))
    arm = turn @ np.array(mount.rotation).T @ np.array(mount.position)
    return turn, origin, turn.T @ spin, turn.T @ (rate + np.cross(spin, arm))


def _let_go(joint: Joint, given: JointTakeoff | None, angle: float, rate: float) -> JointTakeoff:
    if given is None:
        given = JointTakeoff("sprung" if joint.stiffness else "free").settled(joint)
    here: dict[str, Any] = {"angle": float(angle)}
    if given.in_state:
        here["rate"] = float(rate)
    return replace(given, **here)
