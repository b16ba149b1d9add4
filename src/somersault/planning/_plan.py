"""A plan: a maneuver that was found, and what it takes."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from somersault._core.array import Array
from somersault.attitude import unwrapped_angles
from somersault.flight import Flight, JointTakeoff, Maneuver, Takeoff, prescribed
from somersault.model import Model
from somersault.motion import DEGREE, Motion, Path
from somersault.planning._ipopt import Outcome
from somersault.planning._task import ANGLES, Task
from somersault.planning._transcription import Transcription

if TYPE_CHECKING:
    import xarray as xr

_ROUNDING = 1e-6  # rad, m: by what the solver may be beyond a bound


@dataclass(frozen=True)
class Attempt:
    """What came of one start.

    Parameters
    ----------
    ended : str
        IPOPT's word for how it ended.
    iterations : int
    objective : float
        What was to be least: with an angle that is to be great, less that angle (rad) and what the
        effort counts.
    solved : bool
        Whether it keeps to all that was asked.
    """

    ended: str
    iterations: int
    objective: float
    solved: bool


@dataclass(frozen=True, eq=False)
class Plan:
    """A maneuver that does what was asked, as `plan` returns it.

    Attributes
    ----------
    model : Model
        The body.
    times : array (nodes,)
        s, evenly spaced.
    angles : array (nodes, 3)
        Somersault, tilt and twist, rad, whole turns counted.
    motion : Motion
        Paths of the joints that move: cubics from node to node.
    angular_momentum : array (3,)
        In inertial axes, kg m²/s.
    attempts : tuple of Attempt
        What came of each start.
    ended : str
        IPOPT's word for how this one ended.
    iterations : int
        Of the last refinement.
    seconds : float
        That the search took.

    Examples
    --------
    >>> import somersault as so
    >>> arms = {"shoulder": (0.2, 2.8)}
    >>> plan = so.plan("furrer", 1, 1, torque=60.0, joints=arms, start={"shoulder": 2.8}, nodes=20)
    >>> round(plan.rotations["twist"], 3)
    1.0
    >>> plan.departure < 1e-3
    True
    """

    model: Model
    times: Array
    angles: Array
    motion: Motion
    angular_momentum: Array
    attempts: tuple[Attempt, ...]
    ended: str
    iterations: int
    seconds: float
    _torques: Array = field(repr=False)
    _still: dict[str, JointTakeoff] = field(repr=False)

    def __repr__(self) -> str:
        turns = ", ".join(f"{name} {turn:.2f}" for name, turn in self.rotations.items())
        return f"Plan({self.model.name}, {self.duration:.3g} s, turns: {turns})"

    @property
    def duration(self) -> float:
        """Of the flight, s."""
        return float(self.times[-1])

    @property
    def rotations(self) -> dict[str, float]:
        """Turns from takeoff to landing: somersault, tilt and twist."""
        turned = (self.angles[-1] - self.angles[0]) / (2 * np.pi)
        return dict(zip(ANGLES, turned.tolist(), strict=True))

    @property
    def torques(self) -> xr.DataArray:
        """What muscles or motors do at the joints that move, besides the model's own springs and
        dampers, (time, joint), N m (N)."""
        import xarray as xr

        return xr.DataArray(
            self._torques,
            {"time": self.times, "joint": list(self.motion.joints)},
            ("time", "joint"),
            "torque",
            {"units": "N m or N"},
        )

    @cached_property
    def maneuver(self) -> Maneuver:
        """The plan as a maneuver whose joints are prescribed: to fly, to save, to make compliant,
        to vary."""
        somersault, tilt, twist = self.angles[0].tolist()
        takeoff = Takeoff(
            somersault=somersault, tilt=tilt, twist=twist,
            angular_momentum=self.angular_momentum.tolist(),
            joints={**self._still, **prescribed(self.model, self.motion, self.duration)},
        )  # fmt: skip
        return Maneuver(self.model, takeoff, self.duration)

    def fly(self, **options: Any) -> Flight:
        """The flight of the plan, by the package's integrator.

        Parameters
        ----------
        **options
            As for `Maneuver.fly`.

        Returns
        -------
        Flight

        Examples
        --------
        >>> import somersault as so
        >>> arms = {"shoulder": (0.2, 2.8)}
        >>> ends = {"torque": 60.0, "joints": arms, "start": {"shoulder": 2.8}, "nodes": 20}
        >>> abs(so.plan("furrer", 1, 1, **ends).fly().landing.somersault - 6.2832) < 1e-3
        True
        """
        return self.maneuver.fly(**options)

    @cached_property
    def departure(self) -> float:
        """The greatest difference, rad, between the plan's angles at its nodes and those of its
        flight: what the collocation errs by."""
        flight = self.fly(samples=self.times)
        angles = unwrapped_angles(flight.base_quaternion, self.model.axes, self.angles[0])
        angles = angles + 2 * np.pi * np.round((self.angles[0] - angles[0]) / (2 * np.pi))
        return float(np.abs(angles - self.angles).max())


def as_plan(
    task: Task, grid: Transcription, outcome: Outcome, attempts: tuple[Attempt, ...], seconds: float
) -> Plan:
    """The plan that a solution is.

    Parameters
    ----------
    task : Task
    grid : Transcription
        The program that it solves.
    outcome : Outcome
    attempts : tuple of Attempt
    seconds : float
        That the search took.
    """
    layout, moving, x = grid.layout, task.moving, outcome.x
    duration = float(x[layout.duration])
    torques = grid.program.outputs(x)[: layout.nodes, 3 : 3 + task.count] * moving.units
    model = task.model
    still = {}
    for joint in model.joints:
        if joint.name not in moving.joints and joint.follows is None:
            where = moving.still[model.coordinate_slice(joint.name)]
            still[joint.name] = JointTakeoff.locked(angle=_angle(where))
    return Plan(
        model, np.linspace(0.0, duration, layout.nodes), x[layout.angles],
        _motion(task, grid, x, duration), x[layout.momentum] / duration, attempts, outcome.status,
        outcome.iterations, seconds, torques, still,
    )  # fmt: skip


def _angle(where: Array) -> Any:
    """A joint's coordinate; of a ball its rotation vector."""
    if len(where) == 1:
        return float(where[0])
    size = np.linalg.norm(where[1:])
    turn = 2 * np.arctan2(size, where[0])
    return tuple((turn / size * where[1:]).tolist()) if size else (0.0, 0.0, 0.0)


def _motion(task: Task, grid: Transcription, x: Array, duration: float) -> Motion:
    """Cubics from node to node."""
    layout = grid.layout
    step = duration / layout.intervals
    q, u, a = x[layout.q], x[layout.v] / duration, x[layout.w] / duration**2
    pieces = np.zeros((layout.intervals, task.count, DEGREE + 1))
    pieces[..., 0], pieces[..., 1], pieces[..., 2] = q[:-1], u[:-1], a[:-1] / 2
    pieces[..., 3] = np.diff(a, axis=0) / (6 * step)
    whole = np.concatenate([pieces[:1], pieces])
    knots = np.arange(layout.intervals) * step
    paths = {name: Path(knots, whole[:, k]) for k, name in enumerate(task.moving.joints)}
    return Motion(paths, 0.0, duration, held=False, source="a plan", slack=_ROUNDING)
