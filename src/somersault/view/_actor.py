"""A history on the stage: where its bodies are at the moments of a film, and its vectors."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from somersault._core.array import Array
from somersault.attitude import (
    AXES,
    in_sequence,
    matrix_from_quaternion,
    quaternion_conjugate,
    quaternion_product,
)
from somersault.history import History
from somersault.model import Model, body_frames, centre_of_mass, segment_momenta
from somersault.view._canvas import Surface
from somersault.view._meshes import Figure, figure_of
from somersault.view.style import rgb

_SLOWEST = 1e-5  # rad/s: what turns more slowly stands still
_SPREAD = 60  # moments that tell how much room it needs


@dataclass(frozen=True, eq=False)
class Actor:
    """A history as it is at some moments (T,), in axes front, left and up; all of one colour, if a
    `tint` is given."""

    history: History
    moments: Array
    tint: str | None = None

    @cached_property
    def figure(self) -> Figure:
        """What it looks like."""
        figure = figure_of(self.history.model)
        if self.tint is None:
            return figure
        paints = figure.surface.paints.copy()
        paints[:, :3] = rgb(self.tint)
        return replace(figure, surface=Surface(figure.surface.faces, paints))

    @cached_property
    def stage(self) -> Array:
        """Rows front, left and up in inertial axes."""
        axes = self.history.model.axes if self.history.model.free else AXES
        return np.array(in_sequence(list(np.eye(3)), axes))

    @cached_property
    def _joints(self) -> Array:
        return joints_at(self.history, self.moments)

    @cached_property
    def _turns(self) -> Array:
        """From the base's axes to the stage's, (T, 3, 3)."""
        quaternions = turned_at(self.history.times, self.history.base_quaternion, self.moments)
        return self.stage @ matrix_from_quaternion(quaternions)

    @cached_property
    def _base(self) -> Array:
        places = values_at(self.history.times, self.history.base_position, self.moments)
        return places @ self.stage.T

    @cached_property
    def frames(self) -> tuple[Array, Array]:
        """Axes and origins of all bodies, (T, bodies, 3, 3) and (T, bodies, 3)."""
        rotations, origins = body_frames(self.history.model, self._joints)
        turned = np.einsum("tij,tbj->tbi", self._turns, origins) + self._base[:, None]
        return self._turns[:, None] @ rotations, turned

    @cached_property
    def centres(self) -> Array:
        """Of mass, (T, 3)."""
        own = centre_of_mass(self.history.model, self._joints)
        return np.einsum("tij,tj->ti", self._turns, own) + self._base

    @cached_property
    def vectors(self) -> dict[str, Array]:
        """Angular momentum about the centre of mass (kg m²/s) and the angular velocity of the base
        (rad/s), (T, 3) each: the momentum is the history's own where it has one, as flights do,
        which know it exactly; the rest are differences of what the history holds."""
        history, model = self.history, self.history.model
        turn = matrix_from_quaternion(history.base_quaternion)
        omega = turning(history.times, history.base_quaternion)
        momentum = getattr(history, "angular_momentum", None)
        if momentum is None:
            speeds = joint_speeds(history)
            own = segment_momenta(model, history.joint_coordinates, omega, speeds).sum(1)
            momentum = np.einsum("tij,tj->ti", turn, own)
        inertial = {"momentum": momentum, "spin": np.einsum("tij,tj->ti", turn, omega)}
        return {
            name: values_at(history.times, np.asarray(values, float), self.moments) @ self.stage.T
            for name, values in inertial.items()
        }

    @cached_property
    def longest(self) -> dict[str, float]:
        """How long each of the vectors gets; 0 for one that is nothing but rounding."""
        reach = float(np.linalg.norm(self.corners(0)[0] - self.centres[0], axis=1).max())
        # An arrow is seen from a turn in some days on.
        least = {"momentum": _SLOWEST * self.history.model.mass * reach**2, "spin": _SLOWEST}
        sizes = {n: float(np.linalg.norm(v, axis=1).max()) for n, v in self.vectors.items()}
        return {name: size if size > least[name] else 0.0 for name, size in sizes.items()}

    def corners(self, k: int) -> tuple[Array, Array]:
        """Corners of its triangles at a moment and the normals there, (n, 3) each."""
        figure = self.figure
        axes, origins = (values[k] for values in self.frames)
        points, normals = np.empty_like(figure.points), np.empty_like(figure.normals)
        # Corners stand in the order of their bodies.
        ends = np.searchsorted(figure.bodies, np.arange(len(origins) + 1))
        for body, (first, last) in enumerate(pairwise(ends)):
            own = axes[body].T
            points[first:last] = figure.points[first:last] @ own + origins[body]
            normals[first:last] = figure.normals[first:last] @ own
        return points, normals

    @cached_property
    def outline(self) -> tuple[Array, Array]:
        """What stands out farthest at some moments spread over all, (moments, n, 3), and the
        centres of mass then, (moments, 3)."""
        count = len(self.moments)
        which = np.unique(np.linspace(0, count - 1, min(count, _SPREAD)).round().astype(int))
        figure = self.figure
        bodies, points = figure.bodies[figure.far], figure.points[figure.far]
        axes, origins = (values[which] for values in self.frames)
        turned = np.einsum("knij,nj->kni", axes[:, bodies], points)
        return turned + origins[:, bodies], self.centres[which]


def values_at(times: Array, values: Array, moments: Array) -> Array:
    """Columns (T, n) at moments between their times, along straight lines; held at both ends."""
    if not values.shape[1]:
        return np.empty((len(moments), 0))
    return np.stack([np.interp(moments, times, column) for column in values.T], -1)


def turned_at(times: Array, quaternions: Array, moments: Array) -> Array:
    """Attitudes at moments between their times, each turning evenly from one to the next."""
    if len(times) == 1:
        return np.repeat(quaternions, len(moments), 0)
    before = np.clip(np.searchsorted(times, moments, side="right") - 1, 0, len(times) - 2)
    one, two = quaternions[before], quaternions[before + 1]
    share = np.clip((moments - times[before]) / (times[before + 1] - times[before]), 0, 1)[:, None]
    cosine = np.sum(one * two, 1, keepdims=True)
    two = np.where(cosine < 0, -two, two)
    angle = np.arccos(np.clip(np.abs(cosine), 0, 1))
    sine = np.sin(angle)
    even = sine < 1e-6
    sine = np.where(even, 1.0, sine)
    first = np.where(even, 1 - share, np.sin((1 - share) * angle) / sine)
    second = np.where(even, share, np.sin(share * angle) / sine)
    mixed = first * one + second * two
    return mixed / np.linalg.norm(mixed, axis=1, keepdims=True)


def joints_at(history: History, moments: Array) -> Array:
    """Joint coordinates at moments between the samples, (T, coordinates)."""
    given = history.joint_coordinates
    joints = values_at(history.times, given, moments)
    for where in _balls(history.model):
        joints[:, where] = turned_at(history.times, given[:, where], moments)
    return joints


def turning(times: Array, quaternions: Array) -> Array:
    """Angular velocities (T, 3) of attitudes, in the axes that turn, rad/s."""
    if len(times) == 1:
        return np.zeros((1, 3))
    after = np.minimum(np.arange(len(times)) + 1, len(times) - 1)
    before = np.maximum(np.arange(len(times)) - 1, 0)
    turn = quaternion_product(quaternion_conjugate(quaternions[before]), quaternions[after])
    turn = np.where(turn[:, :1] < 0, -turn, turn)
    size = np.linalg.norm(turn[:, 1:], axis=1, keepdims=True)
    angle = 2 * np.arctan2(size, turn[:, :1])
    along = turn[:, 1:] * np.where(size < 1e-9, 2.0, angle / np.where(size < 1e-9, 1.0, size))
    return along / (times[after] - times[before])[:, None]


def joint_speeds(history: History) -> Array:
    """Joint speeds (T, speeds) from differences of the joint coordinates."""
    model, times, q = history.model, history.times, history.joint_coordinates
    speeds = np.zeros((len(times), len(model.speeds)))
    if len(times) == 1:
        return speeds
    for joint in model.joints:
        own, rates = model.coordinate_slice(joint.name), model.speed_slice(joint.name)
        ball = joint.kind == "ball"
        speeds[:, rates] = (
            turning(times, q[:, own]) if ball else np.gradient(q[:, own], times, axis=0)
        )
    return speeds


def _balls(model: Model) -> list[slice]:
    return [model.coordinate_slice(j.name) for j in model.joints if j.kind == "ball"]
