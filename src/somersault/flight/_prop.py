"""What a swinging body rests against."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from somersault._core.checks import shown
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number


@dataclass(frozen=True)
class Prop:
    """A prop that pushes a joint back where it has passed an angle, and never pulls.

    Passed by c > 0 it gives `stiffness` c (1 + `damping` ċ): a load that is continuous when the
    prop touches and when it lets go (Hunt and Crossley 1975, J. Appl. Mech. 42, 440).

    Parameters
    ----------
    angle : float
        rad.
    side : {1, -1}
        1 keeps the joint's coordinate at `angle` or above, −1 below.
    stiffness : float
        N m/rad.
    damping : float
        s/rad.

    Raises
    ------
    SomersaultError
        For numbers that do not make sense.

    Examples
    --------
    >>> import somersault as so
    >>> so.Prop(0.0, side=-1, stiffness=1e4).side
    -1
    """

    angle: float
    side: int = 1
    stiffness: float = 1e4
    damping: float = 0.0

    def __post_init__(self) -> None:
        number("a prop's angle", self.angle)
        if not isinstance(self.side, int | float | np.number) or self.side not in (1, -1):
            raise SomersaultError(f"a prop's side is 1 or -1, and is {shown(self.side)}")
        if number("a prop's stiffness", self.stiffness) <= 0:
            raise SomersaultError(f"a prop's stiffness must be positive, and is {self.stiffness:g}")
        if number("a prop's damping", self.damping) < 0:
            raise SomersaultError(f"a prop's damping is not negative, and is {self.damping:g}")

    def torque(self, q: Any, u: Any) -> Any:
        """What the prop gives at a joint.

        Parameters
        ----------
        q, u : float, array or symbol
            The joint's coordinate, rad, and rate, rad/s.

        Returns
        -------
        of the kind that q and u are
            N m.

        Examples
        --------
        >>> import somersault as so
        >>> float(so.Prop(0.0, side=-1, stiffness=1e4).torque(0.01, 0.0))
        -100.0
        """
        passed = ca.fmax(self.side * (self.angle - q), 0)
        return self.side * self.stiffness * passed * ca.fmax(1 - self.damping * self.side * u, 0)
