"""A motion as what the joints of a takeoff do."""

from __future__ import annotations

from somersault.flight._takeoff import JointTakeoff
from somersault.model import Model
from somersault.motion import Motion


def prescribed(
    model: str | Model, motion: Motion, duration: float | None = None
) -> dict[str, JointTakeoff]:
    """The `joints` of a takeoff that follow a motion exactly; see `Motion.joint_paths`."""
    paths = motion.joint_paths(model, duration)
    return {name: JointTakeoff(motion="prescribed", path=path) for name, path in paths.items()}
