"""The equations of a flight: a model, and what each of its joints is doing.

The state is (quaternion, ω, coordinates and speeds of the joints that move). The centre of
mass falls by itself, so it is no part of the state; a joint that is locked or prescribed is
none either. Angles, springs and paths are parameters: flights that differ only in numbers share
one compiled right-hand side.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import casadi as ca
import numpy as np

from somersault._array import Array
from somersault._errors import SomersaultError
from somersault.dynamics import Equations
from somersault.dynamics._articulated import forward_dynamics
from somersault.dynamics._integrator import Integrator
from somersault.dynamics._springs import torques as spring_torques
from somersault.dynamics._tree import tree
from somersault.flight._path import DEGREE, polynomial
from somersault.flight._takeoff import Motion
from somersault.flight._watch import longest, watch
from somersault.model import Joint, Model

_BASE = 7  # quaternion and ω
_NUMBERS = ("stiffness", "rest", "damping", "pretension")  # parameters of a joint that moves
_PATH = 1 + DEGREE + 1  # parameters of a prescribed joint: its polynomial, and since when


@lru_cache(maxsize=32)
def system(
    model: Model,
    joints: tuple[Motion, ...],
    event: str | None,
    bodies: tuple[str, ...] = (),
    extremes: tuple[str, ...] | None = None,
) -> System:
    """The system of a model whose joints move in these ways, compiled once."""
    return System(model, joints, event, bodies, extremes)


class System:
    """Right-hand side, layout of states and parameters, and what can be read from a state.

    `bodies` names numbers of the bodies that differ between flights, as `Equations` does.
    `extremes`, unless it is None, are what is watched beside the turns (`_watch`).
    """

    def __init__(
        self,
        model: Model,
        joints: tuple[Motion, ...],
        event: str | None,
        bodies: tuple[str, ...] = (),
        extremes: tuple[str, ...] | None = None,
    ) -> None:
        if not model.free:
            raise SomersaultError(
                f"{model.name} has a fixed base, so it cannot fly; give its base a free joint"
            )
        self.model, self.kinds, self.event = model, joints, event
        self.bodies, self.extremes = bodies, extremes
        moving = [j for j, k in zip(model.joints, joints, strict=True) if moves_freely(k)]
        self.coordinates = sum(j.coordinates for j in moving)
        self.state = _BASE + self.coordinates + sum(j.speeds for j in moving)
        self.parameters = len(bodies) + sum(
            _parameter_count(j, k) for j, k in zip(model.joints, joints, strict=True)
        )

    @cached_property
    def equations(self) -> Equations:
        """Momentum, energy and inertia of the model."""
        return Equations(self.model, self.bodies)

    @cached_property
    def integrator(self) -> Integrator:
        """DOP853 for these equations, with the event's gauge and what is watched."""
        x = ca.vertcat(self._y, self._t, self._p)

        def function(name: str, value: Any) -> ca.Function:
            return ca.Function(name, [x], [ca.cse(ca.densify(value))])

        slope = function("slope", self._slope())
        gauge = None if self.event is None else function("gauge", self._gauge())
        if self.extremes is None:
            return Integrator(slope, gauge)
        quaternion, omega = self._attitude()
        return Integrator(
            slope,
            gauge,
            watch(self.extremes, self.quantities, self.state, self.parameters),
            function("longest", longest(quaternion, omega)),
        )

    def quantities(self, y: Any, t: Any, p: Any) -> dict[str, Any]:
        """Joint coordinates and rates by name, symbolic, as functions of state, time, parameters;
        a rate's name is its joint speed's with "_rate"."""
        x = ca.vertcat(self._y, self._t, self._p)
        both = self._reading(ca.vertcat(y, t, p)) if x.numel() else ca.SX(0, 1)
        names = [*self.model.coordinates, *(f"{name}_rate" for name in self.model.speeds)]
        return {name: both[k] for k, name in enumerate(names)}

    # ------------------------------------------------------------------- the symbols

    @cached_property
    def _y(self) -> Any:
        return ca.SX.sym("y", self.state)

    @cached_property
    def _t(self) -> Any:
        return ca.SX.sym("t")

    @cached_property
    def _p(self) -> Any:
        return ca.SX.sym("p", self.parameters)

    @cached_property
    def _joints(self) -> list[_Joint]:
        """Each joint's coordinates, speeds, known accelerations and parameters, symbolic."""
        found = []
        q, u, p = _BASE, _BASE + self.coordinates, len(self.bodies)
        for joint, kind in zip(self.model.joints, self.kinds, strict=True):
            own = [self._p[p + k] for k in range(_parameter_count(joint, kind))]
            p += len(own)
            if kind == "prescribed":
                since, *coefficients = own
                value, rate, acceleration = polynomial(self._t - since, coefficients)
                found.append(_Joint(joint, [value], [rate], [acceleration], {}))
            elif kind == "locked":
                still: list[Any] = [0.0] * joint.speeds
                found.append(_Joint(joint, own, still, still, {}))
            else:
                at = [self._y[q + k] for k in range(joint.coordinates)]
                moving = [self._y[u + k] for k in range(joint.speeds)]
                q, u = q + joint.coordinates, u + joint.speeds
                numbers = dict(zip(_NUMBERS, own, strict=True))
                if kind == "free":
                    numbers["stiffness"] = 0.0
                found.append(_Joint(joint, at, moving, None, numbers))
        return found

    def _slope(self) -> Any:
        joints = self._joints
        q = [x for j in joints for x in j.position]
        u = [x for j in joints for x in j.rate]
        known = [a for j in joints for a in (j.acceleration or [None] * len(j.rate))]
        driven = {k: a for k, a in enumerate(known) if a is not None}
        symbols = {
            f"{what}.{j.joint.name}": value for j in joints for what, value in j.numbers.items()
        }
        quaternion, omega = self._attitude()
        numbers = {name: self._p[k] for k, name in enumerate(self.bodies)}
        alpha, _, accelerations = forward_dynamics(
            tree(self.model, numbers),
            q,
            omega,
            u,
            _with_pretension(spring_torques(self.model, q, u, symbols), joints),
            [0.0, 0.0, 0.0],
            driven,
        )
        moving = [j for j in joints if j.acceleration is None]
        position_rates = [x for j in moving for x in _coordinate_rates(j)]
        speed_rates = [a for k, a in enumerate(accelerations) if k not in driven]
        return ca.vertcat(
            *_quaternion_rate(quaternion, omega), *alpha, *position_rates, *speed_rates
        )

    def _gauge(self) -> Any:
        """cos Θ cos Ψ (eq. 2.2): its sign changes at a quarter twist."""
        _, x, _, z = self._attitude()[0]
        return 1 - 2 * (x * x + z * z)

    def _attitude(self) -> tuple[list[Any], list[Any]]:
        return [self._y[k] for k in range(4)], [self._y[4 + k] for k in range(3)]

    # ----------------------------------------------------------- from states to quantities

    def start(self, quaternion: Array, omega: Array, q: Array, u: Array) -> Array:
        """State vectors (…, state) from full joint coordinates and speeds."""
        q_keep, u_keep = self._kept()
        return np.concatenate([quaternion, omega, q[..., q_keep], u[..., u_keep]], -1)

    def joint_states(self, states: Array, times: Array, parameters: Array) -> tuple[Array, Array]:
        """Full joint coordinates and speeds, (…, coordinates) and (…, speeds), of states."""
        lead = states.shape[:-1]
        x = np.concatenate(
            [states, np.broadcast_to(times[..., None], (*lead, 1)),
             np.broadcast_to(parameters, (*lead, self.parameters))], -1,
        )  # fmt: skip
        flat = x.reshape(-1, x.shape[-1])
        both = np.array(self._reading.map(len(flat))(flat.T)).T if len(flat) else flat[:, :0]
        both = both.reshape(*lead, -1)
        count = len(self.model.coordinates)
        return both[..., :count], both[..., count:]

    @cached_property
    def _reading(self) -> ca.Function:
        joints = self._joints
        values = [x for j in joints for x in j.position] + [x for j in joints for x in j.rate]
        whole = ca.vertcat(*values) if values else ca.SX(0, 1)
        return ca.Function("reading", [ca.vertcat(self._y, self._t, self._p)], [ca.densify(whole)])

    def _kept(self) -> tuple[list[int], list[int]]:
        q_keep: list[int] = []
        u_keep: list[int] = []
        for joint, kind in zip(self.model.joints, self.kinds, strict=True):
            if moves_freely(kind):
                where = self.model.coordinate_slice(joint.name)
                q_keep += range(where.start, where.stop)
                where = self.model.speed_slice(joint.name)
                u_keep += range(where.start, where.stop)
        return q_keep, u_keep


@dataclass(frozen=True)
class _Joint:
    joint: Joint
    position: list[Any]
    rate: list[Any]
    acceleration: list[Any] | None
    numbers: dict[str, Any]


def moves_freely(kind: Motion) -> bool:
    """Whether a joint is part of the state."""
    return kind in ("free", "sprung")


def _parameter_count(joint: Joint, kind: Motion) -> int:
    if kind == "prescribed":
        return _PATH
    return joint.coordinates if kind == "locked" else len(_NUMBERS)


def _with_pretension(torques: list[Any], joints: list[_Joint]) -> list[Any]:
    held = [j.numbers.get("pretension", 0.0) for j in joints for _ in j.rate]
    return [torque + more for torque, more in zip(torques, held, strict=True)]


def _coordinate_rates(joint: _Joint) -> list[Any]:
    if joint.joint.kind == "ball":
        return _quaternion_rate(joint.position, joint.rate)
    return joint.rate


def _quaternion_rate(quaternion: list[Any], omega: list[Any]) -> list[Any]:
    """½ q ω: the rate of a quaternion whose body turns at ω, in its own axes."""
    w, x, y, z = quaternion
    a, b, c = omega
    return [
        -0.5 * (x * a + y * b + z * c),
        0.5 * (w * a + y * c - z * b),
        0.5 * (w * b + z * a - x * c),
        0.5 * (w * c + x * b - y * a),
    ]
