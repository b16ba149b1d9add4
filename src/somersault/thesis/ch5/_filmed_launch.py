"""A launch as one motion: the doll on the bar until it is let go, and its flight."""

from __future__ import annotations

import numpy as np

from somersault.attitude import quaternion_from_matrix, unwrapped_angles
from somersault.flight import GRAVITY, fly
from somersault.history import Recording
from somersault.model import body_frames
from somersault.thesis.ch5._launcher import Launch


def doll_along(throw: Launch) -> Recording:
    """The doll until the catch, without the launcher; it is let go at 0 s."""
    swing, mount = throw.swing, throw.mount
    carriers, feet = (values[:, 0] for values in body_frames(mount.held, swing.q))
    flight = fly(throw.doll, throw.release.takeoff, throw.time(), gravity=GRAVITY)
    held = {
        "times": swing.times - swing.times[-1],
        "base_position": feet + carriers @ np.array(mount.position),
        "base_quaternion": quaternion_from_matrix(carriers @ np.array(mount.rotation)),
        "joint_coordinates": swing.q[:, len(mount.carrier.joints) :],
    }
    whole = {name: np.concatenate([x, getattr(flight, name)[1:]]) for name, x in held.items()}
    angles = unwrapped_angles(whole["base_quaternion"], throw.doll.axes)
    return Recording(throw.doll, **whole, angles=angles)
