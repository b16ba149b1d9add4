"""Takeoff, flight, landing."""

from somersault.flight._ballistic import BallisticPath
from somersault.flight._broken import BROKEN, why_broken
from somersault.flight._compliance import compliant, off_nominal, with_momentum
from somersault.flight._deviation import deviated_flight
from somersault.flight._flight import Flight
from somersault.flight._fly import fly
from somersault.flight._landing import Landing
from somersault.flight._maneuver import Maneuver
from somersault.flight._maneuvers import (
    arm_tilt,
    cat_turn,
    hula,
    inertia_change,
    torque_twist,
)
from somersault.flight._many import Flights, flights
from somersault.flight._prescribed import prescribed
from somersault.flight._principal import (
    principal_attitude,
    principal_axes_along,
    rigid_continuation,
)
from somersault.flight._prop import Prop
from somersault.flight._release import Release, released, ridden
from somersault.flight._replay import Replay
from somersault.flight._report import ENDINGS, Report, landing_error, landing_target
from somersault.flight._rudi import rudi
from somersault.flight._sensitivity import sensitivity, transition
from somersault.flight._spec import KEYS
from somersault.flight._strange import BROKE_OFF
from somersault.flight._swing import GRAVITY, Swing, height_energy, swing
from somersault.flight._takeoff import Takeoff
from somersault.flight._twist_time import twist_time
from somersault.flight._work import joint_power, joint_work
from somersault.flight.behaviours import JointTakeoff

__all__ = [
    "BROKEN",
    "BROKE_OFF",
    "ENDINGS",
    "GRAVITY",
    "KEYS",
    "BallisticPath",
    "Flight",
    "Flights",
    "JointTakeoff",
    "Landing",
    "Maneuver",
    "Prop",
    "Release",
    "Replay",
    "Report",
    "Swing",
    "Takeoff",
    "arm_tilt",
    "cat_turn",
    "compliant",
    "deviated_flight",
    "flights",
    "fly",
    "height_energy",
    "hula",
    "inertia_change",
    "joint_power",
    "joint_work",
    "landing_error",
    "landing_target",
    "off_nominal",
    "prescribed",
    "principal_attitude",
    "principal_axes_along",
    "released",
    "ridden",
    "rigid_continuation",
    "rudi",
    "sensitivity",
    "swing",
    "torque_twist",
    "transition",
    "twist_time",
    "why_broken",
    "with_momentum",
]
