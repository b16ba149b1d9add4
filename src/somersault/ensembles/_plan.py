"""A whole ensemble as a value: what is flown, what varies, what is told."""

from __future__ import annotations

import hashlib
import json
import math
import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import cache, cached_property
from importlib.metadata import PackageNotFoundError, version
from itertools import pairwise
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault.ensembles import _report, _vary
from somersault.ensembles._report import Report
from somersault.ensembles._targets import Target, body_names, check_apart, moved, targets
from somersault.ensembles._vary import Vary
from somersault.flight._batch import Batch
from somersault.flight._system import System
from somersault.flight._takeoff import Takeoff
from somersault.flight._values import Name
from somersault.model import Model, model_digest

SAMPLE = "sample"
MOST_FLIGHTS = 10**11
MOST_SEED = 2**63 - 1
_MOST_LISTED = 1_000
_TOGETHER = 16_384  # flights whose numbers are held at once,
_TOGETHER_BYTES = 2**26  # or as many as these hold
_NAME = re.compile(r"\w[\w-]*")  # of an array in a store, and of a word in its attributes
_ENGINES = ("somersault", "casadi", "llvmlite", "numpy", "scipy")


@dataclass(frozen=True, eq=False)
class Plan:
    """Everything that decides the numbers of an ensemble, and nothing else.

    Flights are numbered along the dimensions in `dims`, the last running fastest.
    """

    model: Model
    takeoff: Takeoff
    duration: float
    vary: Mapping[str, Vary]
    report: Report
    size: int
    seed: int
    sequence: str
    accuracy: float
    until: str | None
    steps: int

    def __getstate__(self) -> dict[str, Any]:
        return {name: getattr(self, name) for name in self.__dataclass_fields__}

    @cached_property
    def _nominal(self) -> Mapping[Name, float | Array]:
        return Batch(self.model, self.takeoff, self.duration).values

    @cached_property
    def targets(self) -> dict[str, tuple[Target, ...]]:
        """The numbers that each varied quantity moves."""
        return {
            name: targets(self.model, self._nominal, f"vary.{name}", vary)
            for name, vary in self.vary.items()
        }

    @cached_property
    def bodies(self) -> tuple[str, ...]:
        """Numbers of the bodies that are varied."""
        return body_names(self.targets)

    @cached_property
    def batch(self) -> Batch:
        """The flights, which share their equations."""
        return Batch(
            self.model, self.takeoff, self.duration, self.until, self.bodies,
            tuple(self.report.extremes),
        )  # fmt: skip

    @property
    def system(self) -> System:
        """Their equations."""
        return self.batch.system

    @property
    def dims(self) -> dict[str, int]:
        """Dimensions and their lengths."""
        found = {name: len(v.grid) for name, v in self.vary.items() if v.grid is not None}
        if len(found) < len(self.vary) or self.size > 1 or not found:
            found[SAMPLE] = self.size
        return found

    @property
    def count(self) -> int:
        """How many flights."""
        return math.prod(self.dims.values())

    @property
    def values(self) -> Mapping[Name, float | Array]:
        """The numbers of the takeoff before anything is varied."""
        return self.batch.values

    def coordinate(self, name: str, places: Array) -> Array:
        """Values of a varied quantity at places along its dimension."""
        grid = self.vary[name].grid
        if grid is not None:
            return grid[places]
        return self.drawn(places)[name]

    def drawn(self, places: Array) -> dict[str, Array]:
        """Values of what runs along `sample`, at rising places."""
        along = {n: v for n, v in self.vary.items() if v.grid is None}
        return _vary.draws(along, self.sequence, self.seed, places)

    def varied(self, first: int, last: int) -> dict[str, Array]:
        """Every varied quantity of flights first … last − 1."""
        dims = self.dims
        at = dict(
            zip(dims, np.unravel_index(np.arange(first, last), tuple(dims.values())), strict=True)
        )
        found = {n: v.grid[at[n]] for n, v in self.vary.items() if v.grid is not None}
        if len(found) < len(self.vary):
            least, most = int(at[SAMPLE].min()), int(at[SAMPLE].max())
            drawn = self.drawn(np.arange(least, most + 1))
            found |= {name: x[at[SAMPLE] - least] for name, x in drawn.items()}
        return found

    def fly(self, first: int, last: int) -> dict[str, Array]:
        """The variables of flights first … last − 1.

        Each flight's numbers depend on nothing but its own place.
        """
        given = self.varied(first, last)
        edges = [*range(0, last - first, self._together), last - first]
        with np.errstate(over="ignore", invalid="ignore"):  # such a flight ends "not finite"
            parts = [
                self._fly({name: x[a:b] for name, x in given.items()}, b - a)
                for a, b in pairwise(edges)
            ]
        return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}

    @cached_property
    def _together(self) -> int:
        chosen, report = self.system, self.report
        rows = 3 + 2 * len(report.extremes) + chosen.layout.state
        samples = report.samples if report.history else 0
        doubles = 12 * (rows + chosen.layout.parameters)
        doubles += samples * (3 * rows + 2 * chosen.layout.parameters)
        moved = {target.name[0] for group in self.targets.values() for target in group}
        if moved & {"times", "angles", "angle"}:  # each flight has paths of its own, and a tape
            knots = self.batch.begun().course.knots
            doubles += 6 * knots.shape[1] * chosen.layout.changing
        return min(_TOGETHER, max(_TOGETHER_BYTES // (8 * doubles), 64))

    def _fly(self, given: Mapping[str, Array], count: int) -> dict[str, Array]:
        """The variables of flights whose varied quantities are `given`."""
        chosen = self.system
        values = moved(self.values, self.vary, self.targets, given)
        good = self.batch.sound(values, count)
        if not good.all():  # stand-ins, which are struck out again
            nominal = self.values
            values = {
                n: np.where(good, x, nominal[n]) if isinstance(x, np.ndarray) else x
                for n, x in values.items()
            }
        begun = self.batch.begun(values, count)
        angles, course = begun.starts.angles, begun.course
        states, watched = np.split(begun.rows, [chosen.layout.state], 1)
        watched[:] = _report.first_watched(self.report, chosen, angles, states, course)
        times = self.report.times(self.duration)
        found = begun.solve(times, self.accuracy, self.steps)
        return _report.told(self.report, chosen, course, found, angles, good, times)

    @cached_property
    def specification(self) -> dict[str, Any]:
        """All that decides the numbers, as plain data."""
        takeoff = asdict(self.takeoff)
        return {
            "model": self.model.name,
            "axes": list(self.model.axes),
            "model_sha256": model_digest(self.model),
            "duration": self.duration,
            "until": self.until,
            "accuracy": self.accuracy,
            "steps": self.steps,
            "takeoff": _plain(takeoff),
            "vary": {name: _plain(asdict(v) | _listed(v)) for name, v in self.vary.items()},
            "sample": {"size": self.size, "seed": self.seed, "sequence": self.sequence},
            "report": _plain(asdict(self.report)),
        }

    @property
    def engines(self) -> dict[str, str]:
        """Versions of what computes: with others the last digits may be others."""
        return engines()


def _listed(vary: Vary) -> dict[str, Any]:
    """Numbers one by one, however they were given; the digest of very many."""
    found: dict[str, Any] = {}
    for key, given in (("values", vary.grid), ("samples", vary.samples)):
        if given is not None:
            numbers = np.asarray(given, float)
            digest = hashlib.sha256(numbers.tobytes()).hexdigest()
            found[key] = numbers.tolist() if numbers.size <= _MOST_LISTED else digest
    return found


@cache
def engines() -> dict[str, str]:
    """The versions that this process has."""
    found = {}
    for name in _ENGINES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "(none)"
    return found


def _plain(value: Any) -> Any:
    """As JSON has it; what was left out is left out."""
    if isinstance(value, Mapping):
        return {
            str(k): _plain(v)
            for k, v in value.items()
            if v is not None and not (isinstance(v, tuple) and not v)
        }
    if isinstance(value, np.ndarray) and value.size > _MOST_LISTED:  # a recorded path
        return hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    return value


def check(plan: Plan) -> None:
    """SomersaultError, naming what is wrong, unless every part of a plan makes sense."""
    for name, vary in plan.vary.items():
        _vary.check(name, vary)
        if not _NAME.fullmatch(name):
            raise SomersaultError(
                f"vary.{name!r} is no name for a quantity; names are of letters, digits, _ and -"
            )
        if name == SAMPLE or name in ("time", "steps", "ended", "history_time"):
            raise SomersaultError(f"vary.{name}: that name is taken; call the quantity otherwise")
    _check_sample(plan)
    _report.check(plan.report, plan.system)
    told = _report.variables(plan.report, plan.system)
    for name in plan.vary:
        if name in told:
            raise SomersaultError(
                f"vary.{name} has the name of something reported; call it takeoff_{name}, say"
            )
    check_apart(plan.vary, plan.targets)
    if plan.count > MOST_FLIGHTS:
        shape = " x ".join(f"{n} {length}" for n, length in plan.dims.items())
        raise SomersaultError(
            f"vary asks for {plan.count:.3g} flights ({shape}); at most {MOST_FLIGHTS:.0e} fly"
        )
    _check_edges(plan)
    json.dumps(plan.specification)


def _check_sample(plan: Plan) -> None:
    if not isinstance(plan.sequence, str) or plan.sequence not in _vary.SEQUENCES:
        raise SomersaultError(
            f"sample.sequence {plan.sequence!r} is none; use {', '.join(_vary.SEQUENCES)}"
        )
    along = [name for name, v in plan.vary.items() if v.grid is None]
    drawn = [name for name, v in plan.vary.items() if v.distribution is not None]
    if plan.size > 1 and not along:
        raise SomersaultError(
            f"sample.size is {plan.size}, but nothing is drawn; give a quantity a distribution"
        )
    for name in along:
        listed = plan.vary[name].samples
        if listed is not None and len(listed) != plan.size:
            raise SomersaultError(
                f"vary.{name}.samples has {len(listed)} numbers, but sample.size is {plan.size}"
            )
        if listed is not None and plan.sequence == "saltelli":
            raise SomersaultError(
                f"vary.{name}.samples cannot go along with the saltelli sequence, which has an "
                "order of its own; use random, sobol or halton"
            )
    if plan.sequence == "saltelli" and plan.size % (len(drawn) + 2):
        raise SomersaultError(
            f"sample.size is {plan.size}; the saltelli sequence of {len(drawn)} drawn quantities "
            f"needs a multiple of {len(drawn) + 2}"
        )


def _check_edges(plan: Plan) -> None:
    """Refuse a grid whose ends cannot take off: a mistake, not a flight that fails."""
    for name, vary in plan.vary.items():
        if vary.grid is None:
            continue
        ends = np.array([vary.grid.min(), vary.grid.max()])
        one = {name: vary}
        values = moved(plan.values, one, {name: plan.targets[name]}, {name: ends})
        good = plan.batch.sound(values, 2)
        if not good.all():
            raise SomersaultError(
                f"vary.{name}.values has {ends[~good][0]:g}, with which there is no takeoff "
                f"({', '.join(vary.targets)}: limits, order of times, or sign)"
            )
