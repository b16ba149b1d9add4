"""What the figures of a somersault are made of: times, rates and lengths of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from somersault._core.array import Array
from somersault.history import Recording
from somersault.robot import Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def excerpt(run: Run, first: float, last: float) -> Recording:
    """Two hundred samples a second of a part of a run, to be filmed."""
    k = between_times(run, first, last)[::5]
    return Recording(
        run.model, run.times[k], run.base_position[k], run.base_quaternion[k],
        run.joint_coordinates[k], run.angles[k],
    )  # fmt: skip


def degrees(run: Run) -> dict[str, float]:
    """What is reported of a run, its angles in degrees."""
    return {name: float(np.degrees(x)) for name, x in run.outcome.items()}


def between_times(run: Run, first: float, last: float) -> Array:
    """Samples between two times."""
    return np.flatnonzero((run.times >= first) & (run.times < last))


def between(run: Run, state: str, other: str) -> Array:
    """Samples from where one state begins to where another does."""
    return between_times(run, run.began(state), run.began(other))


def of_legs(run: Run, name: str) -> list[int]:
    """Where MuJoCo keeps the rate of a joint of both legs."""
    m = run.robot.machine.mujoco
    return [int(m.joint(f"{side}_{name}").dofadr[0]) for side in ("left", "right")]


def hip_rate(run: Run) -> Array:
    """Mean rate of the hips fore and aft, deg/s."""
    found: Array = np.degrees(run.rates[:, of_legs(run, "hip_y")].mean(axis=1))
    return found


def leg_length(run: Run) -> Array:
    """Of the left leg, m."""
    place = run.model.coordinates.index("left_leg")
    found: Array = run.robot.machine.resting[0] + run.joint_coordinates[:, place]
    return found


def apart(run: Run) -> Array:
    """Distance between the feet, m."""
    found: Array = np.linalg.norm(run.sensed[:, 6:9] - run.sensed[:, 10:13], axis=1)
    return found


def both(run: Run) -> Array:
    """Whether both feet are on the ground."""
    return np.all(run.sensed[:, [9, 13]] > 1.0, axis=1)


def touched(run: Run, side: int, after: float) -> float:
    """When a foot first stands on the ground after a time, s."""
    down = (run.sensed[:, 9 + 4 * side] > 1.0) & (run.times > after)
    return float(run.times[np.argmax(down)])


def lines(run: Run, axes: list[Axes], states: tuple[str, ...]) -> None:
    """Lines where states began."""
    from somersault.view import style as look

    for ax in axes:
        for state in states:
            ax.axvline(run.began(state), color=look.GREY, lw=0.8, ls="--")
        ax.spines[["top", "right"]].set_visible(False)
