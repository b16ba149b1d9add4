"""The way of the centre of mass: a parabola, whatever the body does about it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number, numbers


@dataclass(frozen=True, eq=False)
class BallisticPath:
    """Where the centre of mass goes after takeoff, and for how long it is in the air.

    A `Takeoff` has a velocity but no position; this adds the position. Heights are measured
    against gravity, along inertial axis 3 where gravity is the usual one.

    Parameters
    ----------
    position : sequence of float
        The centre of mass at takeoff, inertial axes, m.
    velocity : sequence of float
        Its velocity at takeoff, inertial axes, m/s.
    gravity : sequence of float
        m/s², inertial axes; 3 is up.

    Raises
    ------
    SomersaultError
        For anything that is not three finite numbers.

    Examples
    --------
    >>> from somersault.flight import BallisticPath
    >>> path = BallisticPath((0.0, 0.0, 1.0), (2.0, 0.0, 4.905))
    >>> round(path.time_to(1.0), 12), round(path.apex, 12)
    (1.0, 2.22625)
    >>> path.at([0.0, 1.0]).round(12).tolist()
    [[0.0, 0.0, 1.0], [2.0, 0.0, 1.0]]
    """

    position: Sequence[float] | Array
    velocity: Sequence[float] | Array
    gravity: Sequence[float] | Array = (0.0, 0.0, -9.81)

    def __post_init__(self) -> None:
        for name in ("position", "velocity", "gravity"):
            object.__setattr__(self, name, numbers(name, getattr(self, name), 3))

    @property
    def _pull(self) -> float:
        size = float(np.linalg.norm(self.gravity))
        if not size:
            raise SomersaultError("without gravity nothing comes down; give gravity in m/s²")
        return size

    @property
    def _up(self) -> Array:
        return -np.asarray(self.gravity) / self._pull

    @property
    def height(self) -> float:
        """Height at takeoff, m."""
        return float(self._up @ self.position)

    @property
    def climb(self) -> float:
        """Upward velocity at takeoff, m/s."""
        return float(self._up @ self.velocity)

    @property
    def apex(self) -> float:
        """Greatest height, m: of the centre of mass, wherever in time that is.

        A body that takes off downwards is past it already.
        """
        return self.height + self.climb**2 / (2 * self._pull)

    def time_to(self, height: float) -> float:
        """Time from takeoff until the centre of mass comes down to a height.

        Parameters
        ----------
        height : float
            Of the centre of mass at landing, m.

        Returns
        -------
        float
            t = (v + √(2 g (apex − height)))/g, s, with v the upward velocity at takeoff.

        Raises
        ------
        SomersaultError
            For a height that is never reached after takeoff, and without gravity.

        Examples
        --------
        >>> from somersault.flight import BallisticPath
        >>> path = BallisticPath((0.0, 0.0, 1.0), (0.0, 0.0, 4.905))
        >>> round(path.time_to(1.0), 12)
        1.0
        """
        drop = self.apex - number("height", height)
        time = (self.climb + float(np.sqrt(2 * self._pull * max(drop, 0.0)))) / self._pull
        if drop < 0 or time < 0:
            highest = self.apex if self.climb > 0 else self.height
            raise SomersaultError(
                f"the centre of mass does not come down to {height:g} m: from takeoff on it is at "
                f"most {highest:g} m high; give a lower height"
            )
        return time

    def at(self, times: ArrayLike) -> Array:
        """Position of the centre of mass at some times.

        Parameters
        ----------
        times : array_like, shape (T,)
            Since takeoff, s.

        Returns
        -------
        numpy.ndarray, shape (T, 3)
            x₀ + v t + ½ g t², inertial axes, m.

        Examples
        --------
        >>> from somersault.flight import BallisticPath
        >>> BallisticPath((0.0, 0.0, 1.0), (2.0, 0.0, 4.905)).at([1.0]).round(12).tolist()
        [[2.0, 0.0, 1.0]]
        """
        t = numbers("times", times)[:, None]
        return self.position + t * self.velocity + 0.5 * t**2 * self.gravity
