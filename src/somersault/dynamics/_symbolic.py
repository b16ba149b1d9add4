"""The equations of motion of a model in symbols.

Speeds are ordered (ω, v, q̇): angular velocity of a free base in its own axes, velocity of
its frame's origin in the same axes, joint speeds; without a free base only the joints'. The
accelerations that belong to them are those of the base's frame in inertial space, written in
the base's axes, so that neither attitude nor linear velocity enters the dynamics. A planar model
has the same speeds; forward dynamics hold it in its plane.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import casadi as ca

from somersault._core.checks import name_list, shown, text
from somersault._core.errors import SomersaultError
from somersault.dynamics import _composite, _springs
from somersault.dynamics._articulated import forward_dynamics
from somersault.dynamics._motion import placements
from somersault.dynamics._newton_euler import Momentum, inverse_dynamics, momentum
from somersault.dynamics._parameters import parameter_values
from somersault.dynamics._tree import Tree, link_tree
from somersault.dynamics.vectors import Mat, Vec, cross, matmul, scale, tilde, transpose, vadd, vsub
from somersault.model import Model, load


@dataclass(frozen=True, eq=False)
class Expression:
    """A named quantity: its arguments (symbols, by name) and its value, a dense matrix."""

    name: str
    arguments: dict[str, Any]
    value: Any

    def function(self) -> ca.Function:
        """The expression as a CasADi function.

        Returns
        -------
        casadi.Function
            With one argument for each name.
        """
        return ca.Function(
            self.name,
            list(self.arguments.values()),
            [ca.cse(ca.densify(self.value))],
            list(self.arguments),
            ["value"],
        )


class SymbolicEquations:
    """Quantities of one model as expressions of symbols; `Equations` evaluates them."""

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
        known = parameter_values(model)
        for name in self.parameters:
            if name not in known:
                raise SomersaultError(
                    f"{model.name} has no parameter {shown(name)}; those are bodies.BODY.mass, "
                    "bodies.BODY.com.1, bodies.BODY.position.1, bodies.BODY.inertia.12, "
                    "joints.JOINT.stiffness, joints.JOINT.rest and joints.JOINT.damping"
                )
        self._expressions: dict[str, Expression] = {}

    # ------------------------------------------------------------------------- symbols

    @cached_property
    def _q(self) -> Any:
        return ca.SX.sym("q", len(self.model.coordinates))

    @cached_property
    def _v(self) -> Any:
        return ca.SX.sym("v", self.speeds)

    @cached_property
    def open_parameters(self) -> Any:
        """A symbol for each of `parameters`."""
        return ca.SX.sym("p", len(self.parameters))

    @cached_property
    def _symbols(self) -> dict[str, Any]:
        return {name: self.open_parameters[k] for k, name in enumerate(self.parameters)}

    @cached_property
    def tree(self) -> Tree:
        """The links that the equations are written for."""
        return link_tree(self.model, self._symbols)

    @property
    def speeds(self) -> int:
        """Degrees of freedom, a free base's six included."""
        return self._ahead + len(self.model.speeds)

    @property
    def _ahead(self) -> int:
        return 6 if self.model.free else 0

    # --------------------------------------------------------------------- expressions

    def expression(self, name: str) -> Expression:
        """The symbolic form of a quantity.

        Parameters
        ----------
        name
            One of `QUANTITIES`.

        Returns
        -------
        Expression

        Raises
        ------
        SomersaultError
            For any other name, and for "inertia" of a fixed base.

        Examples
        --------
        >>> import somersault as so
        >>> so.Equations("furrer").expression("mass_matrix").value.shape
        (8, 8)
        """
        if text("name", name) not in self.QUANTITIES:
            raise SomersaultError(
                f"no quantity is called {shown(name)}; there are {', '.join(self.QUANTITIES)}"
            )
        if name not in self._expressions:
            arguments, value = getattr(self, f"_{name}")()
            whole = Expression(name, {**arguments, "parameters": self.open_parameters}, value)
            self._expressions[name] = whole
        return self._expressions[name]

    def derivative(self, name: str, argument: str) -> Expression:
        """Exact Jacobian of a quantity by one of its arguments.

        Parameters
        ----------
        name
            One of `QUANTITIES`, whose value is raveled by rows.
        argument
            The name of one of its arguments.

        Returns
        -------
        Expression

        Raises
        ------
        SomersaultError
            If there is no such quantity, or it has no such argument.

        Examples
        --------
        >>> import somersault as so
        >>> equations = so.Equations("furrer")
        >>> by_q = equations.derivative("forward_dynamics", "q")
        >>> equations.evaluate(by_q, q=[1.4, -1.4]).shape
        (8, 2)
        """
        expression = self.expression(name)
        if text("argument", argument) not in expression.arguments:
            raise SomersaultError(
                f"{name} does not depend on {shown(argument)}; it takes "
                f"{', '.join(expression.arguments)}"
            )
        flat = ca.vec(expression.value.T)
        value = ca.jacobian(flat, expression.arguments[argument])
        return Expression(f"{name}_by_{argument}", expression.arguments, value)

    def casadi(self, name: str) -> ca.Function:
        """A quantity as a function of CasADi's, for optimal control of one's own.

        It takes numbers, SX or MX, is differentiated as any other, and needs nothing of this
        package once it is there: `function.save`, and `casadi.CodeGenerator`, write it to a file.

        Parameters
        ----------
        name
            One of `QUANTITIES`.

        Returns
        -------
        casadi.Function
            Its inputs are named as the arguments of the method of that name, without those that
            are empty: q, v, a, torques, gravity, and `parameters` where some stayed open; those
            that are left out in a call by name are zero, parameters too. Its output is called as
            the quantity.

        Raises
        ------
        SomersaultError
            For any other name, and for "inertia" of a fixed base.

        Examples
        --------
        >>> import somersault as so
        >>> momentum = so.Equations("furrer").casadi("momentum")
        >>> momentum
        Function(momentum:(q[2],v[8])->(momentum[6]) SXFunction)
        >>> momentum(q=[1.4, -1.4], v=[0, 8.64, 0, 0, 0, 0, 0, 0])["momentum"].shape
        (6, 1)
        """
        expression = self.expression(name)
        given = {n: symbol for n, symbol in expression.arguments.items() if symbol.numel()}
        value = ca.cse(ca.densify(expression.value))
        return ca.Function(name, [*given.values()], [value], [*given], [name])

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
        omega = self.tree.kept(omega)
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

    def _momentum_state(self) -> Momentum:
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
        placed = placements(self.tree, self._coordinates())
        whole = _composite.composite_bodies(self.tree, placed)[0]
        return {"q": self._q}, _matrix(whole.about_centre)

    def _outboard_inertia(self) -> tuple[dict[str, Any], Any]:
        placed = placements(self.tree, self._coordinates())
        return {"q": self._q}, ca.vertcat(*_composite.outboard_inertia(self.tree, placed))


def _matrix(rows: Mat) -> Any:
    return ca.vertcat(*[ca.horzcat(*row) for row in rows])


def _identity(size: int) -> Mat:
    return [[float(i == j) for j in range(size)] for i in range(size)]
