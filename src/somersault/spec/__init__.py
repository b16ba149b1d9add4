"""Everything that is read from TOML."""

from somersault.spec._ensemble import EnsembleSpec, parse_ensemble, read_ensemble
from somersault.spec._flight import FlightSpec, parse_spec, read_spec

__all__ = [
    "EnsembleSpec",
    "FlightSpec",
    "parse_ensemble",
    "parse_spec",
    "read_ensemble",
    "read_spec",
]
