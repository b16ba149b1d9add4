"""What joints do as time goes on: smooth moves, samples, recordings."""

from somersault.motion._column import read_column
from somersault.motion._files import read_motion
from somersault.motion._motion import Motion
from somersault.motion._path import (
    DEGREE,
    TAPE_DEGREE,
    Path,
    as_moves,
    check_rows,
    held,
    increasing,
    moves,
    polynomial,
    straight,
    value,
)
from somersault.motion._recorded_base import RecordedBase
from somersault.motion._samples import low_pass, sampled_motion

__all__ = [
    "DEGREE",
    "TAPE_DEGREE",
    "Motion",
    "Path",
    "RecordedBase",
    "as_moves",
    "check_rows",
    "held",
    "increasing",
    "low_pass",
    "moves",
    "polynomial",
    "read_column",
    "read_motion",
    "sampled_motion",
    "straight",
    "value",
]
