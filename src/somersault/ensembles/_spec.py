"""Ensembles described in a TOML file: of flights, a robot's runs or spins, and what varies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, get_type_hints

from somersault._core.checks import file_path, name_list, text
from somersault._core.errors import SomersaultError
from somersault.ensembles._plan import Plan, plan
from somersault.ensembles._vary import Vary
from somersault.flight import KEYS, Maneuver, Report, flights
from somersault.robot import KEYS as RUN_KEYS
from somersault.robot import parse_runs
from somersault.simulation import Simulation
from somersault.spec import (
    Unfit,
    model_beside,
    read_as,
    read_toml,
    require_table,
    structured,
    structured_within,
)
from somersault.stability import spins

_ACCURACY = 1e-7
_HINTS = get_type_hints(Vary)


@dataclass(frozen=True)
class Sample:
    """[sample]: how many are drawn, and how."""

    size: int | None = None
    seed: int = 0
    sequence: str = "random"


@dataclass(frozen=True)
class Reported:
    """[report]: what is reported of each flight, as in `Report`."""

    quantities: tuple[str, ...] | None = None
    extremes: tuple[str, ...] = ()
    history: tuple[str, ...] = ()
    samples: int = 0


@dataclass(frozen=True)
class Tables:
    """The tables that an ensemble's SPEC has besides those of a flight."""

    vary: Mapping[str, Vary] | None = None
    sample: Sample = field(default_factory=Sample)
    report: Reported = field(default_factory=Reported)
    target: Mapping[str, float] = field(default_factory=dict)


_TABLES = tuple(Tables.__dataclass_fields__)
_DRAWN = ("vary", "sample")  # those of an ensemble that reports what it reports


@dataclass(frozen=True)
class Spin:
    """[spin]: the spins that are judged, as in `stability.spins`."""

    pose: Mapping[str, float] = field(default_factory=dict)
    stiffness: Mapping[str, float] = field(default_factory=dict)
    damping: Mapping[str, float] = field(default_factory=dict)
    axis: str | None = None
    lock: tuple[str, ...] = ()


@dataclass(frozen=True)
class SpinKeys:
    """The keys of a SPEC of many spins besides those of what varies."""

    model: str
    spin: Spin


@dataclass(frozen=True)
class EnsembleSpec:
    """What a SPEC file asks for; `tolerance` of landings, if it gives one.

    `quantities` are what is reported of each flight's end.
    """

    plan: Plan
    tolerance: float | None
    quantities: tuple[str, ...]


def read_ensemble(path: Path) -> EnsembleSpec:
    """The ensemble in a TOML file, a SPEC as `somersault ensemble` takes it.

    Parameters
    ----------
    path : pathlib.Path
        Files that it names are looked for in the same folder.

    Returns
    -------
    EnsembleSpec

    Raises
    ------
    SomersaultError
        Naming the key, for what does not fit.
    """
    file = file_path("a SPEC", path)
    return parse_ensemble(read_toml(file), file.parent)


def parse_ensemble(
    given: Mapping[str, Any], beside: Path, others: Sequence[str] = (), of: str | None = None
) -> EnsembleSpec:
    """The ensemble in a SPEC's tables.

    Parameters
    ----------
    given : mapping
        As TOML has it.
    beside : pathlib.Path
        The folder in which files that it names are looked for.
    others : sequence of str
        Keys that it may also have, and that somebody else reads.
    of : str, optional
        Whose SPEC it then is, in a message: "a design's SPEC".

    Returns
    -------
    EnsembleSpec

    Raises
    ------
    SomersaultError
        Naming the key, for what does not fit.
    """
    require_table(given)
    if "robot" in given:
        known, called = [*RUN_KEYS, *_DRAWN], "an ensemble of runs"
    elif "spin" in given:
        known, called = [*SpinKeys.__dataclass_fields__, *_DRAWN], "an ensemble of spins"
    elif "samples" in given:
        raise SomersaultError("samples is no key of an ensemble's SPEC; histories are in [report]")
    else:
        known = [*(key for key in KEYS if key != "samples"), *_TABLES]
        called = "an ensemble's SPEC"
    apart = name_list("others", others)
    called = called if of is None else text("of", of)
    given = {key: value for key, value in given.items() if key not in apart}
    for key in _TABLES:
        if not isinstance(given.get(key, {}), Mapping):
            raise SomersaultError(f"{key} must be a table; write [{key}]")
    if "vary" in given and not given["vary"]:
        raise SomersaultError("vary is empty; say what varies, [vary.NAME], or leave it out")
    _require_keys(given, [*known, *apart], called)
    if "robot" in given:
        return _of_runs(given, beside)
    if "spin" in given:
        return _of_spins(given, beside)
    flown = Maneuver.parse({k: v for k, v in given.items() if k not in _TABLES}, beside)
    keys = _tables(given)
    target = dict(keys.target)
    tolerance = target.pop("tolerance", None)
    if tolerance is not None and not (tolerance > 0 and target):
        raise SomersaultError(
            "target.tolerance must be a positive number, together with angles to land at"
        )
    default = Report.quantities + (("landing_error",) if target else ())
    quantities = default if keys.report.quantities is None else keys.report.quantities
    reported = Report(quantities, keys.report.extremes, keys.report.history, keys.report.samples)
    if tolerance is not None and "landing_error" not in quantities:
        raise SomersaultError("target.tolerance needs landing_error among report.quantities")
    accuracy = None if "accuracy" in given else _ACCURACY
    many = flights(flown, report=reported, against=target, accuracy=accuracy)
    return EnsembleSpec(_planned(many, keys), tolerance, reported.quantities)


def _of_runs(given: Mapping[str, Any], beside: Path) -> EnsembleSpec:
    """Runs of a robot, which report what they report."""
    runs = parse_runs({k: v for k, v in given.items() if k not in _DRAWN}, beside)
    return EnsembleSpec(_planned(runs, _tables(given)), None, tuple(runs.variables))


def _of_spins(given: Mapping[str, Any], beside: Path) -> EnsembleSpec:
    """Spins of a model, which report how stable each is for small motions."""
    one = structured({k: v for k, v in given.items() if k not in _DRAWN}, SpinKeys)
    many = spins(
        model_beside(one.model, file_path("beside", beside)), pose=one.spin.pose,
        stiffness=one.spin.stiffness, damping=one.spin.damping, axis=one.spin.axis,
        lock=one.spin.lock,
    )  # fmt: skip
    return EnsembleSpec(_planned(many, _tables(given)), None, tuple(many.variables))


def _tables(given: Mapping[str, Any]) -> Tables:
    return structured({k: v for k, v in given.items() if k in _TABLES}, Tables)


def _planned(simulation: Simulation, keys: Tables) -> Plan:
    sample = keys.sample
    return plan(simulation, dict(keys.vary or {}), sample.size, sample.seed, sample.sequence)


def _require_keys(given: Mapping[str, Any], known: Sequence[str], of: str) -> None:
    for key in given:
        if key not in known:
            raise SomersaultError(f"{key} is no key of {of}; here it takes {', '.join(known)}")


# ------------------------------------------------------------------------ kinds of value


def _names(value: Any, _: Any) -> Any:
    texts = [value] if isinstance(value, str) else value
    if not isinstance(texts, list | tuple) or not all(isinstance(t, str) for t in texts):
        raise Unfit("a text or a list of texts", value)
    return value


def _grid(value: Any, _: Any) -> Any:
    if not isinstance(value, list | Mapping):
        raise Unfit("a list of numbers, or {from, to, count}", value)
    return value


def _row(value: Any, _: Any) -> Any:
    return structured_within(value, Sequence[float])


read_as(_HINTS["sets"], _names)
read_as(_HINTS["values"], _grid)
read_as(_HINTS["samples"], _row)
