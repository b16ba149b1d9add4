"""The physics at one moment of a plan: how the attitude turns, and what the joints need.

The centre of mass falls by itself and the angular momentum stays, so that only the attitude has a
differential equation: ω = A⁻¹ (Rᵀ h − B q̇). Where all joints' accelerations are known, inverse
dynamics give the torques.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import casadi as ca
import numpy as np

from somersault._core.array import Array
from somersault.attitude import sequence_rates
from somersault.dynamics import (
    composite_bodies,
    inverse_dynamics,
    link_tree,
    momentum,
    placements,
    spring_torques,
)
from somersault.dynamics.vectors import Vec, cross, scale, solve_symmetric, vadd, vsub
from somersault.engine import Kernel
from somersault.model import Model
from somersault.planning._joints import Moving

TURNING = 3  # rates of somersault, tilt and twist, before the torques
MOMENTUM = 3


class Point:
    """The function at one point, and its derivatives, compiled.

    Time is counted in units of the flight's duration T. Arguments are somersault, tilt and twist;
    coordinates, rates and accelerations of the joints that move; the angular momentum times T; and
    T. Outputs are the rates of the three angles, the torques at the moving joints in units of
    their own, and T times the sum of the squares of these.
    """

    def __init__(self, model: Model, moving: Moving) -> None:
        self.model, self.moving = model, moving
        count = len(moving.joints)
        self.widths = (3, count, count, count, MOMENTUM, 1)
        self.arguments: int = sum(self.widths)
        self.outputs: int = TURNING + count + 1

    @cached_property
    def _x(self) -> Any:
        return ca.SX.sym("x", self.arguments)

    @cached_property
    def _value(self) -> Any:
        """The outputs in symbols."""
        angles, q, v, w, h, (time,) = self._parts()
        u = [x / time for x in v]
        a = [x / time**2 for x in w]
        tree = link_tree(self.model, {})
        coordinates = self.moving.coordinates(q)
        speeds, accelerations = self.moving.speeds(u), self.moving.speeds(a)
        still: Vec = [0.0, 0.0, 0.0]
        of_joints = momentum(tree, coordinates, still, still, speeds).angular
        whole = composite_bodies(tree, placements(tree, coordinates))[0]
        inside = _into_body(angles, [x / time for x in h], self.model.axes)
        inertia = whole.about_centre
        omega = solve_symmetric(inertia, [vsub(inside, of_joints)])[0]
        # What the motion would need from outside if the base did not accelerate, it does not get:
        # the whole turns about its centre of mass, and that stays.
        moving = (tree, coordinates, omega, speeds)
        moment, force, _ = inverse_dynamics(*moving, still, still, accelerations)
        centre = whole.centre
        about = vsub(moment, cross(centre, force))
        alpha = solve_symmetric(inertia, [scale(-1.0, about)])[0]
        shift = vadd(scale(-1.0 / whole.mass, force), cross(centre, alpha))
        _, _, needed = inverse_dynamics(*moving, alpha, shift, accelerations)
        passive = self._springs(coordinates, speeds)
        torques = self.moving.loads([x - y for x, y in zip(needed, passive, strict=True)])
        shares = [x / unit for x, unit in zip(torques, self.moving.units, strict=True)]
        _, tilt, twist = angles
        rates = sequence_rates(
            (ca.sin(tilt), ca.cos(tilt)), (ca.sin(twist), ca.cos(twist)), omega, self.model.axes
        )
        effort = time * sum(x * x for x in shares)
        return ca.cse(ca.densify(ca.vertcat(*[time * x for x in rates], *shares, effort)))

    def _parts(self) -> list[list[Any]]:
        parts, first = [], 0
        for width in self.widths:
            parts.append([self._x[first + k] for k in range(width)])
            first += width
        return parts

    def _springs(self, coordinates: list[Any], speeds: list[Any]) -> list[Any]:
        result: list[Any] = []
        for joint in self.model.joints:
            own = coordinates[self.model.coordinate_slice(joint.name)]
            rates = speeds[self.model.speed_slice(joint.name)]
            result += spring_torques(joint, own, rates, joint.stiffness, joint.rest, joint.damping)
        return result

    # ------------------------------------------------------------------------------- compiled

    @cached_property
    def value(self) -> Kernel:
        """Arguments to outputs."""
        return Kernel(ca.Function("point", [self._x], [ca.cse(self._value)]))

    def jacobian(self, x: Array) -> Array:
        """Derivatives that are not always zero, (points, derivatives), at arguments x."""
        outputs, arguments = self.jacobian_places
        return self._slope(x[:, None], np.eye(self.outputs))[:, outputs, arguments]

    @cached_property
    def jacobian_places(self) -> tuple[Array, Array]:
        """Outputs and arguments of these derivatives."""
        return _triplet(ca.jacobian_sparsity(self._value, self._x))

    def hessian(self, x: Array, multipliers: Array) -> Array:
        """Second derivatives of the outputs' sum, each times its multiplier, at arguments x: those
        at and below the diagonal that are not always zero, (points, derivatives)."""
        first, second = self.hessian_places
        whole = self._bend(x[:, None], multipliers[:, None], np.eye(self.arguments))
        return whole[:, second, first]

    @cached_property
    def hessian_places(self) -> tuple[Array, Array]:
        """The pairs of arguments of these."""
        return _triplet(ca.tril(ca.jacobian_sparsity(self._symbolic_slope, self._x)))

    @cached_property
    def _multipliers(self) -> Any:
        return ca.SX.sym("m", self.outputs)

    @cached_property
    def _symbolic_slope(self) -> Any:
        return ca.cse(ca.gradient(ca.dot(self._multipliers, self._value), self._x))

    @cached_property
    def _slope(self) -> Kernel:
        """The gradient of the outputs' sum, each times its multiplier."""
        function = ca.Function("slope", [self._x, self._multipliers], [self._symbolic_slope])
        return Kernel(function)

    @cached_property
    def _bend(self) -> Kernel:
        """The gradient's derivative in a direction: one of these for each argument takes longer
        to compute than all second derivatives at once, and much less to compile."""
        along = ca.SX.sym("d", self.arguments)
        bend = ca.cse(ca.densify(ca.jtimes(self._symbolic_slope, self._x, along)))
        return Kernel(ca.Function("bend", [self._x, self._multipliers, along], [bend]))


def _triplet(sparsity: Any) -> tuple[Array, Array]:
    rows, columns = sparsity.get_triplet()
    return np.array(rows, int), np.array(columns, int)


def _into_body(angles: list[Any], vector: list[Any], axes: tuple[int, int, int]) -> list[Any]:
    """An inertial vector in the body's axes: R_a(Φ) R_b(Θ) R_c(Ψ) turned back."""
    result = list(vector)
    for angle, axis in zip(angles, axes, strict=True):
        i, j = axis % 3, (axis + 1) % 3
        s, c = ca.sin(angle), ca.cos(angle)
        result[i], result[j] = c * result[i] + s * result[j], c * result[j] - s * result[i]
    return result
