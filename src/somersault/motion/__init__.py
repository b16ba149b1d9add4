"""What joints do as time goes on: smooth moves, samples, recordings."""

from somersault.motion._files import read_motion
from somersault.motion._motion import Motion
from somersault.motion._path import Path
from somersault.motion._samples import low_pass, sampled_motion

__all__ = ["Motion", "Path", "low_pass", "read_motion", "sampled_motion"]
