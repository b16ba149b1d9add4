"""Where all joints are at takeoff, and how fast they move."""

from __future__ import annotations

import numpy as np

from somersault._core.array import Array
from somersault.flight.behaviours._coupled import leaders
from somersault.flight.behaviours._declared import side_by_side
from somersault.flight.behaviours._plan import JointPlan
from somersault.simulation import Numbers


def begin(plans: tuple[JointPlan, ...], values: Numbers, count: int) -> tuple[Array, Array]:
    """Coordinates and speeds of all joints at takeoff.

    Parameters
    ----------
    plans : tuple of JointPlan
    values : mapping of tuple to float or ndarray, (count,)
        The numbers of the flights.
    count : int
        How many flights.

    Returns
    -------
    q : ndarray, (count, coordinates)
    u : ndarray, (count, speeds)
    """
    led = leaders(plans)
    parts: dict[str, tuple[Array, Array]] = {}
    for plan in plans:
        if plan.joint.name not in led:
            parts[plan.joint.name] = plan.does.begin(plan.joint, values, count)
    for name, leader in led.items():
        q, u = parts[leader]
        gears = side_by_side(values, [("factor", name), ("offset", name)], count)
        parts[name] = gears[:, :1] * q + gears[:, 1:], gears[:, :1] * u
    nothing = np.zeros((count, 0))
    both = [parts[plan.joint.name] for plan in plans]
    return (
        np.concatenate([nothing, *(q for q, _ in both)], 1),
        np.concatenate([nothing, *(u for _, u in both)], 1),
    )
