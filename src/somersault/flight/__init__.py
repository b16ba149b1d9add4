"""Takeoff, flight, landing."""

from somersault.flight._compliance import compliant, off_nominal, with_momentum
from somersault.flight._deviation import deviated_flight
from somersault.flight._flight import Flight, Landing
from somersault.flight._fly import fly
from somersault.flight._maneuvers import (
    Maneuver,
    arm_tilt,
    cat_turn,
    hula,
    inertia_change,
    torque_twist,
    twist_time,
)
from somersault.flight._prescribed import prescribed
from somersault.flight._swing import Release, Stop, Swing, released, swing
from somersault.flight._takeoff import JointTakeoff, Takeoff

__all__ = [
    "Flight",
    "JointTakeoff",
    "Landing",
    "Maneuver",
    "Release",
    "Stop",
    "Swing",
    "Takeoff",
    "arm_tilt",
    "cat_turn",
    "compliant",
    "deviated_flight",
    "fly",
    "hula",
    "inertia_change",
    "off_nominal",
    "prescribed",
    "released",
    "swing",
    "torque_twist",
    "twist_time",
    "with_momentum",
]
