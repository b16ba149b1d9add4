"""Which force of the floor is wanted, and where."""

from __future__ import annotations

from dataclasses import dataclass

from somersault.ground._law import LandingLaw
from somersault.ground._machine import GRAVITY, Moment

_LEAST = 0.2  # of the weight: the least force that is asked of the floor
_LANDED = -0.15  # m/s: the centre of mass is braked, and may rise
_STOP = 0.03  # m over which it is braked at least


@dataclass(frozen=True)
class Push:
    """A force of the floor on the feet.

    Attributes
    ----------
    place : float
        Where it acts, m.
    along, up : float
        N.
    """

    place: float
    along: float
    up: float


def within(value: float, low: float, high: float) -> float:
    return min(max(value, low), high)


def balanced(
    offset: float, height: float, up: float, wanted: tuple[float, float], sole: tuple[float, float],
    mass: float, inertia: float, weight: float, friction: float,
) -> Push:  # fmt: skip
    """The force along the ground and its place that turn and move a body as wanted, if the sole
    allows it, and else a compromise.

    Parameters
    ----------
    offset, height : float
        Of the centre of mass, along from the frame's origin and above the floor, m.
    up : float
        Force upwards, N.
    wanted : (float, float)
        Acceleration of the centre of mass along, m/s², and angular acceleration, rad/s².
    sole : (float, float)
        From where to where the force may act, m.
    mass, inertia : float
        kg, kg m².
    weight : float
        Of an error of the angular acceleration against one of the other.
    friction : float

    Returns
    -------
    Push
    """
    ahead, turning = wanted
    along = within(mass * ahead, -friction * up, friction * up)
    # The moment about the centre of mass, forwards, is (offset − place) up − height along.
    place = offset - (inertia * turning + height * along) / up
    if not sole[0] <= place <= sole[1]:
        place = within(place, *sole)
        move, turn = 1 / mass, -weight * height / inertia
        missing = weight * (turning - (offset - place) * up / inertia)
        along = (move * ahead + turn * missing) / (move**2 + turn**2)
        along = within(along, -friction * up, friction * up)
    return Push(place, along, up)


class Balance:
    """The law's wishes, from touchdown on.

    Parameters
    ----------
    law : LandingLaw
    mass : float
        kg.
    time : float
        Of the touchdown, s.
    moment : Moment
        At it.
    """

    def __init__(self, law: LandingLaw, mass: float, time: float, moment: Moment) -> None:
        self._law, self._mass = law, mass
        height, falling = moment.centre[2], min(moment.velocity[2], 0.0)
        self._lowest = max(law.lowest, height - 0.02 - falling**2 / (2 * law.braking))
        self._lean, self._time = float(moment.q[2]), time
        self._bottom: tuple[float, float] | None = None

    def push(self, time: float, moment: Moment) -> Push:
        """The force that is wanted of the floor."""
        law = self._law
        up = self._mass * (GRAVITY + self._rise(time, moment))
        weight = self._mass * GRAVITY
        up = within(up, _LEAST * weight, law.most_force * weight)
        (x, _, z), (vx, _, _) = moment.centre, moment.velocity
        ahead = -law.place_stiffness * (x - moment.sole[0]) - law.place_damping * vx
        error = moment.q[2] - self._leant(time, z)
        turning = -law.attitude_stiffness * within(error, -law.attitude_error, law.attitude_error)
        turning -= law.momentum_damping * moment.spin / moment.inertia
        ends = sorted((moment.heel[0], moment.toes[0]))
        middle = sum(ends) / 2
        sole = min(ends[0] + law.margin, middle), max(ends[1] - law.margin, middle)
        return balanced(
            x, z, up, (ahead, turning), sole, self._mass, moment.inertia, law.attitude_weight,
            law.friction,
        )  # fmt: skip

    def _rise(self, time: float, moment: Moment) -> float:
        """Acceleration upwards, m/s²."""
        law, z, vz = self._law, moment.centre[2], moment.velocity[2]
        if self._bottom is None:
            if vz < _LANDED:
                return float(vz**2 / (2 * max(z - self._lowest, _STOP)))
            self._bottom = time, float(z)
        begin, low = self._bottom
        s, way = min((time - begin) / law.rise, 1.0), law.height - low
        path = low + way * s**3 * (10 - 15 * s + 6 * s * s)
        speed = way * 30 * s * s * (1 - s) ** 2 / law.rise
        bend = way * 60 * s * (1 - 3 * s + 2 * s * s) / law.rise**2
        return float(bend + law.height_stiffness * (path - z) + law.height_damping * (speed - vz))

    def _leant(self, time: float, height: float) -> float:
        """The lean that is wanted: it goes at its rate to that of the height."""
        law, most = self._law, self._law.lean_rate * (time - self._time)
        goal = law.lean * within((law.height - height) / law.lean_depth, 0.0, 1.0)
        self._lean += within(goal - self._lean, -most, most)
        self._time = time
        return self._lean
