"""A motion as what the joints of a takeoff do."""

from __future__ import annotations

from somersault._core.checks import instance
from somersault.flight.behaviours import JointTakeoff, Prescribed
from somersault.model import Model
from somersault.motion import Motion, as_moves


def prescribed(
    model: str | Model, motion: Motion, duration: float | None = None
) -> dict[str, JointTakeoff]:
    """The `joints` of a takeoff that follow a motion exactly.

    Parameters
    ----------
    model : str or Model
    motion : Motion
    duration : float, optional
        s; where it is given the motion must be known from 0 until then.

    Returns
    -------
    dict of str to JointTakeoff
        Joints that the motion does not name are left out. Those of keyframes have `times` and
        `angles`, which an ensemble may vary; those of samples have a `path`.

    Raises
    ------
    SomersaultError
        Where the motion does not fit the model, or is not known for so long.

    Examples
    --------
    >>> import somersault as so
    >>> raise_arms = so.Motion.moves("furrer", {"shoulder": [(0.1, 1.4), (0.4, 0.2)]})
    >>> sorted(so.prescribed("furrer", raise_arms))
    ['left_shoulder', 'right_shoulder']
    """
    instance("motion", motion, Motion)
    joints: dict[str, JointTakeoff] = {}
    for name, path in motion.joint_paths(model, duration).items():
        moves = as_moves(path) if motion.held else None
        if moves is None:
            joints[name] = Prescribed(path=path)
        else:
            times, angles = (tuple(row.tolist()) for row in moves)
            joints[name] = Prescribed(times=times, angles=angles)
    return joints
