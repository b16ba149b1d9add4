"""The motion of a spinning body with sprung joints at one angular momentum, not linearised."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.dynamics import Equations
from somersault.model import Model
from somersault.stability._coordinates import columns_of
from somersault.stability._principal import cycle
from somersault.stability._steady import equations_of
from somersault.stability._types import LinearSpin


@dataclass(frozen=True, eq=False)
class ReducedMotion:
    """Rates of change of a state at one angular momentum, dampers aside.

    The state is (m, c, ċ): the angular momentum in the base's axes in units of that of the spin,
    joints' motions as the linear coordinates have them, and their rates. Ω is 1 rad/s.
    """

    model: Model
    axis: int
    axes: Array
    """Principal axes as columns, (3, 3)."""
    pose: Array
    inertia: float
    """About the axis of spin, kg m²."""
    moves: Array
    """Joint speeds for each of the motions, (speeds, n)."""
    springs: Array
    """Over these motions, kg m², (n, n)."""

    @cached_property
    def steady(self) -> Array:
        """The spin's own state, (3 + 2 n,)."""
        return np.concatenate([self.axes[:, self.axis - 1], np.zeros(2 * self.moves.shape[1])])

    @cached_property
    def _equations(self) -> Equations:
        bodies = tuple(
            replace(body, joints=tuple(replace(j, stiffness=0.0, damping=0.0) for j in body.joints))
            for body in self.model.bodies
        )
        return equations_of(replace(self.model, bodies=bodies), ())

    @cached_property
    def _holding(self) -> Array:
        (mass,), _, (bias,) = self._velocities(self.steady[None])
        return bias[6:] - mass[6:, :6] @ np.linalg.solve(mass[:6, :6], bias[:6])

    def rates(self, states: Array) -> Array:
        """Derivatives of states (N, 3 + 2 n)."""
        mass, velocities, bias = self._velocities(states)
        n = self.moves.shape[1]
        angular = velocities[:, :3]
        force = -bias
        force[:, 6:] += self._holding - states[:, 3 : 3 + n] @ self.springs
        accelerations = np.linalg.solve(mass, force[..., None])[:, 6:, 0]
        turned = np.cross(states[:, :3], angular)
        return np.concatenate([turned, states[:, 3 + n :], accelerations], 1)

    def amplitude(self, change: Array) -> complex:
        """The largest of tilt, twist and joints' motions in a change of state (3 + 2 n,)."""
        before, _, after = cycle(self.axis)
        m = self.axes.T @ change[:3]
        angles = np.concatenate([[-m[after], m[before]], change[3 : 3 + self.moves.shape[1]]])
        return complex(angles[np.argmax(np.abs(angles))])

    def turned(self, which: int) -> Array:
        """The change of state (3 + 2 n,) by a small tilt (0) or twist (1)."""
        about = self.model.axes[1 + which] - 1
        change = np.zeros(len(self.steady))
        change[:3] = -np.cross(np.eye(3)[about], self.steady[:3])
        return change

    def _velocities(self, states: Array) -> tuple[Array, Array, Array]:
        """The mass matrix, the velocities and what they need without accelerating, over the base's
        turning and going and the motions."""
        n = self.moves.shape[1]
        columns = np.zeros((6 + len(self.moves), 6 + n))
        columns[:6, :6], columns[6:, 6:] = np.eye(6), self.moves
        q = self.pose + states[:, 3 : 3 + n] @ self.moves.T
        rates = states[:, 3 + n :]
        mass = columns.T @ self._equations.mass_matrix(q) @ columns
        kept = np.zeros((len(states), 6))
        kept[:, :3] = self.inertia * states[:, :3]
        kept -= np.einsum("nij,nj->ni", mass[:, :6, 6:], rates)
        base = np.linalg.solve(mass[:, :6, :6], kept[..., None])[..., 0]
        velocities = np.concatenate([base, rates], 1)
        v = velocities @ columns.T
        bias = self._equations.inverse_dynamics(q, v, np.zeros_like(v)) @ columns
        return mass, velocities, bias


def reduced_motion(spin: LinearSpin) -> ReducedMotion:
    """The motion that a linear system is of; SomersaultError where a ball joint moves."""
    steady, joints = spin.spin, spin.system.joints
    model = steady.model
    moves = columns_of(model, steady.axis, [spin.coordinates[k] for k in joints])
    if len(model.coordinates) != len(model.speeds):
        raise SomersaultError(
            f"{model.name} has a ball joint, and its larger motions are not known here; make three "
            "hinges of it"
        )
    inertia = float(steady.principal_inertias[steady.axis - 1])
    springs = spin.K_springs[np.ix_(joints, joints)]
    return ReducedMotion(
        model, steady.axis, steady.principal_axes, steady.pose, inertia, moves, springs
    )
