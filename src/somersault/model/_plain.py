"""What decides a model's results, as plain data that can be written, compared and hashed."""

from __future__ import annotations

import hashlib
import json
from dataclasses import fields, is_dataclass
from typing import Any

from somersault._core.checks import instance
from somersault.model._model import Model

_NAMES = ("name", "ignored")  # of a model: what it is called, and what its file held besides


def plain_form(model: Model) -> dict[str, Any]:
    """All of a model that decides results, as JSON has it.

    Names of bodies and joints, numbers and axes, but neither the model's own name nor its shapes.
    What stands at its default is left out, so that the form of today's models stays the same when
    models learn to hold more.

    Parameters
    ----------
    model : Model

    Returns
    -------
    dict
        Of texts, numbers, truth values, lists and dicts.
    """
    form = _plain(instance("model", model, Model))
    return {name: value for name, value in form.items() if name not in _NAMES}


def model_digest(model: Model) -> str:
    """The SHA-256 of `plain_form`: the same for models that give the same results.

    Parameters
    ----------
    model : Model

    Returns
    -------
    str
        Hexadecimal.
    """
    return hashlib.sha256(json.dumps(plain_form(model), sort_keys=True).encode()).hexdigest()


def _plain(value: Any) -> Any:
    if is_dataclass(value):
        return {
            field.name: _plain(getattr(value, field.name))
            for field in fields(value)
            if field.compare and getattr(value, field.name) != field.default
        }
    if isinstance(value, tuple):
        return [_plain(part) for part in value]
    if isinstance(value, float):
        return value + 0.0  # no negative zero
    return value
