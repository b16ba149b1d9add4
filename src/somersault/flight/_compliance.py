"""From a motion that is followed exactly to a body that gives way about it.

Compliance as in Playter (1994), section 6.3.3: at every joint on a path a spring and a damper
about the path, beside the torques of the nominal flight replayed as a motor tape. All gains come
from one number, the body-clamped natural frequency ω_n: with everything inboard held still and
everything outboard rigid, I ẍ + 2 ζ ω_n I ẋ + ω_n² I x = 0.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import shown, truth
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.attitude import matrix_from_quaternion
from somersault.dynamics import Equations
from somersault.flight._batch import Batch
from somersault.flight._gains import each
from somersault.flight._replay import Replay
from somersault.flight._start import Start
from somersault.flight._takeoff import Takeoff, require_takeoff
from somersault.flight.behaviours import (
    Coupled,
    JointPlan,
    JointTakeoff,
    Locked,
    Prescribed,
    softened,
)
from somersault.model import Model, load, named_pose, pose_names
from somersault.model import pose as posed
from somersault.motion import value

_FOLLOWING = "following"


def compliant(
    model: str | Model,
    takeoff: Takeoff,
    natural_frequency: float | Mapping[str, float],
    damping_ratio: float | Mapping[str, float] = 0.7,
    *,
    pose: Mapping[str, float] | float | str,
    tape: bool = True,
    stop_stiffness: float = 0.0,
    stop_damping: float = 0.0,
) -> Takeoff:
    """The takeoff of a body that gives way about the motion that a takeoff prescribes.

    Every prescribed joint gets a spring and a damper about its path: k = ω_n² I and c = 2 ζ ω_n I,
    with I the inertia of all that is outboard of it (Playter 1994, section 6.3.3).

    Parameters
    ----------
    model : str or Model
    takeoff : Takeoff
        Its prescribed joints become compliant; the others must be locked or coupled.
    natural_frequency : float or mapping of str to float
        ω_n, rad/s, of all joints, or by joint: a pair by the name that it shares, joints alike by
        one with a *, as "*shoulder*".
    damping_ratio : float or mapping of str to float
        ζ, likewise.
    pose : mapping, float or str
        The pose in which I is taken: angles by joint (rad), the motion's own at a time (s), an
        athlete's named pose ("wrap"), or "following" it as it changes.
    tape : bool
        Whether the joint torques of the nominal flight, which follows the paths exactly, are
        replayed as a motor tape.
    stop_stiffness, stop_damping : float
        Of the stops (N m/rad, N m s/rad) that joints with limits get there.

    Returns
    -------
    Takeoff
        Its angular momentum is given in inertial axes, so that another attitude does not merely
        turn the whole flight.

    Raises
    ------
    SomersaultError
        Where nothing is prescribed, and for anything that does not fit.

    Examples
    --------
    >>> import somersault as so
    >>> twist = so.arm_tilt()
    >>> soft = so.compliant("gymnast", twist.takeoff, 30.0, pose="wrap")
    >>> soft.joints["left_shoulder_abduction"].motion
    'compliant'
    >>> by_joint = {"*shoulder*": 20.0, "elbow": 30.0, "*hip*": 25.0, "torso_twist": 15.0}
    >>> soft = so.compliant("gymnast", twist.takeoff, by_joint, pose="wrap")
    """
    model = load(model)
    begun = _begun(model, takeoff)
    joints = begun.plans
    truth("tape", tape)
    for what, given in (("stop_stiffness", stop_stiffness), ("stop_damping", stop_damping)):
        if number(what, given) < 0:
            raise SomersaultError(f"{what} must not be negative, and is {given:g}")
    on_path = [(plan.joint, plan.does) for plan in joints if isinstance(plan.does, Prescribed)]
    if not on_path:
        raise SomersaultError("nothing is prescribed in this takeoff, so nothing can be compliant")
    names = [joint.name for joint, _ in on_path]
    frequencies = each("natural_frequency", natural_frequency, model, names)
    ratios = each("damping_ratio", damping_ratio, model, names)
    for name in names:
        if frequencies[name] <= 0 or ratios[name] < 0:
            raise SomersaultError(
                f"natural_frequency must be positive and damping_ratio not negative, and they are "
                f"{frequencies[name]:g} and {ratios[name]:g}"
            )
    inertias = np.ones(len(model.speeds))
    following = isinstance(pose, str) and pose == _FOLLOWING
    if not following:
        inertias = _equations(model).outboard_inertia(_pose(model, begun, pose))
    setups = _others(joints)
    for joint, does in on_path:
        inertia = float(inertias[model.speed_slice(joint.name).start])
        omega_n, stopped = frequencies[joint.name], joint.limits is not None
        setups[joint.name] = softened(
            does, stiffness=omega_n**2 * inertia,
            damping=2 * ratios[joint.name] * omega_n * inertia,
            following=following, stop_stiffness=stop_stiffness if stopped else 0.0,
            stop_damping=stop_damping if stopped else 0.0,
        )  # fmt: skip
    to_body = matrix_from_quaternion(begun.quaternion).T
    return replace(
        _with_momentum(takeoff, begun.momentum),
        tape=tuple((to_body @ begun.momentum).tolist()) if tape else None,
        joints=setups,
    )


def with_momentum(model: str | Model, takeoff: Takeoff) -> Takeoff:
    """The same takeoff, its rotation given as angular momentum in inertial axes.

    Then the attitude can be varied while the momentum stays where it is; with rates the whole
    flight would turn along.

    Parameters
    ----------
    model : str or Model
    takeoff : Takeoff

    Returns
    -------
    Takeoff

    Examples
    --------
    >>> import somersault as so
    >>> takeoff = so.with_momentum("book", so.Takeoff(spin=3.0))
    >>> takeoff.spin is None and len(takeoff.angular_momentum) == 3
    True
    """
    return _with_momentum(takeoff, _begun(load(model), takeoff).momentum)


def off_nominal(
    model: str | Model,
    takeoff: Takeoff,
    *,
    somersault: float = 0.0,
    tilt: float = 0.0,
    twist: float = 0.0,
) -> Takeoff:
    """The same takeoff from an attitude that is off by some angles: an off-nominal start.

    The angular momentum stays where it is in space. A motor tape is that of the nominal flight, and
    so is what a replay law's errors are measured against (Playter 1994, section 6.3.2).

    Parameters
    ----------
    model : str or Model
    takeoff : Takeoff
        Its attitude given by angles.
    somersault, tilt, twist : float
        How far it is off, rad.

    Returns
    -------
    Takeoff

    Raises
    ------
    SomersaultError
        For a takeoff whose attitude is a quaternion.

    Examples
    --------
    >>> import somersault as so
    >>> so.off_nominal("book", so.Takeoff(spin=3.0, tilt=0.1), tilt=0.05).tilt
    0.15000000000000002
    """
    begun = with_momentum(model, takeoff)
    if begun.quaternion is not None:
        raise SomersaultError("a takeoff that is off by angles needs angles, not a quaternion")
    given = {"somersault": somersault, "tilt": tilt, "twist": twist}
    off = {name: getattr(begun, name) + number(name, by) for name, by in given.items()}
    replay = None if begun.replay is None else against(model, begun, begun.replay)
    return replace(begun, replay=replay, **off)


def against(model: str | Model, takeoff: Takeoff, replay: Replay) -> Replay:
    """A replay whose nominal flight is that of a takeoff given by angles, unless it has one."""
    if replay.nominal_angles is not None or takeoff.quaternion is not None:
        return replay
    momentum = with_momentum(model, takeoff).angular_momentum
    angles = (takeoff.somersault, takeoff.tilt, takeoff.twist)
    return replace(replay, nominal_angles=angles, nominal_momentum=momentum)


@lru_cache(maxsize=8)
def _equations(model: Model) -> Equations:
    """Of a model, compiled once however many motions it gets compliance for."""
    return Equations(model)


def _begun(model: Model, takeoff: Takeoff) -> Start:
    require_takeoff(takeoff)
    return Batch(model, takeoff, 1.0).begun().start


def _with_momentum(takeoff: Takeoff, momentum: Array) -> Takeoff:
    return replace(
        takeoff, spin=None, tilt_rate=0.0, twist_rate=0.0, angular_velocity=None,
        angular_momentum=tuple(momentum.tolist()),
    )  # fmt: skip


def _others(joints: tuple[JointPlan, ...]) -> dict[str, JointTakeoff]:
    """What every joint does that is not prescribed."""
    others: dict[str, JointTakeoff] = {}
    for plan in joints:
        if isinstance(plan.does, Locked | Coupled):
            others[plan.joint.name] = plan.does
        elif not isinstance(plan.does, Prescribed):
            raise SomersaultError(
                f"joint {plan.joint.name} is {plan.does.motion}; beside compliant joints there are "
                "prescribed and locked ones"
            )
    return others


def _pose(model: Model, start: Start, pose: Mapping[str, float] | float | str) -> Array:
    """Joint coordinates (coordinates,) of a pose by name, or of the motion at a time."""
    if isinstance(pose, str):
        words = pose_names(model)
        if pose not in words:
            there = ", ".join(repr(word) for word in (_FOLLOWING, *words))
            raise SomersaultError(
                f"pose {shown(pose)} is none; give joint angles by name, a time in s, or a word of "
                f"{there}"
            )
        return posed(model, named_pose(model, pose))
    if isinstance(pose, Mapping):
        for name, angle in pose.items():
            number(f"pose {name}", angle)
        return posed(model, pose)
    time = number("pose", pose)
    at = {}
    for plan in start.plans:
        if isinstance(plan.does, Prescribed):
            whole = plan.does.whole()
            first, last = whole.known
            if not first <= time <= last:
                raise SomersaultError(
                    f"pose {time:g} s is not in the recording of joint {plan.joint.name}, from "
                    f"{first:g} to {last:g} s; give a time of the motion"
                )
            at[plan.joint.name] = value(whole, time)[0]
    q = start.q.copy()
    for name, angle in at.items():
        q[model.coordinate_slice(name)] = angle
    return q
