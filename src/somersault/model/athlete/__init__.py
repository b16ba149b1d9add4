"""Athletes from stature and mass, or from measurements."""

from somersault.model.athlete._measured import athlete_from_measurements
from somersault.model.athlete._poses import named_pose, pose_names
from somersault.model.athlete._stature import athlete

__all__ = ["athlete", "athlete_from_measurements", "named_pose", "pose_names"]
