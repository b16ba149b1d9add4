"""The equations of a flight in symbols: from state, time and parameters to rates and torques."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from typing import Any

import casadi as ca

from somersault._core.errors import SomersaultError
from somersault.attitude import in_sequence
from somersault.dynamics import (
    composite_bodies,
    constrained_dynamics,
    forward_dynamics,
    inverse_dynamics,
    link_tree,
    momentum,
    outboard_inertia,
    placements,
)
from somersault.dynamics.vectors import Vec, matvec, solve_symmetric, vsub
from somersault.engine import CLOCK, clock_at
from somersault.flight._layout import ATTITUDE, RATE, TAPED, Layout, Slot, layout
from somersault.flight._plane import turning
from somersault.flight._playback import ERRORS, Playback
from somersault.flight._watch import VELOCITIES, named, nearest
from somersault.flight.behaviours import Coupled, Here, JointTakeoff, Known, Senses
from somersault.laws import Noise
from somersault.model import Model
from somersault.motion import polynomial


class Symbols:
    """State `y`, time `t` and parameters `p` of a model's flight, and what follows from them."""

    def __init__(
        self, model: Model, kinds: tuple[JointTakeoff, ...], bodies: tuple[str, ...], tape: bool,
        playback: Playback | None,
    ) -> None:  # fmt: skip
        self.model, self.bodies, self.playback = model, bodies, playback
        self.layout: Layout = layout(model, kinds, bodies, tape, playback)
        self.y = ca.SX.sym("y", self.layout.state)
        self.t = ca.SX.sym("t")
        self.p = ca.SX.sym("p", self.layout.parameters)

    @property
    def x(self) -> Any:
        """State, time and parameters joined."""
        return ca.vertcat(self.y, self.t, self.p)

    @cached_property
    def tree(self) -> Any:
        """The links, with the bodies' numbers that are parameters."""
        places = self.layout.bodies
        return link_tree(
            self.model, {n: self.p[k] for k, n in zip(places, self.bodies, strict=True)}
        )

    @cached_property
    def clock(self) -> tuple[Any, Any, Any]:
        """The phase, at which paths and tape are, its rate and its acceleration."""
        if self.playback is None:
            return self.t, 1.0, 0.0
        return clock_at(self._at(self.y, self.layout.replay[:CLOCK]), self.t)

    # ----------------------------------------------------------------------------- the joints

    @cached_property
    def here(self) -> dict[str, Here]:
        """Each joint, as its behaviour sees it."""
        return {slot.joint.name: self._here(slot) for slot in self.layout.slots}

    @cached_property
    def known(self) -> dict[str, Known]:
        """Where each joint is; accelerations are () where they follow from the equations."""
        result: dict[str, Known] = {}
        led = [s for s in self.layout.slots if isinstance(s.kind, Coupled)]
        for slot in [s for s in self.layout.slots if s not in led] + led:
            here = self.here[slot.joint.name]
            if slot.kind.in_state:
                result[slot.joint.name] = Known(here.q, here.u, slot.kind.accelerations(here))
            else:
                leader = result[slot.kind.leader] if isinstance(slot.kind, Coupled) else None
                result[slot.joint.name] = slot.kind.place(here.following(leader))
        return result

    def _here(self, slot: Slot) -> Here:
        name, kind = slot.joint.name, slot.kind
        numbers = zip(kind.parameters(slot.joint), self._at(self.p, slot.lasting), strict=True)
        phase, fast, faster = self.clock
        paths = []
        for place_ in slot.paths:
            since, *coefficients = self._at(self.p, place_)
            value, rate, bend = polynomial(phase - since, coefficients)
            paths.append((value, fast * rate, fast * fast * bend + faster * rate))
        tape: Any = 0.0
        if slot.tape:
            assert self.layout.tape is not None
            since = self.p[self.layout.tape]
            tape = polynomial(phase - since, self._at(self.p, slot.tape))[0]
        return Here(
            slot.joint, self._at(self.y, slot.q), self._at(self.y, slot.u), self.t,
            _Numbers(name, numbers), tuple(paths), self._outboard_of(name), tape,
            carried=self._at(self.y, slot.carried),
        )  # fmt: skip

    def _at(self, vector: Any, places: range) -> list[Any]:
        return [vector[k] for k in places]

    def _outboard_of(self, name: str) -> Callable[[], list[Any]]:
        return lambda: self._outboard[self.model.speed_slice(name)]

    @cached_property
    def _outboard(self) -> list[Any]:
        """Inertia outboard of each joint speed in the paths' pose."""
        q: list[Any] = []
        for slot in self.layout.slots:
            name = slot.joint.name
            where = self.known[name].q
            q += slot.kind.wanted(self.here[name]) if slot.paths else where
        return outboard_inertia(self.tree, placements(self.tree, q))

    @property
    def quantities(self) -> dict[str, Any]:
        """Angular velocity, joint coordinates and rates by name; a rate's name is its joint speed's
        with "_rate"."""
        names = [*VELOCITIES, *self.model.coordinates, *(f"{n}_rate" for n in self.model.speeds)]
        return dict(zip(names, [*self.omega, *self.position, *self.rate], strict=True))

    # ------------------------------------------------------------------------------- the body

    @cached_property
    def quaternion(self) -> list[Any]:
        """Attitude, body to inertial."""
        return [self.y[0], *self.tree.kept([self.y[1 + k] for k in range(3)])]

    @cached_property
    def omega(self) -> list[Any]:
        """Angular velocity in the base's axes."""
        if not self.layout.bound:
            return self.tree.kept([self.y[ATTITUDE + k] for k in range(RATE)])
        still: Vec = [0.0, 0.0, 0.0]
        of_joints = momentum(self.tree, self.position, still, still, self.rate).angular
        whole = composite_bodies(self.tree, placements(self.tree, self.position))[0].about_centre
        h = self._at(self.p, self.layout.momentum)
        left = vsub(_into_body(self.quaternion, h), of_joints)
        ways = turning(self.model)
        part = [[whole[i][j] for j in ways] for i in ways]
        rates = dict(zip(ways, solve_symmetric(part, [[left[k] for k in ways]])[0], strict=True))
        return [rates.get(k, 0.0) for k in range(3)]

    @cached_property
    def position(self) -> list[Any]:
        """Coordinates of all joints."""
        return [x for slot in self.layout.slots for x in self.known[slot.joint.name].q]

    @cached_property
    def rate(self) -> list[Any]:
        """Speeds of all joints."""
        return [x for slot in self.layout.slots for x in self.known[slot.joint.name].u]

    @cached_property
    def _driven(self) -> dict[int, Any]:
        """Accelerations that are known, by the place of the joint speed."""
        result: dict[int, Any] = {}
        for slot in self.layout.slots:
            first = self.model.speed_slice(slot.joint.name).start
            result |= enumerate(self.known[slot.joint.name].a, first)
        return result

    @cached_property
    def torques(self) -> list[Any]:
        """What acts at each joint speed; 0 where the joint is moved, whatever it takes."""
        result: list[Any] = []
        for slot in self.layout.slots:
            here, known = self.here[slot.joint.name], self.known[slot.joint.name]
            moved = len(known.a) > 0
            result += [0.0] * slot.joint.speeds if moved else slot.kind.loads(here.at(known))
        return result

    @cached_property
    def _geared(self) -> dict[int, tuple[int, Any]]:
        """For the place of a joint speed that follows one that moves freely: the leader's place,
        and the factor between them."""
        result: dict[int, tuple[int, Any]] = {}
        for slot in self.layout.slots:
            if isinstance(slot.kind, Coupled) and not self.known[slot.joint.name].a:
                own, leader = (
                    self.model.speed_slice(name).start
                    for name in (slot.joint.name, slot.kind.leader)
                )
                result[own] = leader, self.here[slot.joint.name].numbers["factor"]
        return result

    @property
    def gravity(self) -> Vec:
        """As it is felt: a body that falls freely feels none."""
        return [0.0, 0.0, 0.0]

    @cached_property
    def accelerations(self) -> tuple[Vec, Vec, list[Any]]:
        """Of the base, of its centre of mass, and of all joint speeds."""
        moving = (self.tree, self.position, self.omega, self.rate, self.torques, self.gravity)
        if self._geared:
            return constrained_dynamics(*moving, self._driven, self._geared)
        return forward_dynamics(*moving, self._driven)

    @cached_property
    def slope(self) -> Any:
        """The rate of the state, but for what is carried."""
        rates = quaternion_rate(self.quaternion, self.omega)
        if not self.layout.bound:
            alpha, _, _ = self.accelerations
            rates = [*rates, *alpha, *self.joint_rates]
        return ca.vertcat(*rates)

    @cached_property
    def joint_rates(self) -> list[Any]:
        """The rates of coordinates and speeds of the joints in the state."""
        _, _, joints = self.accelerations
        moving = [slot.joint for slot in self.layout.slots if slot.kind.in_state]
        rates: list[Any] = []
        for joint in moving:
            here = self.here[joint.name]
            rates += quaternion_rate(here.q, here.u) if joint.kind == "ball" else here.u
        for joint in moving:
            rates += joints[self.model.speed_slice(joint.name)]
        return rates

    @cached_property
    def sensed(self) -> tuple[list[Any], dict[str, Any]]:
        """Somersault, tilt and twist, and all that can be sensed by name."""
        axes = self.model.axes
        angles = nearest(self.quaternion, self._at(self.y, self.layout.sensed), axes)
        return angles, named(lambda *_: self.quantities, angles, self.y, self.t, self.p, axes)

    @cached_property
    def tick(self) -> Any:
        """What is carried, as it is from a tick on; None where nothing is."""
        where = self.layout
        if where.every is None:
            return None
        angles, known = self.sensed
        noise = Noise(self._at(self.y, where.noise))
        known["time"] = self.t
        if self.playback is not None:
            known["phase"], known["phase_rate"], _ = self.clock
        senses = Senses(known, noise.normal)
        own: list[Any] = []
        if self.playback is not None:
            names = self.playback.parameters
            numbers = dict(zip(names, self._at(self.p, where.replay_numbers), strict=True))
            perceived = Senses({**known, **self._errors(known)}, noise.normal)
            own += self.playback.tick(self._at(self.y, where.replay), self.t, numbers, perceived)
        for slot in where.slots:
            if slot.kind.sensing is not None:
                own += slot.kind.sensing.tick(self.here[slot.joint.name], senses)
        return ca.vertcat(*angles, *noise.state, *own)

    def _errors(self, known: Mapping[str, Any]) -> dict[str, Any]:
        """What is sensed less what it was in the nominal flight at the same phase; of those that
        the replay's law does not have, the names."""
        assert self.playback is not None
        result = dict.fromkeys(ERRORS, 0.0)
        if self.playback.errors:
            since, *powers = self._at(self.p, self.layout.nominal)
            for k, name in enumerate(self.playback.errors):
                own = powers[TAPED * k : TAPED * (k + 1)]
                nominal, _, _ = polynomial(self.clock[0] - since, own)
                result[name] = known[ERRORS[name]] - nominal
        return result

    @cached_property
    def gauge(self) -> Any:
        """cos Θ cos Ψ (eq. 2.2) times |q|²: its sign changes at a quarter twist."""
        w, *vector = self.quaternion
        tilting, turning, twisting = in_sequence(vector, self.model.axes)
        return w * w + turning * turning - tilting * tilting - twisting * twisting

    @cached_property
    def inverse(self) -> Any:
        """Moment and force that the base would need from outside, then what acts at the joints:
        the motion's own inverse dynamics, with torques that prescribed joints need."""
        alpha, acceleration, joints = self.accelerations
        moment, force, torques = inverse_dynamics(
            self.tree, self.position, self.omega, self.rate, alpha,
            vsub(acceleration, self.gravity), joints,
        )  # fmt: skip
        return ca.vertcat(*moment, *force, *torques)


class _Numbers(dict[str, Any]):
    """A joint's parameters by name, and a sentence for one that its behaviour does not name."""

    def __init__(self, joint: str, numbers: Iterable[tuple[str, Any]]) -> None:
        super().__init__(numbers)
        self._joint = joint

    def __missing__(self, name: str) -> Any:
        raise SomersaultError(
            f"joint {self._joint} has no number {name!r} in its equations; its behaviour must name "
            "it in springs() or parameters()"
        )


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
