"""The moment of a flight in which the body first reaches the floor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.flight import Flight
from somersault.ground._machine import BASE, Machine

_BISECTIONS = 40  # of the time between two samples


@dataclass(frozen=True)
class Touchdown:
    """Where and how fast the body is at it.

    Attributes
    ----------
    time : float
        s.
    position, rate : ndarray, (7,)
        MuJoCo's coordinates and rates.
    turns : float
        Made until then and not in them, rad.
    """

    time: float
    position: Array
    rate: Array
    turns: float


def touchdown(flight: Flight, machine: Machine) -> Touchdown:
    """The touchdown of a flight; SomersaultError where it has none."""
    import mujoco

    m = machine.mujoco
    own, count = np.array(machine.places), len(flight.times)
    q, u = np.empty((count, m.nq)), np.zeros((count, m.nv))
    turned = flight.angles[:, 0]
    turns = 2 * np.pi * round(float(turned[-1]) / (2 * np.pi))
    q[:, : BASE - 1], q[:, BASE - 1] = flight.base_position[:, ::2], turned - turns
    q[:, own], u[:, own] = flight.joint_coordinates, flight.dataset["joint_rate"].values
    u[:, BASE - 1] = flight.angular_velocity[:, 1]
    data = mujoco.MjData(m)

    def touches(position: Array) -> bool:
        data.qpos[:] = position
        mujoco.mj_fwdPosition(m, data)
        return bool(data.ncon)

    down = np.array([touches(one) for one in q])
    coming = np.flatnonzero(~down[:-1] & down[1:])
    if not len(coming):
        why = "begins in the floor; start higher" if down[0] else "stays above it; fly on"
        raise SomersaultError(f"this flight does not come down to the floor: it {why}")
    k = int(coming[0])
    before, after = 0.0, 1.0
    for _ in range(_BISECTIONS):
        middle = (before + after) / 2
        if touches(q[k] + middle * (q[k + 1] - q[k])):
            after = middle
        else:
            before = middle
    time, position, rate = (x[k] + before * (x[k + 1] - x[k]) for x in (flight.times, q, u))
    # The base goes as the centre of mass, which falls, has it.
    data.qpos[:] = position
    mujoco.mj_forward(m, data)
    way = np.zeros((3, m.nv))
    mujoco.mj_jacSubtreeCom(m, data, way, 1)
    falls = flight.velocity + flight.gravity * time
    rate[: BASE - 1] = (falls - way @ rate)[::2]
    return Touchdown(float(time), position, rate, turns)
