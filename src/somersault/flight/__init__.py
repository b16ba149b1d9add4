"""Takeoff, flight, landing."""

from somersault.flight._deviation import deviated_flight
from somersault.flight._flight import Flight, Landing
from somersault.flight._fly import fly
from somersault.flight._spec import FlightSpec, parse_spec, read_spec
from somersault.flight._takeoff import JointTakeoff, Takeoff

__all__ = [
    "Flight",
    "FlightSpec",
    "JointTakeoff",
    "Landing",
    "Takeoff",
    "deviated_flight",
    "fly",
    "parse_spec",
    "read_spec",
]
