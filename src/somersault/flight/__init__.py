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
from somersault.flight._motion import Motion
from somersault.flight._motion_files import read_motion
from somersault.flight._motion_samples import sampled_motion
from somersault.flight._spec import FlightSpec, parse_spec, read_spec
from somersault.flight._swing import Release, Stop, Swing, released, swing
from somersault.flight._takeoff import JointTakeoff, Takeoff

__all__ = [
    "Flight",
    "FlightSpec",
    "JointTakeoff",
    "Landing",
    "Maneuver",
    "Motion",
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
    "parse_spec",
    "read_motion",
    "read_spec",
    "released",
    "sampled_motion",
    "swing",
    "torque_twist",
    "twist_time",
    "with_momentum",
]
