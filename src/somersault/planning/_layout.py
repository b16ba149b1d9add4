"""Where the unknowns of a plan stand in one vector, and the points at which the physics is asked.

At each of the nodes, evenly spaced, there are the three angles, and coordinate, rate and
acceleration of each joint that moves; within each interval the angles at its stages; then the
angular momentum and the duration. Accelerations go in straight lines from node to node, so joints
follow cubics exactly, and only the attitude needs collocation. Time is counted in durations, so
that all of this is linear.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from somersault._core.array import Array
from somersault.planning._entries import Entries
from somersault.planning._gauss import Tableau
from somersault.planning._point import MOMENTUM, TURNING


@dataclass(frozen=True, eq=False)
class Layout:
    """Places of the unknowns.

    Parameters
    ----------
    intervals, joints : int
        How many there are.
    tableau : Tableau
        Of the collocation within an interval.
    """

    intervals: int
    joints: int
    tableau: Tableau

    @property
    def nodes(self) -> int:
        return self.intervals + 1

    @property
    def stages(self) -> int:
        return len(self.tableau.stages)

    @property
    def _node(self) -> int:
        return TURNING + 3 * self.joints

    @property
    def _interval(self) -> int:
        return self._node + TURNING * self.stages

    @cached_property
    def at_nodes(self) -> Array:
        """Places of all unknowns of each node, (nodes, ·)."""
        return np.arange(self.nodes)[:, None] * self._interval + np.arange(self._node)

    @property
    def angles(self) -> Array:
        """(nodes, 3)"""
        return self.at_nodes[:, :TURNING]

    @property
    def q(self) -> Array:
        """(nodes, joints)"""
        return self._of_joints(0)

    @property
    def v(self) -> Array:
        """(nodes, joints)"""
        return self._of_joints(1)

    @property
    def w(self) -> Array:
        """(nodes, joints)"""
        return self._of_joints(2)

    def _of_joints(self, k: int) -> Array:
        first = TURNING + k * self.joints
        return self.at_nodes[:, first : first + self.joints]

    @cached_property
    def within(self) -> Array:
        """Places of the angles at the stages, (intervals, stages, 3)."""
        first = np.arange(self.intervals) * self._interval + self._node
        own = np.arange(self.stages * TURNING).reshape(self.stages, TURNING)
        return first[:, None, None] + own

    @property
    def momentum(self) -> Array:
        """(3,)"""
        return self.intervals * self._interval + self._node + np.arange(MOMENTUM)

    @property
    def duration(self) -> int:
        return int(self.momentum[-1]) + 1

    @property
    def unknowns(self) -> int:
        return self.duration + 1

    # --------------------------------------------------------------------------------- points

    @property
    def points(self) -> int:
        """The nodes, then the stages of each interval."""
        return self.nodes + self.intervals * self.stages

    @property
    def staged(self) -> Array:
        """Points at the stages, (intervals, stages)."""
        count = self.intervals * self.stages
        return self.nodes + np.arange(count).reshape(self.intervals, self.stages)

    @cached_property
    def arguments(self) -> sp.csr_matrix:
        """The matrix from the unknowns to the arguments of all points, one after another."""
        n, width = self.joints, TURNING + 3 * self.joints + MOMENTUM + 1
        matrix = Entries()
        add = matrix.add
        at = np.arange(self.points) * width
        at_nodes, at_stages = at[: self.nodes], at[self.staged]
        add(at_nodes[:, None] + np.arange(self._node), self.at_nodes, 1.0)
        add(at_stages[..., None] + np.arange(TURNING), self.within, 1.0)
        for k, row in enumerate(self._between):
            first = at_stages[..., None] + TURNING + k * n + np.arange(n)
            for (which, end), weights in row.items():
                source = self._of_joints(which)[end : end + self.intervals, None, :]
                add(first, source, weights[:, None])
        last = at[:, None] + self._node + np.arange(MOMENTUM + 1)
        add(last, np.append(self.momentum, self.duration), 1.0)
        return matrix.sparse(self.points * width, self.unknowns)

    @property
    def _between(self) -> list[dict[tuple[int, int], Array]]:
        return self.along(self.tableau.stages)

    def along(self, c: Array) -> list[dict[tuple[int, int], Array]]:
        """Coordinate, rate and acceleration of a joint in an interval.

        Parameters
        ----------
        c : array
            Where, from 0 to 1.

        Returns
        -------
        list of dict
            For each of the three the weights of coordinate, rate and acceleration (0, 1, 2) at the
            beginning and the end (0, 1) of the interval.
        """
        step, one = 1 / self.intervals, np.ones_like(c)
        return [
            {
                (0, 0): one, (1, 0): step * c,
                (2, 0): step**2 * (c**2 / 2 - c**3 / 6), (2, 1): step**2 * c**3 / 6,
            },
            {(1, 0): one, (2, 0): step * (c - c**2 / 2), (2, 1): step * c**2 / 2},
            {(2, 0): 1 - c, (2, 1): c},
        ]  # fmt: skip
