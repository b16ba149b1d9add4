"""A steady spin whose joints are moved by what is sensed of its small deviations."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import by_name, instance, one_of, text
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.stability._coordinates import coordinates
from somersault.stability._delay import DelayedFeedback
from somersault.stability._growth import reduced
from somersault.stability._gyric import GyricSystem
from somersault.stability._types import LinearSpin

_RATE = "_rate"


def feedback(
    spin: LinearSpin, coordinate: str, commands: str, gains: Mapping[str, float]
) -> DelayedFeedback:
    """A joint motion that follows a law of what is sensed of a steady spin.

    Motions that keep the angular momentum are looked at, as in all stability here.

    Parameters
    ----------
    spin : LinearSpin
        With the joint motion free; it may be sprung and damped where torques are commanded.
    coordinate : str
        The joint motion, as the spin's `coordinates` have it: "antisymmetric shoulder", say. What
        is commanded is of its first joint, and the other one of a pair does its part.
    commands : {"torque", "rate", "angle"}
        What the law commands: a torque (gains in kg m² Ω², or kg m² Ω of rates), the motion's rate
        or its angle, which is then exactly followed and has to be the only joint motion there is
        besides those that do not act on it.
    gains : mapping of str to float
        By what is sensed: the spin's `coordinates`, and their rates with "_rate", time in units
        of 1/Ω.

    Returns
    -------
    DelayedFeedback

    Raises
    ------
    SomersaultError
        For a name that is not there, or that is no joint motion.

    Examples
    --------
    >>> import somersault as so
    >>> from somersault.stability import feedback
    >>> layout = so.spin("furrer", pose={"shoulder": 1.3}).linear()
    >>> loop = feedback(layout, "antisymmetric shoulder", "angle", {"twist": 0.5})
    >>> loop.stable_delays()
    ()
    """
    instance("a spin", spin, LinearSpin)
    one_of("commands", commands, _COMMANDED)
    (part,) = spin.system.parts(text("coordinate", coordinate))
    driven = part.place(coordinate)
    if driven not in part.joints:
        raise SomersaultError(f"{coordinate} is no joint motion; drive one of the joints")
    weights = {name: number(f"gains.{name}", x) for name, x in by_name("gains", gains).items()}
    for name in weights:
        part.place(name.removesuffix(_RATE))
    return _COMMANDED[commands](_Parts(spin, part, driven, weights))


class _Parts:
    """ẋ = V x + W q̇ of the deviations x, joints' rates q̇, and what is sensed of them, in the units
    of `GyricSystem.scaled`."""

    def __init__(
        self, spin: LinearSpin, part: GyricSystem, driven: int, gains: Mapping[str, float]
    ) -> None:
        scaled = part.scaled()
        order = scaled.order
        self.reduced = reduced(scaled)
        names = [part.names[k] for k in order]
        self.count = len(names) - scaled.first
        self.names = names[scaled.first :]
        self.sizes = part.sizes[order][scaled.first :]
        self.moves = self.names.index(part.names[driven])
        self.joint = self.moves - (self.count - len(part.joints))
        self.joints = len(part.joints)
        self.from_x = self.reduced.matrix[: self.count, : self.count]
        self.from_rates = self.reduced.matrix[: self.count, self.count :] / self.reduced.rate_scale
        self.angles, self.rates = np.zeros(self.count), np.zeros(self.count)
        for name, gain in gains.items():
            row = self.rates if name.endswith(_RATE) else self.angles
            place = self.names.index(name.removesuffix(_RATE))
            row[place] += gain / self.sizes[place]
        moved = coordinates(spin.spin.model, spin.spin.axis)
        column = moved.columns[:, moved.names.index(part.names[driven])]
        self.many = float(column @ column)  # joints that have the torque

    def require_alone(self, commands: str) -> None:
        """SomersaultError where another joint motion acts on the one that is driven."""
        if self.joints > 1:
            raise SomersaultError(
                f"{commands}s are commanded of one joint motion, and here are "
                f"{', '.join(self.names[self.count - self.joints :])}; lock the others"
            )


def _torque(of: _Parts) -> DelayedFeedback:
    whole = of.reduced.matrix
    drive = np.zeros(len(whole))
    force = np.zeros(of.joints)
    force[of.joint] = of.many / of.sizes[of.moves]
    drive[of.count :] = np.linalg.solve(of.reduced.kinetic, force) / of.reduced.rate_scale
    sensed = of.rates @ whole[: of.count]
    sensed[: of.count] += of.angles
    return DelayedFeedback(whole, drive, sensed)


def _rate(of: _Parts) -> DelayedFeedback:
    of.require_alone("rate")
    drive = of.from_rates[:, 0] * of.sizes[of.moves]
    return DelayedFeedback(
        of.from_x, drive, of.angles + of.rates @ of.from_x, _clean(float(of.rates @ drive))
    )


def _angle(of: _Parts) -> DelayedFeedback:
    """With z = x − W a the rate of the angle a is no part of the equations: ż = V (z + W a)."""
    of.require_alone("angle")
    if of.rates[of.moves] or _clean(float(of.rates @ of.from_rates[:, 0])):
        raise SomersaultError(
            "an angle is not commanded by a rate that follows that of the angle itself; command "
            "the rate, or sense something else"
        )
    turns = np.arange(of.count) != of.moves
    column = of.from_rates[:, 0] * of.sizes[of.moves]
    v = of.from_x[turns]
    whole: Array = v[:, turns]
    drive = v @ column
    sensed_x: Any = of.angles + of.rates[turns] @ v
    return DelayedFeedback(whole, drive, sensed_x[turns], _clean(float(sensed_x @ column)))


def _clean(value: float) -> float:
    """Without what rounding leaves where there is nothing."""
    return value if abs(value) > 1e-12 else 0.0


_COMMANDED = {"torque": _torque, "rate": _rate, "angle": _angle}
