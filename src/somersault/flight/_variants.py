"""A maneuver otherwise: with other fields, from another takeoff, in another time."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from typing import Any, Self

from somersault._core.checks import instance
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.flight._compliance import against, compliant, off_nominal, with_momentum
from somersault.flight._replay import Replay
from somersault.flight._takeoff import Takeoff
from somersault.flight.behaviours import JointTakeoff
from somersault.model import Model


class Variants:
    """The calls of a maneuver, a frozen dataclass with these fields, that return another."""

    model: Model
    takeoff: Takeoff
    duration: float

    def changed(self, **fields: Any) -> Self:
        """The same with other fields.

        Parameters
        ----------
        **fields
            By their names: takeoff, duration, gravity …

        Returns
        -------
        Maneuver

        Raises
        ------
        SomersaultError
            For a field that a maneuver does not have.

        Examples
        --------
        >>> import somersault as so
        >>> layout = so.Maneuver("furrer", so.Takeoff(spin=8.64), 0.5)
        >>> layout.changed(duration=1.0).duration
        1.0
        """
        here = [field.name for field in dataclasses.fields(self)]  # type: ignore[arg-type]
        for name in fields:
            if name not in here:
                known = ", ".join(here)
                raise SomersaultError(f"{name} is no part of a maneuver; there are {known}")
        changed: Any = dataclasses.replace(self, **fields)  # type: ignore[type-var]
        return changed

    def compliant(
        self,
        natural_frequency: float | Mapping[str, float],
        damping_ratio: float | Mapping[str, float] = 0.7,
        *,
        pose: Mapping[str, float] | float | str,
        **options: Any,
    ) -> Self:
        """The same with a body that gives way about the motion.

        Parameters
        ----------
        natural_frequency : float or mapping of str to float
            rad/s, of all joints or by joint.
        damping_ratio : float or mapping of str to float
        pose : mapping of str to float, float or str
            As for `somersault.compliant`.
        **options
            The others of `somersault.compliant`.

        Returns
        -------
        Maneuver
            With what `somersault.compliant` makes of its takeoff.

        Raises
        ------
        SomersaultError
            For what does not fit.

        Examples
        --------
        >>> import somersault as so
        >>> raised = {"shoulder": [(0.0, 0.0), (0.2, 1.2)]}
        >>> arms = so.Maneuver.moves("furrer", raised, so.Takeoff(spin=8.64))
        >>> arms.compliant(30.0, pose={"shoulder": 1.2}).takeoff.joints["left_shoulder"].motion
        'compliant'
        """
        takeoff = compliant(
            self.model, self.takeoff, natural_frequency, damping_ratio, pose=pose, **options
        )
        return self.changed(takeoff=takeoff)

    def replayed(self, replay: Replay) -> Self:
        """The same with paths and motor tape played at a rate by a law.

        Parameters
        ----------
        replay : Replay
            Unless it has another nominal flight, its errors are against this maneuver's, whatever
            becomes of the takeoff; it has to be given by angles.

        Returns
        -------
        Maneuver

        Examples
        --------
        >>> import somersault as so
        >>> law = so.Replay(law="1 + k * twist_error", gains={"k": -0.5}, delay=0.1)
        >>> twist = so.arm_tilt().compliant(30.0, pose="wrap").replayed(law)
        >>> twist.off_nominal(tilt=-0.05).fly().ended
        'duration'
        """
        instance("replay", replay, Replay)
        kept = against(self.model, self.takeoff, replay)
        return self.changed(takeoff=dataclasses.replace(self.takeoff, replay=kept))

    def from_takeoff(self, takeoff: Takeoff) -> Self:
        """The same moves from another takeoff.

        Parameters
        ----------
        takeoff : Takeoff
            What it says of joints is kept; the other joints do what they did.

        Returns
        -------
        Maneuver

        Examples
        --------
        >>> import somersault as so
        >>> layout = so.Maneuver("furrer", so.Takeoff(spin=8.64), 0.5)
        >>> layout.from_takeoff(so.Takeoff(spin=9.0)).takeoff.spin
        9.0
        """
        given = instance("takeoff", takeoff, Takeoff).joints
        joints = {**self.takeoff.joints, **given}
        return self.changed(takeoff=dataclasses.replace(takeoff, joints=joints))

    def with_momentum(self) -> Self:
        """The same with its rotation given as angular momentum.

        Returns
        -------
        Maneuver
            With what `somersault.with_momentum` makes of its takeoff.
        """
        return self.changed(takeoff=with_momentum(self.model, self.takeoff))

    def off_nominal(
        self, *, somersault: float = 0.0, tilt: float = 0.0, twist: float = 0.0
    ) -> Self:
        """The same from an attitude that is off by small angles.

        Parameters
        ----------
        somersault, tilt, twist : float
            By how much, rad.

        Returns
        -------
        Maneuver
            With what `somersault.off_nominal` makes of its takeoff.

        Raises
        ------
        SomersaultError
            For what does not fit.

        Examples
        --------
        >>> import somersault as so
        >>> layout = so.Maneuver("furrer", so.Takeoff(spin=8.64), 0.5)
        >>> leant = layout.off_nominal(tilt=0.05)
        >>> round(float(leant.fly().angles[0, 1]), 9)
        0.05
        """
        takeoff = off_nominal(
            self.model, self.takeoff, somersault=somersault, tilt=tilt, twist=twist
        )
        return self.changed(takeoff=takeoff)

    def scaled(self, factor: float) -> Self:
        """The same moves in another time; it takes off as before.

        Parameters
        ----------
        factor : float
            Times and duration are multiplied by it: 2 is half as fast.

        Returns
        -------
        Maneuver

        Raises
        ------
        SomersaultError
            Unless the factor is positive.

        Examples
        --------
        >>> import somersault as so
        >>> so.Maneuver("furrer", so.Takeoff(spin=8.64), 0.5).scaled(2.0).duration
        1.0
        """
        if number("factor", factor) <= 0:
            raise SomersaultError(f"factor {factor:g} turns time back or stops it; give one over 0")
        moved = self._retimed(lambda does: does.scaled_in_time(factor))
        return moved.changed(duration=factor * self.duration)

    def reversed(self) -> Self:
        """The same moves from the last to the first; it takes off as before.

        Returns
        -------
        Maneuver
        """
        return self._retimed(lambda does: does.reversed_in_time(self.duration))

    def _retimed(self, change: Callable[[JointTakeoff], JointTakeoff]) -> Self:
        joints = {name: change(does) for name, does in self.takeoff.joints.items()}
        return self.changed(takeoff=dataclasses.replace(self.takeoff, joints=joints))
