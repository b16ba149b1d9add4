"""A flight goes on, on the feet."""

from __future__ import annotations

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import instance
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.flight import Flight
from somersault.ground._balance import Balance
from somersault.ground._gymnast import Floor, Gymnast
from somersault.ground._law import LandingLaw
from somersault.ground._machine import BASE, STEP, Machine, Moment, machine
from somersault.ground._stance import Stance
from somersault.ground._torques import torques
from somersault.ground._touchdown import Touchdown, touchdown

STANDS = 2.0
"""How long a gymnast stands still who has landed, s."""
TICK = 0.004
"""Of the law, s."""
_SLOW, _STILL = 0.1, 0.5  # m/s of the centre of mass, rad/s of every joint and of the trunk


def land(
    flight: Flight,
    *,
    gymnast: Gymnast | None = None,
    floor: Floor | None = None,
    law: LandingLaw | None = None,
    duration: float = 8.0,
) -> Stance:
    """A flight's landing: feet on the contact of MuJoCo, joints that do what a law says.

    It begins where the body first reaches the floor, the plane of height 0. It ends when the
    gymnast has stood still for two seconds, or when anything but the feet touches the floor.

    Parameters
    ----------
    flight : Flight
        Of a planar body, with its position in the room (`Takeoff.position`) and gravity.
    gymnast : Gymnast, optional
        Who lands; by default the body that flew, with usual feet and strength.
    floor : Floor, optional
    law : LandingLaw, optional
    duration : float
        After touchdown, at most, s.

    Returns
    -------
    Stance

    Raises
    ------
    SomersaultError
        For a flight that does not come down to the floor, begins in it, or is of another body.

    Examples
    --------
    >>> import somersault as so
    >>> model = so.sagittal(so.athlete(1.67, 64, knees=True, ankles=True))
    >>> bent = {"shoulder_flexion": 1.4, "hip_flexion": 0.5, "knee": 0.6, "ankle": 1.87}
    >>> joints = {name: so.JointTakeoff.locked(angle=x) for name, x in bent.items()}
    >>> takeoff = so.Takeoff(somersault=0.2, position=(0.0, 0.0, 1.5), joints=joints)
    >>> down = so.fly(model, takeoff, 0.4, gravity=(0.0, 0.0, -9.81))
    >>> so.ground.land(down).ended
    'stood'
    """
    instance("what lands", flight, Flight)
    who = Gymnast(flight.model) if gymnast is None else instance("gymnast", gymnast, Gymnast)
    if who.model != flight.model:
        raise SomersaultError(
            f"this is a flight of {flight.model.name}, not of the gymnast, who is {who.model.name}"
        )
    place = machine(who, Floor() if floor is None else instance("floor", floor, Floor))
    chosen = LandingLaw() if law is None else instance("law", law, LandingLaw)
    if number("duration", duration) <= 0:
        raise SomersaultError(f"a landing needs a duration above 0 s, and {duration:g} is none")
    down = touchdown(flight, place)
    kept, ended, fell_on = _run(place, chosen, down, duration)
    count = len(kept.positions)
    q, u = np.array(kept.positions), np.array(kept.rates)
    own = [k - BASE for k in place.places]
    across = np.full(count, flight.base_position[0, 1])
    turned = q[:, 2] + down.turns
    return Stance(
        who,
        down.time + TICK * np.arange(count),
        np.stack([q[:, 0], across, q[:, 1]], -1),
        u[:, :2],
        np.stack([turned, np.zeros(count), np.zeros(count)], -1),
        u[:, 2],
        q[:, BASE:][:, own],
        u[:, BASE:][:, own],
        np.array(kept.torques)[:, own],
        np.array(kept.forces),
        ended,
        fell_on,
    )


class _Kept:
    """What is kept of each tick."""

    def __init__(self) -> None:
        self.positions: list[Array] = []
        self.rates: list[Array] = []
        self.torques: list[Array] = []
        self.forces: list[Array] = []


def _run(
    place: Machine, law: LandingLaw, down: Touchdown, duration: float
) -> tuple[_Kept, str, str | None]:
    import mujoco

    m = place.mujoco
    data = mujoco.MjData(m)
    data.qpos[:], data.qvel[:] = down.position, down.rate
    moment, kept, steps = Moment(place, data), _Kept(), round(TICK / STEP)
    mujoco.mj_forward(m, data)
    moment.read()
    balance = Balance(law, place.mass, 0.0, moment)
    still, ended, fell_on = 0.0, "duration", None
    for tick in range(max(1, round(duration / TICK))):
        acting = torques(law, place, moment, balance.push(tick * TICK, moment))
        kept.positions.append(data.qpos.copy())
        kept.rates.append(data.qvel.copy())
        kept.torques.append(acting)
        data.qfrc_applied[BASE:] = acting
        force = np.zeros(2)
        for _ in range(steps):
            mujoco.mj_step(m, data)
            force += data.qfrc_constraint[:2]
        kept.forces.append(force / steps)
        mujoco.mj_forward(m, data)
        fell_on = place.fallen_on(data)
        if fell_on is not None:
            ended = "fell"
            break
        moment.read()
        still = still + TICK if _is_still(moment) else 0.0
        if still > STANDS:
            ended = "stood"
            break
    kept.positions.append(data.qpos.copy())
    kept.rates.append(data.qvel.copy())
    kept.torques.append(kept.torques[-1])
    kept.forces.append(kept.forces[-1])
    return kept, ended, fell_on


def _is_still(moment: Moment) -> bool:
    return bool(np.hypot(*moment.velocity[::2]) < _SLOW and np.abs(moment.u[2:]).max() < _STILL)
