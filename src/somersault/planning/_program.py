"""A nonlinear program in which everything is linear around one function at many points.

Its constraints and objective are linear in the unknowns x and in what the function gives at points
whose arguments are linear in x. Derivatives are then sums, put together once, of the function's
own, which are compiled and asked for all points at once.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from somersault._core.array import Array
from somersault.planning._entries import Assembly, products
from somersault.planning._point import Point


@dataclass(frozen=True, eq=False)
class Program:
    """Minimise c·x + d·y with low ≤ G x + N y ≤ high and least ≤ x ≤ most, where y are the outputs
    of `point` at the arguments P x.

    Parameters
    ----------
    point : Point
    arguments : sparse matrix
        P: the arguments of all points, one after another.
    linear, nonlinear : sparse matrix
        G and N.
    low, high : array
        Bounds of the constraints.
    least, most : array
        Bounds of the unknowns.
    cost, cost_of_outputs : array
        c and d.
    """

    point: Point
    arguments: sp.csr_matrix
    linear: sp.csr_matrix
    nonlinear: sp.csr_matrix
    low: Array
    high: Array
    least: Array
    most: Array
    cost: Array
    cost_of_outputs: Array

    @property
    def unknowns(self) -> int:
        return len(self.least)

    @property
    def points(self) -> int:
        return self.arguments.shape[0] // self.point.arguments

    def at(self, x: Array) -> Array:
        """Arguments of the points, (points, arguments)."""
        return (self.arguments @ x).reshape(self.points, -1)

    def outputs(self, x: Array) -> Array:
        """What the function gives, (points, outputs)."""
        return self.point.value(self.at(x))

    def objective(self, x: Array, y: Array) -> float:
        """What is to be least, with the outputs y of x."""
        return float(self.cost @ x + self.cost_of_outputs @ y.ravel())

    def constraints(self, x: Array, y: Array) -> Array:
        """What has bounds, with the outputs y of x."""
        return self.linear @ x + self.nonlinear @ y.ravel()

    def missed(self, x: Array) -> Array:
        """By how much each constraint is missed: not at all where negative, without end where the
        outputs are no numbers."""
        with np.errstate(invalid="ignore", over="ignore"):
            values = self.constraints(x, self.outputs(x))
            missed = np.maximum(self.low - values, values - self.high)
        return np.nan_to_num(missed, nan=np.inf, posinf=np.inf, neginf=-np.inf)

    # ---------------------------------------------------------------------------- derivatives

    @cached_property
    def jacobian(self) -> Assembly:
        """Derivatives of the constraints, of those of the function (points × places)."""
        return self._assembled(self.nonlinear, self.linear)

    @cached_property
    def gradient(self) -> Assembly:
        """Derivatives of the objective, a matrix of one row."""
        return self._assembled(
            sp.csr_matrix(self.cost_of_outputs[None]), sp.csr_matrix(self.cost[None])
        )

    def slopes(self, x: Array) -> Array:
        """The function's derivatives at all points, one after another."""
        return self.point.jacobian(self.at(x)).ravel()

    def _assembled(self, of_outputs: sp.csr_matrix, constant: sp.csr_matrix) -> Assembly:
        outputs, arguments = self.point.jacobian_places
        by_output = sp.csr_matrix(of_outputs.T)
        at = np.arange(self.points)[:, None]
        pair, row, column, weight = products(
            by_output, (at * self.point.outputs + outputs).ravel(),
            self.arguments, (at * self.point.arguments + arguments).ravel(),
        )  # fmt: skip
        count = self.points * len(outputs)
        return Assembly(row, column, pair, weight, constant.shape, count, constant)

    @cached_property
    def hessian(self) -> Assembly:
        """Second derivatives of the Lagrangian, at and above the diagonal, of those of the
        function (points × places)."""
        first, second = self.point.hessian_places
        at = np.arange(self.points)[:, None] * self.point.arguments
        pair, row, column, weight = products(
            self.arguments, (at + first).ravel(), self.arguments, (at + second).ravel()
        )
        diagonal = np.tile(first == second, self.points)[pair]
        kept = ~diagonal | (row <= column)
        twice = np.where(~diagonal & (row == column), 2.0, 1.0)
        top, right = np.minimum(row, column), np.maximum(row, column)
        shape = (self.unknowns, self.unknowns)
        count = self.points * len(first)
        return Assembly(top[kept], right[kept], pair[kept], (weight * twice)[kept], shape, count)

    def curvatures(self, x: Array, objective: float, multipliers: Array) -> Array:
        """The function's second derivatives at all points, each output times its multiplier."""
        by_output = objective * self.cost_of_outputs + multipliers @ self.nonlinear
        return self.point.hessian(self.at(x), by_output.reshape(self.points, -1)).ravel()
