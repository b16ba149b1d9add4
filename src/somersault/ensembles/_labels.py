"""What a dataset says of itself: units, specification, versions, and what its codes mean."""

from __future__ import annotations

import json
from typing import Any

from somersault.engine import processor
from somersault.ensembles._plan import Plan
from somersault.ensembles._vary import Vary
from somersault.simulation import ENDED

FORMAT = "somersault ensemble 2"


def attributes(plan: Plan) -> dict[str, Any]:
    """Of the whole: specification and versions, as JSON texts, and the kind of processor."""
    return {
        "format": FORMAT,
        "model": plan.simulation.name,
        "specification": json.dumps(plan.specification),
        "versions": json.dumps(plan.versions),
        "processor": processor(),
    }


def variable_attributes(plan: Plan, name: str) -> dict[str, Any]:
    """Of a variable: its unit, and of `ended` what its codes mean (as the CF conventions have it)
    which of them are failures, and which successes."""
    variable = plan.variables[name]
    labels: dict[str, Any] = {"units": variable.unit}
    if variable.words:
        labels["long_name"] = variable.words
    if name == ENDED:
        endings = plan.simulation.endings
        labels["flag_values"] = list(range(len(endings.words)))
        labels["flag_meanings"] = _one_word_each(endings.words)
        labels["failures"] = _one_word_each(endings.failed)
        if endings.good:
            labels["successes"] = _one_word_each(endings.good)
    return labels


def _one_word_each(words: tuple[str, ...]) -> str:
    return " ".join(word.replace(" ", "_") for word in words)


def coordinate_attributes(vary: Vary) -> dict[str, Any]:
    """Of a varied quantity: what it moves, and its unit."""
    labels: dict[str, Any] = {("adds_to" if vary.adds_to else "sets"): list(vary.targets)}
    if vary.scale != 1:
        labels["scale"] = vary.scale
    return {**labels, "units": vary.unit} if vary.unit else labels
