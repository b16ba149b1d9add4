"""A joint that does what a law of sensed quantities commands: what such behaviours share."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import casadi as ca
import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.flight.behaviours import _declared
from somersault.flight.behaviours._behaviour import JointTakeoff
from somersault.flight.behaviours._here import Here
from somersault.flight.behaviours._law import Law, checked_times, commanded
from somersault.flight.behaviours._sensing import Senses, Sensing
from somersault.laws import Formula, mirrored, mirrored_name
from somersault.model import Joint, Model
from somersault.simulation import Name


@dataclass(frozen=True)
class ByLaw(Law, JointTakeoff):
    """A joint with a `Law`."""

    bounds: ClassVar[tuple[str, ...]] = ()
    """Names of the numbers that bound what is commanded."""

    def settled(self, joint: Joint) -> JointTakeoff:
        where = f"joint {joint.name}"
        if joint.coordinates != 1:
            raise SomersaultError(f"{where} is a {joint.kind}, which takes no law; give it hinges")
        plan = super().settled(joint)
        assert isinstance(plan, ByLaw)
        return replace(plan, **checked_times(plan, where))

    def mirrored(self, model: Model, name: str, factor: float, offset: float) -> Any:
        plan = super().mirrored(model, name, factor, offset)
        law = mirrored(Formula(self.law), model, factor)
        noise = {mirrored_name(name, model): x for name, x in self.noise.items()}
        return replace(plan, law=law.text, noise=_declared.Table(noise))

    def reversed_in_time(self, end: float) -> Any:
        """Refused: a law senses what was, so it does not run backwards.

        Parameters
        ----------
        end : float
            s.

        Returns
        -------
        JointTakeoff

        Raises
        ------
        SomersaultError

        Examples
        --------
        >>> import somersault as so
        >>> so.JointTakeoff.rate_law(law="twist").reversed_in_time(1.0)
        Traceback (most recent call last):
            ...
        somersault._core.errors.SomersaultError: a law senses what was, so it does not run backwards
        """
        raise SomersaultError("a law senses what was, so it does not run backwards")

    def kind(self) -> Any:
        return replace(super().kind(), **self.empty_tables)

    def parameters(self, joint: Joint) -> tuple[str, ...]:
        return (*super().parameters(joint), *self.tables, *self.bounds)

    def plainest(self, joint: Joint, sensed: frozenset[str], varied: frozenset[Name]) -> Any:
        """The plainest behaviour that does the same: one without a law, where the class has such
        a one and the law commands nothing whatever is sensed.

        Parameters
        ----------
        joint : Joint
        sensed : frozenset of str
            What there is to sense.
        varied : frozenset of tuple
            Names of the numbers in which flights differ.

        Returns
        -------
        JointTakeoff
        """
        return self

    def _always(self, sensed: frozenset[str], varied: frozenset[Name]) -> float | None:
        """What the law commands whatever is sensed; None if that depends, or numbers of it vary."""
        names, gains = Formula(self.law).names, set(self.gains)
        if not names <= sensed | gains or gains & sensed:
            return None  # it is refused when it is worked out
        if self.noisy and ("takeoff", "noise") in varied:
            return None
        known = {name: ca.SX.sym(name) for name in names & sensed}
        value = Formula(self.law).value({**known, **self.gains})
        return float(value) if value.is_constant() else None

    # ----------------------------------------------------------------------------- at ticks

    @property
    def sensing(self) -> Sensing:
        return self

    @property
    def carried(self) -> int:
        """How many numbers it carries: what is done now, and the commands that wait."""
        return 1 + self.waits

    def at_takeoff(self, q: Array, u: Array) -> Array:
        """What it carries before the first tick.

        Parameters
        ----------
        q, u : ndarray, (count, 1)
            Its own, at takeoff.

        Returns
        -------
        ndarray, (count, carried)
        """
        first = np.repeat(self.before(q, u)[:, None], self.carried, 1)
        first[:, 0] = 0.0
        return first

    def before(self, q: Array, u: Array) -> Array:
        """What is commanded before anything was sensed.

        Parameters
        ----------
        q, u : ndarray, (count, 1)
            The joint's own at takeoff.

        Returns
        -------
        ndarray, (count,)
        """
        return np.zeros(len(q))

    def tick(self, here: Here, senses: Senses) -> list[Any]:
        """What it carries from a tick on: what the law says now goes to the end of those commands
        that wait, the first of them is acted on, and what that comes to stands in front.

        Parameters
        ----------
        here : Here
        senses : Senses

        Returns
        -------
        list
        """
        command = commanded(self, f"joint {here.joint.name}", here.numbers, senses)
        waiting = [*here.carried[1:], command]
        return [self.acted_on(here, waiting[0]), *waiting[1:]]

    def acted_on(self, here: Here, command: Any) -> Any:
        """What is done until the next tick, by what is commanded now.

        Parameters
        ----------
        here : Here
        command : casadi.SX
            Of the law, after its delay.

        Returns
        -------
        casadi.SX
        """
        raise NotImplementedError

    @property
    def conservative(self) -> bool:
        return False
