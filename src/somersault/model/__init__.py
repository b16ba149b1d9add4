"""Bodies in the air: what they are made of, and where they are read from."""

from somersault.model._base import Base, base_on_its_joints
from somersault.model._bodies import GROUND, LIMIT_SLACK, Body, Follow, Joint
from somersault.model._formats import register_format
from somersault.model._kinematics import (
    body_frames,
    body_velocities,
    centre_of_mass,
    segment_momenta,
)
from somersault.model._load import load, shipped
from somersault.model._mirror import (
    Pair,
    common_name,
    mirror_images,
    mirror_pairs,
    named_pairs,
    reflection,
    sides,
)
from somersault.model._model import Model
from somersault.model._mounted import Mount, mounted
from somersault.model._plain import model_digest, plain_form
from somersault.model._pose import pose, spread
from somersault.model._refused import FREE_IT
from somersault.model._sagittal import sagittal
from somersault.model._skeleton import model_shapes
from somersault.model._to_mjcf import mjcf, write_mjcf
from somersault.model._vectors import IDENTITY, ZERO, Matrix, Vector, as_matrix, as_vector
from somersault.model._weld import merge_welded
from somersault.model.athlete._keys import AthleteKeys
from somersault.model.athlete._measured import athlete_from_measurements
from somersault.model.athlete._poses import named_pose, pose_names
from somersault.model.athlete._stature import athlete

__all__ = [
    "FREE_IT",
    "GROUND",
    "IDENTITY",
    "LIMIT_SLACK",
    "ZERO",
    "AthleteKeys",
    "Base",
    "Body",
    "Follow",
    "Joint",
    "Matrix",
    "Model",
    "Mount",
    "Pair",
    "Vector",
    "as_matrix",
    "as_vector",
    "athlete",
    "athlete_from_measurements",
    "base_on_its_joints",
    "body_frames",
    "body_velocities",
    "centre_of_mass",
    "common_name",
    "load",
    "merge_welded",
    "mirror_images",
    "mirror_pairs",
    "mjcf",
    "model_digest",
    "model_shapes",
    "mounted",
    "named_pairs",
    "named_pose",
    "plain_form",
    "pose",
    "pose_names",
    "reflection",
    "register_format",
    "sagittal",
    "segment_momenta",
    "shipped",
    "sides",
    "spread",
    "write_mjcf",
]
