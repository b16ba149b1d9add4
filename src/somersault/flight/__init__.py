"""Takeoff, flight, landing."""

from somersault.flight._flight import Flight, Landing
from somersault.flight._fly import fly
from somersault.flight._takeoff import JointTakeoff, Takeoff

__all__ = ["Flight", "JointTakeoff", "Landing", "Takeoff", "fly"]
