"""A whole ensemble as a value: what is run, and what varies."""

from __future__ import annotations

import hashlib
import json
import math
import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.canonical import canonical
from somersault._core.checks import by_name, instance, shown, whole_number
from somersault._core.degrees import MOST_TURNS, note_degrees
from somersault._core.errors import SomersaultError
from somersault.ensembles import _vary
from somersault.ensembles._moved import check_apart, moved, moved_by, unit
from somersault.ensembles._vary import Vary
from somersault.ensembles._versions import versions
from somersault.simulation import ENDED, Name, Simulation, Target, Variable

SAMPLE = "sample"
OVER_TIME = "history_time"
SEAL = "seal"  # what shows that a chunk of a store is whole
MOST_RUNS = 10**11
_MOST_SEED = 2**63 - 1
_MOST_LISTED = 1_000
_NAME = re.compile(r"\w[\w-]*")  # of an array in a store, and of a word in its attributes


@dataclass(frozen=True, eq=False)
class Plan:
    """Everything that decides the numbers of an ensemble, and nothing else.

    Made by `plan`. Runs are numbered along the dimensions in `dims`, the last running fastest.
    """

    simulation: Simulation
    vary: Mapping[str, Vary]
    targets: Mapping[str, tuple[Target, ...]]
    """The numbers that each varied quantity moves."""
    size: int
    seed: int
    sequence: str

    def __repr__(self) -> str:
        shape = ", ".join(f"{name} {length:,}" for name, length in self.dims.items())
        return f"Plan({self.simulation.name}, {shape})"

    def __getstate__(self) -> dict[str, Any]:
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @property
    def dims(self) -> dict[str, int]:
        """Dimensions and their lengths."""
        lengths = {name: len(v.grid) for name, v in self.vary.items() if v.grid is not None}
        if len(lengths) < len(self.vary) or self.size > 1 or not lengths:
            lengths[SAMPLE] = self.size
        return lengths

    @property
    def count(self) -> int:
        """How many runs."""
        return math.prod(self.dims.values())

    @cached_property
    def variables(self) -> dict[str, Variable]:
        """All variables, in order; `ENDED` last: a chunk that has it is complete."""
        ended = Variable("1", "u1", words="how the flight ended")
        return {**self.simulation.variables, ENDED: ended}

    @property
    def along_samples(self) -> list[str]:
        """The varied quantities that run along `sample`: drawn, or listed one by one."""
        return [name for name, vary in self.vary.items() if vary.grid is None]

    def drawn(self, places: Array) -> dict[str, Array]:
        """Values of the varied quantities that run along `sample`.

        Parameters
        ----------
        places : ndarray of int, (n,)
            Along `sample`, in rising order.

        Returns
        -------
        dict of str to ndarray, (n,)
            By the names of `along_samples`, in the unit of each.
        """
        along = {name: self.vary[name] for name in self.along_samples}
        return _vary.draws(along, self.sequence, self.seed, places)

    def varied(self, first: int, last: int) -> dict[str, Array]:
        """Values of every varied quantity of some runs.

        Parameters
        ----------
        first, last : int
            Runs first … last − 1.

        Returns
        -------
        dict of str to ndarray, (last − first,)
        """
        first = whole_number("first", first, 0, self.count - 1)
        last = whole_number("last", last, first + 1, self.count)
        dims = self.dims
        at = dict(
            zip(dims, np.unravel_index(np.arange(first, last), tuple(dims.values())), strict=True)
        )
        given = {n: v.grid[at[n]] for n, v in self.vary.items() if v.grid is not None}
        if len(given) < len(self.vary):
            least, most = int(at[SAMPLE].min()), int(at[SAMPLE].max())
            drawn = self.drawn(np.arange(least, most + 1))
            given |= {name: x[at[SAMPLE] - least] for name, x in drawn.items()}
        return given

    def run(self, first: int, last: int) -> dict[str, Array]:
        """Carry out some runs.

        The numbers of each depend on nothing but its place, not on the runs it is carried out with.

        Parameters
        ----------
        first, last : int
            Runs first … last − 1.

        Returns
        -------
        dict of str to ndarray, (last − first, …)
            By the names of `variables`.
        """
        given = self.varied(first, last)
        edges = [*range(0, last - first, self.simulation.together), last - first]
        with np.errstate(over="ignore", invalid="ignore"):  # such a run ends as it may
            parts = [
                self._run({name: x[a:b] for name, x in given.items()}, b - a)
                for a, b in pairwise(edges)
            ]
        return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}

    def _run(self, given: Mapping[str, Array], count: int) -> Mapping[str, Array]:
        """The variables of runs whose varied quantities are `given`."""
        simulation = self.simulation
        values = moved(simulation.values, self.vary, self.targets, given)
        sound = simulation.sound(values, count)
        if sound.all():
            return simulation.run(values, count)
        nominal = simulation.values  # stands in where there is no run, and is struck out again
        values = {
            name: np.where(sound, x, nominal[name]) if isinstance(x, np.ndarray) else x
            for name, x in values.items()
        }
        rows = dict(simulation.run(values, count))
        for name, x in rows.items():
            rows[name] = np.where(sound.reshape(-1, *[1] * (x.ndim - 1)), x, self._unsound(name))
        return rows

    def _unsound(self, name: str) -> Array:
        """What a variable is of a run that cannot begin."""
        endings, variable = self.simulation.endings, self.variables[name]
        value = endings.code(endings.unsound) if name == ENDED else variable.fill
        return np.asarray(value, variable.dtype)

    @cached_property
    def specification(self) -> dict[str, Any]:
        """All that decides the numbers, as plain data."""
        return {
            **self.simulation.specification,
            "vary": {name: _vary_as_data(vary) for name, vary in self.vary.items()},
            "sample": {"size": self.size, "seed": self.seed, "sequence": self.sequence},
        }

    @cached_property
    def versions(self) -> dict[str, str]:
        """Versions of what computes: with others the last digits may be others."""
        return versions(self.simulation.packages)

    @cached_property
    def digest(self) -> str:
        """Of all that decides the numbers to the last digit."""
        return digest_of(self.specification, self.versions)


def digest_of(specification: Any, versions: Any) -> str:
    """The digest of what decides an ensemble's numbers: plain data, however they were kept."""
    text = json.dumps([specification, versions], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def _vary_as_data(vary: Vary) -> Any:
    """Numbers one by one, however they were given; the digest of very many."""
    listed: dict[str, Any] = {}
    for key, given in (("values", vary.grid), ("samples", vary.samples)):
        if given is not None:
            numbers = np.asarray(given, float)
            digest = hashlib.sha256(numbers.tobytes()).hexdigest()
            listed[key] = numbers.tolist() if numbers.size <= _MOST_LISTED else digest
    return canonical(asdict(vary) | listed)


def plan(
    simulation: Simulation,
    vary: Mapping[str, Vary] | None,
    size: int | None = None,
    seed: int = 0,
    sequence: str = "random",
) -> Plan:
    """What `ensemble` would run.

    Parameters
    ----------
    simulation : Simulation
        What is run: `flight.flights(…)`, for one.
    vary : mapping of str to Vary
    size : int, optional
    seed : int
    sequence : {"random", "sobol", "halton", "saltelli"}
        As for `ensemble`.

    Returns
    -------
    Plan

    Raises
    ------
    SomersaultError
        For what does not fit.

    Examples
    --------
    >>> import somersault as so
    >>> vary = {"leant": so.Vary(adds_to="takeoff.tilt", normal=[0.0, 0.1])}
    >>> so.ensembles.plan(so.flight.flights("furrer"), vary, size=64).dims
    {'sample': 64}
    """
    if not isinstance(simulation, Simulation):
        raise SomersaultError(
            f"{shown(simulation)} is nothing that can be run; give somersault.flight.flights(…)"
        )
    varied = {n: instance(f"vary.{n}", v, Vary) for n, v in by_name("vary", vary).items()}
    for name, quantity in varied.items():
        _check_name(name, simulation)
        _vary.check(name, quantity)
    seed = whole_number("sample.seed", seed, 0, _MOST_SEED)
    if size is not None:
        size = whole_number("sample.size", size, 1, MOST_RUNS)
    else:
        listed = [len(v.samples) for v in varied.values() if v.samples is not None]
        size = listed[0] if listed else 1
    targets = {name: moved_by(simulation, name, v) for name, v in varied.items()}
    check_apart(varied, targets)
    numbers: dict[Name, None] = {t.name: None for group in targets.values() for t in group}
    planned = Plan(
        simulation.with_varied(tuple(numbers)),
        {name: replace(v, unit=unit(v, targets[name])) for name, v in varied.items()},
        targets,
        size,
        seed,
        sequence,
    )
    _check_sample(planned)
    for name, quantity in planned.vary.items():
        if quantity.unit == "rad":
            turning = any({"somersault", "twist"} & {*target.name} for target in targets[name])
            most = MOST_TURNS if turning else 1
            note_degrees(f"vary.{name}", _vary.written(quantity), most)
    if planned.count > MOST_RUNS:
        shape = " x ".join(f"{n} {length}" for n, length in planned.dims.items())
        raise SomersaultError(
            f"vary asks for {planned.count:.3g} {simulation.endings.called} ({shape}); give "
            f"at most {MOST_RUNS:.0e}"
        )
    _check_edges(planned)
    json.dumps(planned.specification)
    return planned


def check_name(what: str, name: str) -> None:
    """SomersaultError for what cannot be the name of a quantity that varies.

    Parameters
    ----------
    what : str
        The table that it stands in: "vary".
    name : str

    Raises
    ------
    SomersaultError
        For other signs than letters, digits, _ and -, and for a name that is taken.
    """
    if not _NAME.fullmatch(name):
        raise SomersaultError(
            f"{what}.{name!r} is no name for a quantity; names are of letters, digits, _ and -"
        )
    if name in (SAMPLE, OVER_TIME, ENDED, SEAL):
        raise SomersaultError(f"{what}.{name}: that name is taken; call the quantity otherwise")


def _check_name(name: str, simulation: Simulation) -> None:
    check_name("vary", name)
    if name in simulation.variables:
        raise SomersaultError(
            f"vary.{name} has the name of something reported; call it takeoff_{name}, say"
        )


def _check_sample(planned: Plan) -> None:
    size, sequence = planned.size, planned.sequence
    if not isinstance(sequence, str) or sequence not in _vary.SEQUENCES:
        raise SomersaultError(
            f"sample.sequence {shown(sequence)} is none; use {', '.join(_vary.SEQUENCES)}"
        )
    drawn = [name for name, v in planned.vary.items() if v.distribution is not None]
    if size > 1 and not planned.along_samples:
        raise SomersaultError(
            f"sample.size is {size}, but nothing is drawn; give a quantity a distribution"
        )
    for name in planned.along_samples:
        listed = planned.vary[name].samples
        if listed is not None and len(listed) != size:
            raise SomersaultError(
                f"vary.{name}.samples has {len(listed)} numbers, but sample.size is {size}"
            )
        if listed is not None and sequence == "saltelli":
            raise SomersaultError(
                f"vary.{name}.samples cannot go along with the saltelli sequence, which has an "
                "order of its own; use random, sobol or halton"
            )
    if sequence == "saltelli" and size % (len(drawn) + 2):
        raise SomersaultError(
            f"sample.size is {size}; the saltelli sequence of {len(drawn)} drawn quantities "
            f"needs a multiple of {len(drawn) + 2}"
        )


def _check_edges(planned: Plan) -> None:
    """Refuse a grid with an end that no run can begin at: a mistake, not a run that fails."""
    simulation = planned.simulation
    for name, vary in planned.vary.items():
        if vary.grid is None:
            continue
        ends = np.array([vary.grid.min(), vary.grid.max()])
        one = {name: planned.targets[name]}
        sound = simulation.sound(moved(simulation.values, {name: vary}, one, {name: ends}), 2)
        if not sound.all():
            raise SomersaultError(
                f"vary.{name}.values has {ends[~sound][0]:g}, which ends in "
                f"{simulation.endings.unsound!r} ({', '.join(vary.targets)}: limits, order of "
                "times, or sign); keep the grid within what is possible"
            )
