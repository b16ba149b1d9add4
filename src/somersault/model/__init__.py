"""Bodies in the air: what they are made of, and where they are read from."""

from somersault.model._kinematics import (
    body_frames,
    body_velocities,
    centre_of_mass,
    segment_momenta,
)
from somersault.model._load import load, shipped
from somersault.model._mounted import Mount, mounted
from somersault.model._types import GROUND, LIMIT_SLACK, Body, Follow, Joint, Model
from somersault.model.athlete._measured import athlete_from_measurements
from somersault.model.athlete._poses import named_pose
from somersault.model.athlete._stature import athlete

__all__ = [
    "GROUND",
    "LIMIT_SLACK",
    "Body",
    "Follow",
    "Joint",
    "Model",
    "Mount",
    "athlete",
    "athlete_from_measurements",
    "body_frames",
    "body_velocities",
    "centre_of_mass",
    "load",
    "mounted",
    "named_pose",
    "segment_momenta",
    "shipped",
]
