"""Values in canonical form: what is written as JSON, compared and hashed."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from os import PathLike
from typing import Any

import numpy as np

_MOST_LISTED = 1_000  # numbers that are listed one by one


def canonical(value: Any) -> Any:
    """A value as JSON has it, without what was left out: None and empty tuples.

    Very many numbers become their SHA-256 digest.
    """
    if is_dataclass(value) and not isinstance(value, type):
        return canonical({field.name: getattr(value, field.name) for field in fields(value)})
    if isinstance(value, Mapping):
        return {
            str(name): canonical(x)
            for name, x in value.items()
            if x is not None and not (isinstance(x, tuple) and not x)
        }
    if isinstance(value, np.ndarray) and value.size > _MOST_LISTED:
        return hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, list | tuple):
        return [canonical(x) for x in value]
    return str(value) if isinstance(value, PathLike) else value
