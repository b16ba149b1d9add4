"""A joint that does what a law of sensed quantities commands: what such behaviours share."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import casadi as ca
import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number
from somersault.flight.behaviours import _declared
from somersault.flight.behaviours._behaviour import JointTakeoff
from somersault.flight.behaviours._here import Here
from somersault.flight.behaviours._sensing import Senses, Sensing
from somersault.laws import Formula, mirrored, mirrored_name
from somersault.model import Joint, Model

_MOST_TICKS_OF_DELAY = 1_000
_NEARLY = 1e-9  # of a tick
_NO_TABLE = _declared.Table()


@dataclass(frozen=True)
class ByLaw(JointTakeoff):
    """A joint with a `law`: a formula (`somersault.laws.Formula`) of what is sensed, by name.

    Sensed are somersault, tilt, twist (rad; whole turns are counted), their rates
    (`twist_rate` …), the angular velocity about the body's axes (`angular_velocity_1` …), joint
    coordinates and their rates by name, and `time`. Other names are `gains`. The law is worked out
    `every` so many seconds from takeoff on, and acts after its `delay`, which is a whole number of
    them; before that it commands nothing. `noise` gives the standard deviation with which
    a quantity is sensed, by its name; the deviates are those of the takeoff's `noise`.
    """

    bounds: ClassVar[tuple[str, ...]] = ()
    """Names of the numbers that bound what is commanded."""

    law: str = field(default="", kw_only=True, metadata={"structure": True})
    gains: Mapping[str, float] = _declared.quantity("1", default=_NO_TABLE, table=True)
    noise: Mapping[str, float] = _declared.quantity("1", default=_NO_TABLE, table=True)
    every: float = field(default=0.02, kw_only=True, metadata={"structure": True})
    delay: float = field(default=0.0, kw_only=True, metadata={"structure": True})

    def settled(self, joint: Joint) -> JointTakeoff:
        where = f"joint {joint.name}"
        if joint.coordinates != 1:
            raise SomersaultError(f"{where} is a {joint.kind}, which takes no law; give it hinges")
        plan = super().settled(joint)
        assert isinstance(plan, ByLaw)
        every, delay = (number(f"{where}: {n}", getattr(self, n)) for n in ("every", "delay"))
        _check_times(where, every, delay)
        names = Formula(plan.law).names
        idle = sorted(set(plan.gains) - names)
        if idle:
            raise SomersaultError(
                f"{where} has the gain {idle[0]}, which its law {plan.law!r} does not have; "
                "correct one of them"
            )
        silent = sorted(set(plan.noise) - names)
        if silent:
            raise SomersaultError(
                f"{where} senses {silent[0]} with noise, but its law {plan.law!r} does not have "
                "it; leave it out"
            )
        return replace(plan, every=every, delay=delay)

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
        gains, noise = (dict.fromkeys(table, 0.0) for table in (self.gains, self.noise))
        return replace(super().kind(), gains=_declared.Table(gains), noise=_declared.Table(noise))

    def parameters(self, joint: Joint) -> tuple[str, ...]:
        tables = {"gains": self.gains, "noise": self.noise}
        names = tuple(f"{what}.{key}" for what, table in tables.items() for key in table)
        return (*super().parameters(joint), *names, *self.bounds)

    # ----------------------------------------------------------------------------- at ticks

    @property
    def waits(self) -> int:
        """Ticks between sensing and acting."""
        return round(self.delay / self.every)

    @property
    def sensing(self) -> Sensing:
        return self

    @property
    def carried(self) -> int:
        """How many numbers it carries: what is done now, and the commands that wait."""
        return 1 + self.waits

    @property
    def noisy(self) -> bool:
        """Whether it senses with noise."""
        return bool(self.noise)

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

        Raises
        ------
        SomersaultError
            For a gain that has the name of something that is sensed.
        """
        known = dict(senses.known)
        for name in self.gains:
            if name in known:
                raise SomersaultError(
                    f"joint {here.joint.name} has a gain {name}, which is also something that is "
                    "sensed; give the gain another name"
                )
            known[name] = here.numbers[f"gains.{name}"]
        for name in self.noise:
            known[name] = known[name] + here.numbers[f"noise.{name}"] * senses.normal()
        waiting = [*here.carried[1:], Formula(self.law).value(known)]
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


def bounded(value: Any, most: Any) -> Any:
    """A number that is not beyond ±most; one that is none stays so."""
    return between(value, -most, most)


def between(value: Any, low: Any, high: Any) -> Any:
    """A number that is not below `low` nor above `high`; one that is none stays so."""
    return ca.if_else(value > high, high, ca.if_else(value < low, low, value))


def _check_times(where: str, every: float, delay: float) -> None:
    if every <= 0:
        raise SomersaultError(f"{where} senses every {every:g} s; give a time above 0")
    if delay < 0:
        raise SomersaultError(f"{where} has a delay of {delay:g} s; give 0 or more")
    ticks = delay / every
    if ticks > _MOST_TICKS_OF_DELAY:
        raise SomersaultError(
            f"{where} has a delay of {ticks:.0f} ticks; make it shorter, or sense less often"
        )
    if abs(ticks - round(ticks)) > _NEARLY * max(ticks, 1.0):
        raise SomersaultError(
            f"{where} has a delay of {delay:g} s, which is no whole number of the {every:g} s "
            "between its ticks; change one of them"
        )
