"""The equations of a flight in symbols: from state, time and parameters to rates and torques.

The state is (quaternion, ω, coordinates and speeds of the joints that move freely). Where no
joint moves freely only the attitude is unknown: then the state is the quaternion alone, and ω is
what the angular momentum, a parameter, leaves it. Parameters are first those that change on the
way (paths, the motor tape), then those that stay (bodies, joints, momentum).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import casadi as ca

from somersault.attitude import in_sequence
from somersault.dynamics._articulated import forward_dynamics
from somersault.dynamics._composite import composites, outboard_inertia
from somersault.dynamics._motion import place
from somersault.dynamics._newton_euler import inverse_dynamics, momentum
from somersault.dynamics._springs import torques as spring_torques
from somersault.dynamics._tree import tree
from somersault.dynamics._vector import Vec, matvec, solve_symmetric, vsub
from somersault.flight._takeoff import Kind
from somersault.model import Joint, Model
from somersault.motion._path import DEGREE, TAPE_DEGREE, polynomial

ATTITUDE, RATE = 4, 3  # of a state: quaternion and ω
SPRING = ("stiffness", "rest", "damping", "pretension")  # parameters of a joint that moves
PATH = 1 + DEGREE + 1  # parameters of a path: since when, and its polynomial
TAPED = TAPE_DEGREE + 1  # of each joint on the tape: its torque's polynomial
GAINS = 2  # of a compliant joint: stiffness and damping
STOPS = 4  # parameters of stops: where they are, stiffness and damping
_ON_PATHS = ("prescribed", "compliant")


def moves_freely(kind: Kind) -> bool:
    """Whether a joint is part of the state."""
    return kind.motion not in ("locked", "prescribed")


def lasting(joint: Joint, kind: Kind) -> int:
    """How many parameters of a joint stay as they are."""
    if kind.motion == "prescribed":
        return 0
    if kind.motion == "locked":
        return joint.coordinates
    own = GAINS if kind.motion in _ON_PATHS else len(SPRING)
    return own + (STOPS if kind.stopped else 0)


@dataclass(frozen=True)
class _Joint:
    """A joint in symbols: where it is, and where its path would have it."""

    joint: Joint
    position: list[Any]
    rate: list[Any]
    acceleration: list[Any] | None
    """None where it moves freely."""
    wanted: tuple[Any, Any, Any] | None
    """Value, rate and acceleration of its path."""
    numbers: dict[str, Any]
    stops: list[Any] | None = None


class Symbols:
    """State `y`, time `t` and parameters `p` of a model's flight, and what follows from them."""

    def __init__(
        self, model: Model, kinds: tuple[Kind, ...], bodies: tuple[str, ...], tape: bool
    ) -> None:
        self.model, self.kinds, self.bodies, self.tape = model, kinds, bodies, tape
        pairs = list(zip(model.joints, kinds, strict=True))
        moving = [j for j, k in pairs if moves_freely(k)]
        self.bound = not moving
        self.base = ATTITUDE if self.bound else ATTITUDE + RATE
        self.coordinates = sum(j.coordinates for j in moving)
        self.state = self.base + self.coordinates + sum(j.speeds for j in moving)
        self.paths = sum(k.motion in _ON_PATHS for k in kinds)
        taped = sum(k.motion == "compliant" for k in kinds) if tape else 0
        self.changing = PATH * self.paths + (1 + TAPED * taped if tape else 0)
        of_joints = sum(lasting(j, k) for j, k in pairs)
        own = self.changing + len(bodies) + of_joints
        self.parameters = own + (RATE if self.bound else 0)
        self.y = ca.SX.sym("y", self.state)
        self.t = ca.SX.sym("t")
        self.p = ca.SX.sym("p", self.parameters)

    @property
    def x(self) -> Any:
        """State, time and parameters joined."""
        return ca.vertcat(self.y, self.t, self.p)

    @cached_property
    def tree(self) -> Any:
        """The links, with the bodies' numbers that are parameters."""
        own = enumerate(self.bodies, self.changing)
        return tree(self.model, {name: self.p[k] for k, name in own})

    @cached_property
    def joints(self) -> list[_Joint]:
        """Each joint."""
        found = []
        q, u, path = self.base, self.base + self.coordinates, 0
        p = self.changing + len(self.bodies)
        for joint, kind in zip(self.model.joints, self.kinds, strict=True):
            own = [self.p[p + k] for k in range(lasting(joint, kind))]
            p += len(own)
            wanted = None
            if kind.motion in _ON_PATHS:
                since, *coefficients = (self.p[path + k] for k in range(PATH))
                wanted = polynomial(self.t - since, coefficients)
                path += PATH
            if kind.motion == "prescribed":
                assert wanted is not None
                value, rate, acceleration = wanted
                found.append(_Joint(joint, [value], [rate], [acceleration], wanted, {}))
                continue
            if kind.motion == "locked":
                still: list[Any] = [0.0] * joint.speeds
                found.append(_Joint(joint, own, still, still, None, {}))
                continue
            at = [self.y[q + k] for k in range(joint.coordinates)]
            moving = [self.y[u + k] for k in range(joint.speeds)]
            q, u = q + joint.coordinates, u + joint.speeds
            numbers: dict[str, Any] = dict(zip(SPRING, own, strict=False))
            if kind.motion == "free":
                numbers["stiffness"] = 0.0
            if wanted is not None:
                numbers = dict(zip(("stiffness", "damping"), own, strict=False))
            stops = own[-STOPS:] if kind.stopped else None
            found.append(_Joint(joint, at, moving, None, wanted, numbers, stops))
        return found

    @cached_property
    def quaternion(self) -> list[Any]:
        """Attitude, body to inertial."""
        return [self.y[k] for k in range(ATTITUDE)]

    @cached_property
    def omega(self) -> list[Any]:
        """Angular velocity in the base's axes."""
        if not self.bound:
            return [self.y[ATTITUDE + k] for k in range(RATE)]
        still: Vec = [0.0, 0.0, 0.0]
        own = momentum(self.tree, self.position, still, still, self.rate).angular
        whole = composites(self.tree, place(self.tree, self.position))[0].about_centre
        h = [self.p[self.parameters - RATE + k] for k in range(RATE)]
        left = vsub(_into_body(self.quaternion, h), own)
        return solve_symmetric(whole, [left])[0]

    @cached_property
    def position(self) -> list[Any]:
        """Coordinates of all joints."""
        return [x for j in self.joints for x in j.position]

    @cached_property
    def rate(self) -> list[Any]:
        """Speeds of all joints."""
        return [x for j in self.joints for x in j.rate]

    @cached_property
    def _driven(self) -> dict[int, Any]:
        known = [a for j in self.joints for a in (j.acceleration or [None] * len(j.rate))]
        return {k: a for k, a in enumerate(known) if a is not None}

    @cached_property
    def torques(self) -> list[Any]:
        """What acts at each joint speed: springs, dampers, pretension, compliance, tape."""
        passive = {
            f"{what}.{j.joint.name}": 0.0 if j.wanted else value
            for j in self.joints
            for what, value in j.numbers.items()
        }
        acting = spring_torques(self.model, self.position, self.rate, passive)
        follows, taped = self._outboard, iter(self._taped)
        found, place = [], 0
        for joint, kind in zip(self.joints, self.kinds, strict=True):
            for _ in joint.rate:
                load = acting[place] + joint.numbers.get("pretension", 0.0)
                if joint.wanted is not None and joint.acceleration is None:
                    by = follows[place] if kind.following else 1.0
                    value, rate, _ = joint.wanted
                    k, c = joint.numbers["stiffness"], joint.numbers["damping"]
                    load = by * (k * (value - joint.position[0]) + c * (rate - joint.rate[0]))
                    load = load + next(taped, 0.0)
                if joint.stops is not None:
                    load = load + _stopped(joint)
                found.append(load)
                place += 1
        return found

    @cached_property
    def accelerations(self) -> tuple[Vec, Vec, list[Any]]:
        """Of the base, of its centre of mass, and of all joint speeds."""
        return forward_dynamics(
            self.tree, self.position, self.omega, self.rate, self.torques, [0.0] * 3, self._driven
        )

    @cached_property
    def slope(self) -> Any:
        """The rate of the state."""
        rates = quaternion_rate(self.quaternion, self.omega)
        if not self.bound:
            alpha, _, joints = self.accelerations
            moving = [j for j in self.joints if j.acceleration is None]
            rates = [*rates, *alpha, *(x for j in moving for x in _coordinate_rates(j))]
            rates += [a for k, a in enumerate(joints) if k not in self._driven]
        return ca.vertcat(*rates)

    @cached_property
    def gauge(self) -> Any:
        """cos Θ cos Ψ (eq. 2.2) times |q|²: its sign changes at a quarter twist."""
        w, *vector = self.quaternion
        tilting, turning, twisting = in_sequence(vector, self.model.axes)
        return w * w + turning * turning - tilting * tilting - twisting * twisting

    @cached_property
    def loads(self) -> Any:
        """Moment and force that the base would need from outside, then what acts at the joints:
        the motion's own inverse dynamics, with torques that prescribed joints need."""
        alpha, acceleration, joints = self.accelerations
        moment, force, torques = inverse_dynamics(
            self.tree, self.position, self.omega, self.rate, alpha, acceleration, joints
        )
        return ca.vertcat(*moment, *force, *torques)

    @cached_property
    def _outboard(self) -> list[Any]:
        """Inertia outboard of each joint speed in the paths' pose."""
        if not any(kind.following for kind in self.kinds):
            return []
        q = [x for j in self.joints for x in (j.wanted[:1] if j.wanted else j.position)]
        return outboard_inertia(self.tree, place(self.tree, q))

    @cached_property
    def _taped(self) -> list[Any]:
        """The motor tape's torque at each compliant joint."""
        if not self.tape:
            return []
        own = [self.p[k] for k in range(PATH * self.paths, self.changing)]
        s = self.t - own[0]
        return [polynomial(s, own[k : k + TAPED])[0] for k in range(1, len(own), TAPED)]


def _stopped(joint: _Joint) -> Any:
    """What the stops do: a spring and a damper beyond the limits, which only push."""
    assert joint.stops is not None
    low, high, k, c = joint.stops
    q, u = joint.position[0], joint.rate[0]
    below, above = ca.fmax(low - q, 0.0), ca.fmax(q - high, 0.0)
    up = ca.fmax(k * below - c * u, 0.0) * (below > 0.0)
    down = ca.fmax(k * above + c * u, 0.0) * (above > 0.0)
    return up - down


def _into_body(quaternion: list[Any], vector: list[Any]) -> list[Any]:
    """An inertial vector in the body's axes, for a quaternion of any length."""
    w, x, y, z = quaternion
    size = w * w + x * x + y * y + z * z
    rows = [
        [w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)],
        [2 * (x * y - w * z), w * w - x * x + y * y - z * z, 2 * (y * z + w * x)],
        [2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z],
    ]
    return [row / size for row in matvec(rows, vector)]


def _coordinate_rates(joint: _Joint) -> list[Any]:
    if joint.joint.kind == "ball":
        return quaternion_rate(joint.position, joint.rate)
    return joint.rate


def quaternion_rate(quaternion: list[Any], omega: list[Any]) -> list[Any]:
    """½ q ω: the rate of a quaternion whose body turns at ω, in its own axes."""
    w, x, y, z = quaternion
    a, b, c = omega
    return [
        -0.5 * (x * a + y * b + z * c),
        0.5 * (w * a + y * c - z * b),
        0.5 * (w * b + z * a - x * c),
        0.5 * (w * c + x * b - y * a),
    ]
