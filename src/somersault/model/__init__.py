"""Bodies in the air: what they are made of, and where they are read from."""

from somersault.model._athlete_measured import athlete_from_measurements
from somersault.model._athlete_poses import named_pose
from somersault.model._athlete_stature import athlete
from somersault.model._load import load, shipped
from somersault.model._mounted import Mount, mounted
from somersault.model._types import GROUND, Body, Joint, Model

__all__ = [
    "GROUND",
    "Body",
    "Joint",
    "Model",
    "Mount",
    "athlete",
    "athlete_from_measurements",
    "load",
    "mounted",
    "named_pose",
    "shipped",
]
