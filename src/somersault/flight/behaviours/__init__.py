"""What joints do in flight: one class in one file each."""

from somersault.flight.behaviours._angle_law import AngleLaw
from somersault.flight.behaviours._as_modelled import AsModelled
from somersault.flight.behaviours._begin import begin
from somersault.flight.behaviours._behaviour import Angle, JointTakeoff
from somersault.flight.behaviours._by_law import ByLaw
from somersault.flight.behaviours._compliant import Compliant, softened
from somersault.flight.behaviours._coupled import Coupled, check_coupled, leaders
from somersault.flight.behaviours._declared import checked_all, declared, quantity, side_by_side
from somersault.flight.behaviours._free import Free
from somersault.flight.behaviours._here import Here, Known
from somersault.flight.behaviours._law import Law, between, bounded, checked_times, commanded
from somersault.flight.behaviours._locked import Locked
from somersault.flight.behaviours._moving import Moving, Stopped
from somersault.flight.behaviours._plan import JointPlan, kinds
from somersault.flight.behaviours._prescribed import REPLAY_RATE, OnPath, Prescribed
from somersault.flight.behaviours._rate_law import RateLaw
from somersault.flight.behaviours._sensing import Senses, Sensing
from somersault.flight.behaviours._sprung import NON_DIMENSIONAL, Sprung
from somersault.flight.behaviours._torque import Torque
from somersault.flight.behaviours._torque_law import TorqueLaw

__all__ = [
    "NON_DIMENSIONAL",
    "REPLAY_RATE",
    "Angle",
    "AngleLaw",
    "AsModelled",
    "ByLaw",
    "Compliant",
    "Coupled",
    "Free",
    "Here",
    "JointPlan",
    "JointTakeoff",
    "Known",
    "Law",
    "Locked",
    "Moving",
    "OnPath",
    "Prescribed",
    "RateLaw",
    "Senses",
    "Sensing",
    "Sprung",
    "Stopped",
    "Torque",
    "TorqueLaw",
    "begin",
    "between",
    "bounded",
    "check_coupled",
    "checked_all",
    "checked_times",
    "commanded",
    "declared",
    "kinds",
    "leaders",
    "quantity",
    "side_by_side",
    "softened",
]
