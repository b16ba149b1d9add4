"""From where a scene is seen: perspective, in axes front, left and up."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from somersault._core.array import Array
from somersault.view._figure import camera

_ANGLE = np.radians(28.0)  # that the smaller side of a picture takes in
_NEAREST = 0.02  # of the eye's distance: what is nearer is not drawn


@dataclass(frozen=True)
class Eye:
    """An eye and its picture plane.

    Parameters
    ----------
    target : ndarray, (3,)
        What is in the middle of the picture, m.
    azimuth, elevation : float
        As of `camera`, degrees.
    radius : float
        How much about the target is surely seen, m.
    width, height : int
        Of the picture, pixels.
    """

    target: Array
    azimuth: float
    elevation: float
    radius: float
    width: int
    height: int

    @property
    def rows(self) -> Array:
        """Right, up and towards the eye, (3, 3)."""
        return camera(self.azimuth, self.elevation)

    @property
    def distance(self) -> float:
        """Of the eye from the target, m."""
        return self.radius / float(np.sin(_ANGLE / 2))

    @property
    def focal(self) -> float:
        """Pixels of a picture plane one unit away."""
        return min(self.width, self.height) / 2 / float(np.tan(_ANGLE / 2))

    @property
    def position(self) -> Array:
        """Where it is, (3,)."""
        return self.target + self.distance * self.rows[2]

    def project(self, points: Array) -> Array:
        """Pixels from the left and from the top, and 1 over the distance along the line of sight;
        −1 for what is too near or behind.

        Parameters
        ----------
        points : ndarray, (n, 3)
            m.

        Returns
        -------
        ndarray, (n, 3)
        """
        seen = (points - self.target) @ self.rows.T
        depth = self.distance - seen[:, 2]
        behind = depth < _NEAREST * self.distance
        nearness = 1 / np.where(behind, 1.0, depth)
        flat = self.focal * seen[:, :2] * nearness[:, None] * [1.0, -1.0]
        flat += [self.width / 2, self.height / 2]
        return np.column_stack([flat, np.where(behind, -1.0, nearness)])
