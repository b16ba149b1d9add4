"""Ensembles described in a TOML file: a flight's SPEC, and what varies."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from somersault._core.errors import SomersaultError
from somersault.ensembles import DISTRIBUTIONS, Plan, Vary, plan
from somersault.flight import Report, flights
from somersault.spec._flight import TOP, parse_spec, read_toml
from somersault.spec._keys import NUMBER, NUMBERS, TEXT, TEXTS, WHOLE, check_keys

_TABLES = ("vary", "sample", "report", "target")
_VARY = {
    "sets": "", "adds_to": "", "values": "", "samples": NUMBERS, "scale": NUMBER, "unit": TEXT,
    **dict.fromkeys(DISTRIBUTIONS, NUMBERS),
}  # fmt: skip
_SAMPLE = {"size": WHOLE, "seed": WHOLE, "sequence": TEXT}
_REPORT = {"quantities": TEXTS, "extremes": TEXTS, "history": TEXTS, "samples": WHOLE}
_ACCURACY = 1e-7


@dataclass(frozen=True)
class EnsembleSpec:
    """What a SPEC file asks for; `tolerance` of landings, if it gives one.

    `quantities` are what is reported of each flight's end.
    """

    plan: Plan
    tolerance: float | None
    quantities: tuple[str, ...]


def read_ensemble(path: Path) -> EnsembleSpec:
    """The ensemble in a TOML file; SomersaultError, naming the key, for what does not fit."""
    return parse_ensemble(read_toml(path), path.parent)


def parse_ensemble(given: Mapping[str, Any], beside: Path) -> EnsembleSpec:
    """The ensemble in a SPEC's tables."""
    for key in _TABLES:
        if not isinstance(given.get(key, {}), Mapping):
            raise SomersaultError(f"{key} must be a table; write [{key}]")
    if "vary" in given and not given["vary"]:
        raise SomersaultError("vary is empty; say what varies, [vary.NAME], or leave it out")
    if "samples" in given:
        raise SomersaultError("samples is no key of an ensemble's SPEC; histories are in [report]")
    known = [*(key for key in TOP if key != "samples"), *_TABLES]
    for key in given:
        if key not in known:
            raise SomersaultError(
                f"{key} is no key of an ensemble's SPEC; here it takes {', '.join(known)}"
            )
    flight = parse_spec({k: v for k, v in given.items() if k not in _TABLES}, beside)
    sample, report, target = (dict(given.get(key, {})) for key in _TABLES[1:])
    check_keys("sample.", sample, _SAMPLE)
    check_keys("report.", report, _REPORT)
    check_keys("target.", target, dict.fromkeys(target, NUMBER))
    tolerance = target.pop("tolerance", None)
    if tolerance is not None and not (tolerance > 0 and target):
        raise SomersaultError(
            "target.tolerance must be a positive number, together with angles to land at"
        )
    vary = {name: _vary(name, table) for name, table in given.get("vary", {}).items()}
    default = Report.quantities + (("landing_error",) if target else ())
    reported = Report(
        tuple(report.get("quantities", default)), tuple(report.get("extremes", ())),
        tuple(report.get("history", ())), int(report.get("samples", 0)),
    )  # fmt: skip
    if tolerance is not None and "landing_error" not in reported.quantities:
        raise SomersaultError("target.tolerance needs landing_error among report.quantities")
    accuracy = flight.options["accuracy"] if "accuracy" in given else _ACCURACY
    size = sample.get("size")
    many = flights(
        flight.model, flight.takeoff, flight.duration, report=reported, against=target,
        accuracy=accuracy, until=flight.options["until"], steps=flight.options["steps"],
    )  # fmt: skip
    planned = plan(
        many, vary, None if size is None else int(size), int(sample.get("seed", 0)),
        sample.get("sequence", "random"),
    )  # fmt: skip
    return EnsembleSpec(planned, tolerance, reported.quantities)


def _vary(name: str, table: Any) -> Vary:
    if not isinstance(table, Mapping):
        raise SomersaultError(f"vary.{name} must be a table; write [vary.{name}]")
    known = [f.name for f in fields(Vary)]
    for key, value in table.items():
        if key not in known:
            raise SomersaultError(
                f"vary.{name}.{key} is no key of a SPEC; here it takes {', '.join(known)}"
            )
        if key in ("sets", "adds_to"):
            texts = [value] if isinstance(value, str) else value
            if not isinstance(texts, list) or not all(isinstance(t, str) for t in texts):
                raise SomersaultError(f"vary.{name}.{key} must be a text or a list of texts")
        elif key == "values":
            if not isinstance(value, list | Mapping):
                raise SomersaultError(
                    f"vary.{name}.values must be a list of numbers, or {{from, to, count}}"
                )
        else:
            check_keys(f"vary.{name}.", {key: value}, _VARY)
    return Vary(**table)
