"""A joint in symbols, as the equations of a behaviour see it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from somersault.model import Joint


@dataclass(frozen=True)
class Here:
    """A joint in symbols, as its behaviour sees it.

    `q` and `u` are its coordinates and speeds, `numbers` its parameters by name, `paths` the
    value, rate and acceleration of each of its paths now. `outboard` gives, for each of its speeds,
    the inertia about its axis of all that is outboard, in the pose in which the paths have the
    body. `tape` is the motor tape's torque. `leader` is the joint that it follows. `carried` are
    the numbers that it carries from tick to tick.
    """

    joint: Joint
    q: list[Any]
    u: list[Any]
    time: Any
    numbers: Mapping[str, Any]
    paths: tuple[tuple[Any, Any, Any], ...]
    outboard: Callable[[], list[Any]]
    tape: Any = 0.0
    leader: Known | None = None
    carried: Sequence[Any] = ()

    def at(self, known: Known) -> Here:
        """The same with other coordinates: those of a joint that is no part of the state.

        Parameters
        ----------
        known : Known

        Returns
        -------
        Here
        """
        return replace(self, q=known.q, u=known.u)

    def following(self, leader: Known | None) -> Here:
        """The same with the joint that it follows.

        Parameters
        ----------
        leader : Known or None

        Returns
        -------
        Here
        """
        return replace(self, leader=leader)


@dataclass(frozen=True)
class Known:
    """Coordinates, speeds and accelerations of a joint; no accelerations where it moves freely."""

    q: list[Any]
    u: list[Any]
    a: list[Any]
