"""The equations of motion of a model, derived once and evaluated for many samples.

Speeds are ordered (ω, v, q̇): angular velocity of a free base in its own axes, velocity of
its frame's origin in the same axes, joint speeds; without a free base only the joints'. The
accelerations that belong to them are those of the base's frame in inertial space, written in
the base's axes, so that neither attitude nor linear velocity enters the dynamics.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.checks import name_list
from somersault._core.errors import SomersaultError
from somersault.dynamics import _composite, _springs
from somersault.dynamics._articulated import forward_dynamics
from somersault.dynamics._motion import place
from somersault.dynamics._newton_euler import inverse_dynamics, momentum
from somersault.dynamics._tree import Tree, parameter_names, parameter_value, tree
from somersault.dynamics._vector import Mat, Vec, cross, matmul, scale, tilde, transpose, vadd, vsub
from somersault.engine import Kernel
from somersault.model import Model, load


@dataclass(frozen=True, eq=False)
class Expression:
    """A named quantity: its arguments (symbols, by name) and its value, a dense matrix."""

    name: str
    arguments: dict[str, Any]
    value: Any

    def function(self) -> ca.Function:
        """As a CasADi function with one argument for each name."""
        return ca.Function(
            self.name,
            list(self.arguments.values()),
            [ca.cse(ca.densify(self.value))],
            list(self.arguments),
            ["value"],
        )


class Equations:
    """Forward and inverse dynamics, mass matrix, momentum and energy of one model.

    `parameters` names numbers that stay open, so that a sweep compiles once: "mass.BODY",
    "com.BODY.1", "inertia.BODY.12", "position.BODY.2", "stiffness.JOINT", "rest.JOINT",
    "damping.JOINT"; each method then takes `parameters`, (…, number of them), and uses the
    model's own where none are given. Everything else is a constant in the compiled code.

    Arguments are arrays whose leading dimensions broadcast; results have those dimensions in
    front. Each quantity is derived and compiled when it is first asked for.
    """

    QUANTITIES = (
        "forward_dynamics",
        "inverse_dynamics",
        "mass_matrix",
        "momentum",
        "kinetic_energy",
        "spring_energy",
        "inertia",
        "outboard_inertia",
    )

    def __init__(self, model: str | Model, parameters: Sequence[str] = ()) -> None:
        self.model = model = load(model)
        self.parameters = name_list("parameters", parameters)
        known = [*parameter_names(model), *_springs.parameter_names(model)]
        for name in self.parameters:
            if name not in known:
                raise SomersaultError(
                    f"{model.name} has no parameter {name!r}; parameters are mass.BODY, "
                    "com.BODY.1, position.BODY.1, inertia.BODY.12, stiffness.JOINT, rest.JOINT and "
                    "damping.JOINT"
                )
        self._expressions: dict[str, Expression] = {}
        self._kernels: dict[Expression, Kernel] = {}

    # ------------------------------------------------------------------------- symbols

    @cached_property
    def _q(self) -> Any:
        return ca.SX.sym("q", len(self.model.coordinates))

    @cached_property
    def _v(self) -> Any:
        return ca.SX.sym("v", self.speeds)

    @cached_property
    def _p(self) -> Any:
        return ca.SX.sym("p", len(self.parameters))

    @property
    def open_parameters(self) -> Any:
        """The symbols of `parameters`, (parameters,), for expressions of one's own."""
        return self._p

    @cached_property
    def _symbols(self) -> dict[str, Any]:
        return {name: self._p[k] for k, name in enumerate(self.parameters)}

    @cached_property
    def tree(self) -> Tree:
        """The links that the equations are written for."""
        return tree(self.model, self._symbols)

    @property
    def speeds(self) -> int:
        """Degrees of freedom, a free base's six included."""
        return self._ahead + len(self.model.speeds)

    @property
    def _ahead(self) -> int:
        return 6 if self.model.free else 0

    @cached_property
    def values(self) -> Array:
        """The model's own numbers for `parameters`."""
        springs = _springs.parameter_names(self.model)
        return np.array(
            [
                _springs.parameter_value(self.model, name)
                if name in springs
                else parameter_value(self.model, name)
                for name in self.parameters
            ]
        )

    # --------------------------------------------------------------------- expressions

    def expression(self, name: str) -> Expression:
        """The symbolic form of one of the methods below, by its name."""
        if name not in self.QUANTITIES:
            raise SomersaultError(
                f"no quantity is called {name!r}; there are {', '.join(self.QUANTITIES)}"
            )
        if name not in self._expressions:
            arguments, value = getattr(self, f"_{name}")()
            whole = Expression(name, {**arguments, "parameters": self._p}, value)
            self._expressions[name] = whole
        return self._expressions[name]

    def derivative(self, name: str, argument: str) -> Expression:
        """Exact Jacobian of the expression `name` (raveled by rows) by one of its arguments."""
        expression = self.expression(name)
        if argument not in expression.arguments:
            raise SomersaultError(
                f"{name} does not depend on {argument!r}; it takes "
                f"{', '.join(expression.arguments)}"
            )
        flat = ca.vec(expression.value.T)
        value = ca.jacobian(flat, expression.arguments[argument])
        return Expression(f"{name}_by_{argument}", expression.arguments, value)

    def kernel(self, expression: Expression) -> Kernel:
        """Compiled form, of all arguments; it gives the value raveled by rows."""
        if expression not in self._kernels:
            arguments = list(expression.arguments.values())
            flat = ca.cse(ca.densify(ca.vec(expression.value.T)))
            self._kernels[expression] = Kernel(ca.Function(expression.name, arguments, [flat]))
        return self._kernels[expression]

    def evaluate(self, expression: Expression, **arguments: ArrayLike) -> Array:
        """The value of an expression for arrays of its arguments, (…, rows, columns)."""
        for name in arguments:
            if name not in expression.arguments:
                raise SomersaultError(
                    f"{expression.name} takes {', '.join(expression.arguments)}, and not {name}"
                )
        arguments.setdefault("parameters", self.values)
        kernel = self.kernel(expression)
        arrays = []
        for name, width in zip(expression.arguments, kernel.widths, strict=True):
            try:
                array = np.asarray(arguments.get(name, np.zeros(width)), float)
            except (TypeError, ValueError):
                raise SomersaultError(f"{expression.name}: {name} must be numbers") from None
            if array.shape[-1:] != (width,):
                raise SomersaultError(
                    f"{expression.name}: {name} has shape {array.shape}, but its last dimension "
                    f"must be {width}"
                )
            arrays.append(array)
        values = kernel(*arrays)
        return values.reshape(*values.shape[:-1], *expression.value.shape)

    # ------------------------------------------------------------------------- methods

    def forward_dynamics(
        self,
        q: ArrayLike,
        v: ArrayLike,
        torques: ArrayLike | None = None,
        gravity: ArrayLike | None = None,
        parameters: ArrayLike | None = None,
    ) -> Array:
        """Accelerations (…, speeds) at coordinates q and speeds v.

        `torques` (…, joint speeds; N m or N) act beside the model's springs and dampers;
        `gravity` (…, 3; m/s²) is in the base's axes.
        """
        return self._column(
            "forward_dynamics", q=q, v=v, torques=torques, gravity=gravity, parameters=parameters
        )

    def inverse_dynamics(
        self,
        q: ArrayLike,
        v: ArrayLike,
        a: ArrayLike,
        gravity: ArrayLike | None = None,
        parameters: ArrayLike | None = None,
    ) -> Array:
        """Loads (…, speeds) that give the accelerations a: moment about a free base's origin
        and force on it, in its axes, then joint torques beside the springs and dampers."""
        return self._column(
            "inverse_dynamics", q=q, v=v, a=a, gravity=gravity, parameters=parameters
        )

    def mass_matrix(self, q: ArrayLike, parameters: ArrayLike | None = None) -> Array:
        """M (…, speeds, speeds), kinetic energy ½ vᵀ M v."""
        return self.evaluate(self.expression("mass_matrix"), **_given(q=q, parameters=parameters))

    def momentum(self, q: ArrayLike, v: ArrayLike, parameters: ArrayLike | None = None) -> Array:
        """Angular momentum about the centre of mass, then linear momentum, (…, 6), in the
        base's axes. For a fixed base: about the ground's origin."""
        return self._column("momentum", q=q, v=v, parameters=parameters)

    def kinetic_energy(
        self, q: ArrayLike, v: ArrayLike, parameters: ArrayLike | None = None
    ) -> Array:
        """Kinetic energy (…) in J."""
        return self._column("kinetic_energy", q=q, v=v, parameters=parameters)[..., 0]

    def spring_energy(self, q: ArrayLike, parameters: ArrayLike | None = None) -> Array:
        """Energy (…) in J held by the joint springs."""
        return self._column("spring_energy", q=q, parameters=parameters)[..., 0]

    def inertia(self, q: ArrayLike, parameters: ArrayLike | None = None) -> Array:
        """Inertia (…, 3, 3) of the whole body about its centre of mass, in the base's axes."""
        return self.evaluate(self.expression("inertia"), **_given(q=q, parameters=parameters))

    def outboard_inertia(self, q: ArrayLike, parameters: ArrayLike | None = None) -> Array:
        """For each joint speed the inertia about its axis of all that is outboard (…, speeds)."""
        return self._column("outboard_inertia", q=q, parameters=parameters)

    def _column(self, name: str, **arguments: ArrayLike | None) -> Array:
        return self.evaluate(self.expression(name), **_given(**arguments))[..., 0]

    # ------------------------------------------------------------- the quantities, symbolic

    def _split(self, vector: Any) -> tuple[Vec, Vec, Vec]:
        items = [vector[k] for k in range(self.speeds)]
        if not self.model.free:
            return [0.0] * 3, [0.0] * 3, items
        return items[:3], items[3:6], items[6:]

    def _coordinates(self) -> list[Any]:
        return [self._q[k] for k in range(self._q.numel())]

    def _passive(self, joint_speeds: Vec) -> list[Any]:
        return _springs.torques(self.model, self._coordinates(), joint_speeds, self._symbols)

    def _forward_dynamics(self) -> tuple[dict[str, Any], Any]:
        torques = ca.SX.sym("torques", len(self.model.speeds))
        gravity = ca.SX.sym("gravity", 3)
        omega, _, speeds = self._split(self._v)
        loads = vadd(self._passive(speeds), [torques[k] for k in range(torques.numel())])
        alpha, a, joints = forward_dynamics(
            self.tree, self._coordinates(), omega, speeds, loads, [gravity[k] for k in range(3)]
        )
        if self.model.free:
            r = self.tree.base_com
            a = vsub(a, vadd(cross(alpha, r), cross(omega, cross(omega, r))))
            joints = [*alpha, *a, *joints]
        arguments = {"q": self._q, "v": self._v, "torques": torques, "gravity": gravity}
        return arguments, ca.vertcat(*joints)

    def _inverse_dynamics(self) -> tuple[dict[str, Any], Any]:
        wanted = ca.SX.sym("a", self.speeds)
        gravity = ca.SX.sym("gravity", 3)
        omega, _, speeds = self._split(self._v)
        alpha, a, accelerations = self._split(wanted)
        r = self.tree.base_com
        a = vsub(a, [gravity[k] for k in range(3)])
        if self.model.free:
            a = vadd(a, cross(alpha, r), cross(omega, cross(omega, r)))
        moment, force, torques = inverse_dynamics(
            self.tree, self._coordinates(), omega, speeds, alpha, a, accelerations
        )
        loads = vsub(torques, self._passive(speeds))
        if self.model.free:
            loads = [*vadd(moment, cross(r, force)), *force, *loads]
        arguments = {"q": self._q, "v": self._v, "a": wanted, "gravity": gravity}
        return arguments, ca.vertcat(*loads)

    def _mass_matrix(self) -> tuple[dict[str, Any], Any]:
        matrix = _composite.mass_matrix(self.tree, self._coordinates())
        if self.model.free:
            # v of the centre of mass = v of the origin + ω × r
            shift = _identity(self.speeds)
            minus = tilde(scale(-1.0, self.tree.base_com))
            for i in range(3):
                shift[3 + i][:3] = minus[i]
            matrix = matmul(transpose(shift), matmul(matrix, shift))
        return {"q": self._q}, _matrix(matrix)

    def _momentum(self) -> tuple[dict[str, Any], Any]:
        state = self._momentum_state()
        return {"q": self._q, "v": self._v}, ca.vertcat(*state.angular, *state.linear)

    def _kinetic_energy(self) -> tuple[dict[str, Any], Any]:
        return {"q": self._q, "v": self._v}, ca.SX(self._momentum_state().energy)

    def _momentum_state(self) -> Any:
        omega, v, speeds = self._split(self._v)
        v = vadd(v, cross(omega, self.tree.base_com))
        return momentum(self.tree, self._coordinates(), omega, v, speeds)

    def _spring_energy(self) -> tuple[dict[str, Any], Any]:
        return {"q": self._q}, ca.SX(
            _springs.energy(self.model, self._coordinates(), self._symbols)
        )

    def _inertia(self) -> tuple[dict[str, Any], Any]:
        if not self.model.free:
            raise SomersaultError(
                f"{self.model.name} has a fixed base, so it has no inertia of its own in the air"
            )
        placed = place(self.tree, self._coordinates())
        whole = _composite.composites(self.tree, placed)[0]
        return {"q": self._q}, _matrix(whole.about_centre)

    def _outboard_inertia(self) -> tuple[dict[str, Any], Any]:
        placed = place(self.tree, self._coordinates())
        return {"q": self._q}, ca.vertcat(*_composite.outboard_inertia(self.tree, placed))


def _given(**arguments: ArrayLike | None) -> dict[str, ArrayLike]:
    return {name: value for name, value in arguments.items() if value is not None}


def _matrix(rows: Mat) -> Any:
    return ca.vertcat(*[ca.horzcat(*row) for row in rows])


def _identity(size: int) -> Mat:
    return [[float(i == j) for j in range(size)] for i in range(size)]
