"""From a steady spin and a small deviation to a flight, in one call."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import by_name, instance
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.attitude import quaternion_from_matrix, quaternion_product
from somersault.flight._flight import Flight
from somersault.flight._fly import fly
from somersault.flight._plane import refuse_out_of_plane
from somersault.flight._takeoff import Takeoff
from somersault.flight.behaviours import Free, JointTakeoff, Locked, Sprung
from somersault.model import Joint, pose, spread
from somersault.stability import Spin, locked_speeds

_NOT_HELD = 1e-9  # a ball's holding torque over Ω² and its inertia that is rounding


def deviated_flight(
    spin: Spin,
    rate: float,
    duration: float,
    *,
    tilt: float = 0.0,
    somersault: float = 0.0,
    twist: float = 0.0,
    joints: Mapping[str, float] | None = None,
    stiffness: Mapping[str, float] | None = None,
    damping: Mapping[str, float] | None = None,
    lock: Iterable[str] = (),
    **options: Any,
) -> Flight:
    """The flight of a steadily spinning body that starts with a small deviation.

    The angular momentum is that of the spin, along the inertial axis of somersault. Springs are
    pretensioned to hold it; joints with neither a spring nor a damper are free.

    Parameters
    ----------
    spin : Spin
    rate : float
        Of the spin, rad/s.
    duration : float
        s.
    tilt, somersault, twist : float
        Small turns (rad) about the principal axes nearest body axes 1, 2 and 3 (in the model's
        `axes`): the coordinates of `Spin.linear`.
    joints : mapping of str to float, optional
        By how much joints are moved, rad or m.
    stiffness, damping : mapping of str to float, optional
        Without dimension, as in `Spin.linear`: k/(Ω² I) and b/(Ω I).
    lock : iterable of str
        Joints that are locked, or "all".
    **options
        Those of `somersault.fly`.

    Returns
    -------
    Flight

    Raises
    ------
    SomersaultError
        For what does not fit the spin's model, and for a ball that moves and has to be held in this
        pose: no spring of a ball is pretensioned in a flight.

    Examples
    --------
    >>> import somersault as so
    >>> layout = so.spin("furrer", pose={"shoulder": 1.4})
    >>> flight = so.deviated_flight(layout, 8.64, 5.8, tilt=0.01, stiffness={"shoulder": 1.2})
    >>> abs(flight.landing.twist) < 0.1
    True
    """
    model = instance("spin", spin, Spin).model
    rate = number("rate", rate)
    if rate == 0:
        raise SomersaultError("rate 0 is no spin to deviate from; give one in rad/s")
    turns = {"somersault": somersault, "tilt": tilt, "twist": twist}
    deviation = np.empty(3)
    for axis, (name, turn) in zip(model.axes, turns.items(), strict=True):
        deviation[axis - 1] = number(name, turn)
        refuse_out_of_plane(model, name, name, turn)
    springs = spread(model, by_name("stiffness", stiffness), mirrored=False)
    dampers = spread(model, by_name("damping", damping), mirrored=False)
    locked = {model.speeds[place] for place in locked_speeds(model, lock)}
    for name in (*springs, *dampers):
        model.joint(name)
    moved = pose(model, {**_angles(spin), **_sums(spin, by_name("joints", joints))})
    setups = {
        joint.name: _setup(spin, joint, rate, moved, springs, dampers, locked)
        for joint in model.joints
    }
    along = np.eye(3)[model.axes[0] - 1]
    momentum = rate * float(spin.principal_inertias[spin.axis - 1]) * along
    takeoff = Takeoff(
        quaternion=_attitude(spin, deviation).tolist(),
        angular_momentum=momentum.tolist(),
        joints=setups,
    )
    return fly(model, takeoff, duration, **options)


def _angles(spin: Spin) -> dict[str, float]:
    model = spin.model
    return {
        j.name: float(spin.pose[model.coordinate_slice(j.name)][0])
        for j in model.joints
        if j.kind != "ball"
    }


def _sums(spin: Spin, moved: Mapping[str, float]) -> dict[str, float]:
    at = _angles(spin)
    by_speed = spread(spin.model, moved, mirrored=True)
    return {name: at.get(name, 0.0) + number(f"moved {name}", by) for name, by in by_speed.items()}


def _setup(
    spin: Spin,
    joint: Joint,
    rate: float,
    moved: Array,
    springs: Mapping[str, Any],
    dampers: Mapping[str, Any],
    locked: set[str],
) -> JointTakeoff:
    """One joint, its non-dimensional spring and damper at this rate, pretensioned."""
    speed = joint.name if joint.kind != "ball" else f"{joint.name}.1"
    inertia = spin.outboard_inertias[speed]
    k = number(f"stiffness of {joint.name}", springs.get(joint.name, 0.0)) * rate**2 * inertia
    b = number(f"damping of {joint.name}", dampers.get(joint.name, 0.0)) * abs(rate) * inertia
    if joint.kind == "ball":
        if speed in locked:
            return Locked()
        _refuse_held(spin, joint, inertia)
        return Sprung(stiffness=k, damping=b)
    angle = float(moved[spin.model.coordinate_slice(joint.name)][0])
    if joint.name in locked:
        return Locked(angle)
    # Pretension is for the spin's own pose, wherever the deviation has moved the joint.
    held = spin.holding_torques[speed] * rate**2
    at = float(spin.pose[spin.model.coordinate_slice(joint.name)][0])
    if k == 0.0:
        return Free(angle, damping=b)
    return Sprung(angle, stiffness=k, damping=b, rest=at + held / k)


def _refuse_held(spin: Spin, ball: Joint, inertia: float) -> None:
    speeds = spin.model.speeds[spin.model.speed_slice(ball.name)]
    held = float(np.linalg.norm([spin.holding_torques[speed] for speed in speeds]))
    if held > _NOT_HELD * inertia:
        raise SomersaultError(
            f"ball {ball.name} has to be held in this pose, with {held:.3g} Ω² kg m², and flights "
            "hold no balls; make three hinges of it, or lock it"
        )


def _attitude(spin: Spin, turn: Array) -> Array:
    """Quaternion of the spin about the inertial axis of somersault, turned about principal axes."""
    across = np.roll(np.eye(3), spin.model.axes[0] - spin.axis, axis=0)  # from the axis of spin
    steady = across @ spin.principal_axes.T
    vector = spin.principal_axes @ turn
    half = np.linalg.norm(vector) / 2
    small = np.concatenate([[np.cos(half)], np.sinc(half / np.pi) / 2 * vector])
    return quaternion_product(quaternion_from_matrix(steady), small)
