"""The equations of motion of a model, derived once and evaluated for many samples."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.checks import instance
from somersault._core.errors import SomersaultError
from somersault._core.numbers import floats
from somersault.dynamics._parameters import parameter_values
from somersault.dynamics._symbolic import Expression, SymbolicEquations
from somersault.engine import Kernel
from somersault.model import Model


class Equations(SymbolicEquations):
    """Forward and inverse dynamics, mass matrix, momentum and energy of one model.

    Speeds are ordered (ω, v, q̇): angular velocity of a free base in its own axes, velocity of its
    frame's origin in the same axes, joint speeds; without a free base only the joints'. The
    accelerations that belong to them are those of the base's frame in inertial space, written in
    the base's axes. A planar model has all of these speeds too: its forward dynamics take no notice
    of those out of its plane, and give zero for their accelerations; the other quantities are those
    of the same model free in space.

    Arguments of the methods are arrays whose leading dimensions broadcast; results have those
    dimensions in front. Each quantity is derived and compiled when it is first asked for.

    Parameters
    ----------
    model
        A model, the name of one that ships, or a file.
    parameters
        Names of numbers that stay open, so that a sweep compiles once: "bodies.BODY.mass",
        "bodies.BODY.com.1", "bodies.BODY.inertia.12", "bodies.BODY.position.2",
        "joints.JOINT.stiffness", "joints.JOINT.rest", "joints.JOINT.damping". Each method then
        takes `parameters` (…, number of names), and uses the model's own numbers where none are
        given. Moments of inertia go along with a mass that is open, unless one of the body's is
        open too. Everything else is a constant in the compiled code.

    Attributes
    ----------
    model : Model
        The model.
    parameters : tuple of str
        The names that were given.
    values : array
        The model's own numbers for them.

    Raises
    ------
    SomersaultError
        For a model that cannot be read, or a name that is none of its numbers; by the methods,
        for arguments that are no numbers or of another shape.

    Examples
    --------
    >>> import somersault as so
    >>> equations = so.Equations("furrer")
    >>> equations.speeds  # of the base six, of the shoulders two
    8
    >>> equations.forward_dynamics([1.4, -1.4], [0, 8.64, 0, 0, 0, 0, 0, 0]).shape
    (8,)
    """

    def __init__(self, model: str | Model, parameters: Sequence[str] = ()) -> None:
        super().__init__(model, parameters)
        self._kernels: dict[Expression, Kernel] = {}

    @cached_property
    def values(self) -> Array:
        """The model's own numbers for `parameters`."""
        known = parameter_values(self.model)
        return np.array([known[name] for name in self.parameters])

    def kernel(self, expression: Expression) -> Kernel:
        """The compiled form of an expression.

        Parameters
        ----------
        expression : Expression
            From `expression` or `derivative`, or made elsewhere of the same symbols.

        Returns
        -------
        Kernel
            A function of all its arguments, in order; its result is the value, row by row.

        Examples
        --------
        >>> import somersault as so
        >>> equations = so.Equations("furrer")
        >>> equations.kernel(equations.expression("mass_matrix")).outputs  # 8 × 8
        64
        """
        instance("expression", expression, Expression)
        if expression not in self._kernels:
            arguments = list(expression.arguments.values())
            flat = ca.cse(ca.densify(ca.vec(expression.value.T)))
            self._kernels[expression] = Kernel(ca.Function(expression.name, arguments, [flat]))
        return self._kernels[expression]

    def evaluate(self, expression: Expression, **arguments: ArrayLike) -> Array:
        """The value of an expression.

        Parameters
        ----------
        expression
            From `expression`, `derivative`, or made elsewhere of the same symbols.
        **arguments
            Arrays (…, numbers of the argument) by the arguments' names; zero where not given, and
            `parameters` the model's own.

        Returns
        -------
        array (…, rows, columns)

        Raises
        ------
        SomersaultError
            For arguments that the expression does not have, or that do not fit it.

        Examples
        --------
        >>> import somersault as so
        >>> equations = so.Equations("furrer")
        >>> inertia = equations.expression("inertia")
        >>> equations.evaluate(inertia, q=[1.4, -1.4]).shape
        (3, 3)
        """
        instance("expression", expression, Expression)
        for name in arguments:
            if name not in expression.arguments:
                raise SomersaultError(
                    f"{expression.name} takes {', '.join(expression.arguments)}, and not {name}"
                )
        arguments.setdefault("parameters", self.values)
        kernel = self.kernel(expression)
        arrays = []
        for name, width in zip(expression.arguments, kernel.widths, strict=True):
            array = floats(f"{expression.name}: {name}", arguments.get(name, np.zeros(width)))
            if array.shape[-1:] != (width,):
                raise SomersaultError(
                    f"{expression.name}: {name} has shape {array.shape}, but its last dimension "
                    f"must be {width}"
                )
            arrays.append(array)
        try:
            values = kernel(*arrays)
        except ValueError:
            named = zip(expression.arguments, arrays, strict=True)
            shapes = ", ".join(f"{name} {array.shape}" for name, array in named)
            raise SomersaultError(
                f"{expression.name}: leading dimensions do not go together: {shapes}"
            ) from None
        return values.reshape(*values.shape[:-1], *expression.value.shape)

    def forward_dynamics(
        self,
        q: ArrayLike,
        v: ArrayLike,
        torques: ArrayLike | None = None,
        gravity: ArrayLike | None = None,
        parameters: ArrayLike | None = None,
    ) -> Array:
        """Accelerations at coordinates q and speeds v.

        Parameters
        ----------
        q : array (…, coordinates)
            Joint coordinates, rad or m; a ball's is a unit quaternion, scalar first.
        v : array (…, speeds)
            (ω, velocity of the base's origin, joint speeds) in the base's axes; without a free base
            the joint speeds alone. rad/s or m/s.
        torques : array (…, joint speeds), optional
            What acts at the joints besides the model's springs and dampers, N m or N.
        gravity : array (…, 3), optional
            In the base's axes, m/s².
        parameters : array (…, parameters), optional
            Numbers for the names that stayed open.

        Returns
        -------
        array (…, speeds)
            The accelerations that belong to v, of the base's frame in inertial space.

        Examples
        --------
        >>> import somersault as so
        >>> equations = so.Equations("book")
        >>> spin = equations.forward_dynamics([], [0.0, 3.0, 0.0, 0.0, 0.0, 0.0])
        >>> bool(abs(spin).max() < 1e-12)  # a spin about a principal axis is steady
        True
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
        """Loads that give the accelerations a.

        Parameters
        ----------
        q, v, gravity, parameters
            As for `forward_dynamics`.
        a : array (…, speeds)
            Accelerations as `forward_dynamics` returns them.

        Returns
        -------
        array (…, speeds)
            Moment about a free base's origin and force on it, in its axes, then what must act at
            the joints besides the springs and dampers.

        Examples
        --------
        >>> import somersault as so
        >>> equations = so.Equations("furrer")
        >>> spin = [0.0, 8.64, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
        >>> holding = equations.inverse_dynamics([1.4, -1.4], spin, [0.0] * 8)[6:]
        >>> holding.shape  # what holds the arms against the spin, N m
        (2,)
        """
        return self._column(
            "inverse_dynamics", q=q, v=v, a=a, gravity=gravity, parameters=parameters
        )

    def mass_matrix(self, q: ArrayLike, parameters: ArrayLike | None = None) -> Array:
        """The mass matrix M, of which the kinetic energy is ½ vᵀ M v.

        Parameters
        ----------
        q, parameters
            As for `forward_dynamics`.

        Returns
        -------
        array (…, speeds, speeds)

        Examples
        --------
        >>> import somersault as so
        >>> so.Equations("furrer").mass_matrix([1.4, -1.4]).shape
        (8, 8)
        """
        return self.evaluate(self.expression("mass_matrix"), **_given(q=q, parameters=parameters))

    def momentum(self, q: ArrayLike, v: ArrayLike, parameters: ArrayLike | None = None) -> Array:
        """Angular and linear momentum.

        Parameters
        ----------
        q, v, parameters
            As for `forward_dynamics`.

        Returns
        -------
        array (…, 6)
            Angular momentum about the centre of mass (for a fixed base about the ground's origin),
            kg m²/s, then linear momentum, kg m/s, in the base's axes.

        Examples
        --------
        >>> import somersault as so
        >>> equations = so.Equations("furrer")
        >>> momentum = equations.momentum([1.4, -1.4], [0.0, 8.64, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
        >>> momentum.shape
        (6,)
        """
        return self._column("momentum", q=q, v=v, parameters=parameters)

    def kinetic_energy(
        self, q: ArrayLike, v: ArrayLike, parameters: ArrayLike | None = None
    ) -> Array:
        """Kinetic energy.

        Parameters
        ----------
        q, v, parameters
            As for `forward_dynamics`.

        Returns
        -------
        array (…)
            J.

        Examples
        --------
        >>> import somersault as so
        >>> equations = so.Equations("furrer")
        >>> float(equations.kinetic_energy([1.4, -1.4], [0.0] * 8))
        0.0
        """
        return self._column("kinetic_energy", q=q, v=v, parameters=parameters)[..., 0]

    def spring_energy(self, q: ArrayLike, parameters: ArrayLike | None = None) -> Array:
        """Energy held by the joint springs.

        Parameters
        ----------
        q, parameters
            As for `forward_dynamics`.

        Returns
        -------
        array (…)
            J.

        Examples
        --------
        >>> import somersault as so
        >>> float(so.Equations("furrer").spring_energy([1.4, -1.4]))  # its joints have no springs
        0.0
        """
        return self._column("spring_energy", q=q, parameters=parameters)[..., 0]

    def inertia(self, q: ArrayLike, parameters: ArrayLike | None = None) -> Array:
        """Inertia of the whole body about its centre of mass, in the base's axes.

        Parameters
        ----------
        q, parameters
            As for `forward_dynamics`.

        Returns
        -------
        array (…, 3, 3)
            kg m².

        Raises
        ------
        SomersaultError
            For a model whose base is fixed.

        Examples
        --------
        >>> import somersault as so
        >>> so.Equations("furrer").inertia([[0.0, 0.0], [1.4, -1.4]]).shape
        (2, 3, 3)
        """
        return self.evaluate(self.expression("inertia"), **_given(q=q, parameters=parameters))

    def outboard_inertia(self, q: ArrayLike, parameters: ArrayLike | None = None) -> Array:
        """The inertia of all that is outboard of a joint, about its axis: the I of K = k/(Ω² I).

        Parameters
        ----------
        q, parameters
            As for `forward_dynamics`.

        Returns
        -------
        array (…, joint speeds)
            kg m²; for a slide the mass, kg.

        Examples
        --------
        >>> import somersault as so
        >>> so.Equations("furrer").outboard_inertia([1.4, -1.4]).shape
        (2,)
        """
        return self._column("outboard_inertia", q=q, parameters=parameters)

    def _column(self, name: str, **arguments: ArrayLike | None) -> Array:
        return self.evaluate(self.expression(name), **_given(**arguments))[..., 0]


def _given(**arguments: ArrayLike | None) -> dict[str, ArrayLike]:
    return {name: value for name, value in arguments.items() if value is not None}
