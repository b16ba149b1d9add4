"""Laws of feedback: what joints do as the body is sensed to move.

A law is a formula of sensed quantities and gains. It is worked out at ticks, waits its reaction
time, and then holds until the next tick. The behaviours `torque_law`, `rate_law` and `angle_law` of
joints have one each (`somersault.JointTakeoff`).
"""

from somersault.laws._formula import Formula, wrapped
from somersault.laws._mirror import mirrored, mirrored_name
from somersault.laws._noise import STATE, Noise, seeds

__all__ = ["STATE", "Formula", "Noise", "mirrored", "mirrored_name", "seeds", "wrapped"]
