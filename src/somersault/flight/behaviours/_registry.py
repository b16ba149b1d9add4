"""The behaviours there are, by their names, and the sentence for a key that one does not have."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, ClassVar

import numpy as np

from somersault._core.checks import shown
from somersault._core.errors import SomersaultError


class Registry(type):
    """Makes `JointTakeoff("sprung", …)` and `JointTakeoff.sprung(…)` out of the class that is
    called so, and turns a key that the class does not have into one sentence."""

    classes: ClassVar[dict[str | None, type[Any]]] = {}

    def __call__(cls, *given: Any, **named: Any) -> Any:
        if cls._root():
            motion, *rest = given or (named.pop("motion", None),)
            return behaviour_of(motion)(*rest, **named)
        named = cls.keys_of(named)
        every: Any = cls
        by_place = [f.name for f in fields(every) if not f.kw_only]
        if len(given) > len(by_place):
            raise SomersaultError(
                f"a joint that is {cls._called()} takes {_listed(cls._keys())}; give them by name"
            )
        return super().__call__(*given, **named)

    def __getattr__(cls, name: str) -> Any:
        if cls._root() and name in Registry.classes:
            return Registry.classes[name]
        known = "" if name.startswith("_") else f"; behaviours are {_listed(behaviour_names())}"
        raise AttributeError(f"{cls.__name__} has no {name!r}{known}")

    def kind_of(cls, motion: str | None) -> type[Any]:
        """The behaviour of a name; SomersaultError if there is none."""
        return behaviour_of(motion)

    def keys_of(cls, given: Mapping[str, Any]) -> dict[str, Any]:
        """Those of some numbers by name that this behaviour has.

        What it does not have may be nothing (0, false, none), and is left out; SomersaultError
        for anything else.
        """
        for key in given:
            if key not in cls._keys() and not (key in _every_key() and _nothing(given[key])):
                raise SomersaultError(_refusal(cls, key))
        return {key: value for key, value in given.items() if key in cls._keys()}

    def _root(cls) -> bool:
        return cls.__mro__[1] is object  # `JointTakeoff` itself

    def _keys(cls) -> list[str]:
        every = getattr(cls, "__dataclass_fields__", {})
        return [name for name in every if name not in cls.__mro__[-2].__annotations__]

    def _called(cls) -> str:
        return cls.motion or "as modelled"


def behaviour_of(motion: Any) -> type[Any]:
    """The class of a behaviour.

    Parameters
    ----------
    motion : str or None
        Its name; None for what the model says.

    Returns
    -------
    type

    Raises
    ------
    SomersaultError
        For a name that no behaviour has.
    """
    if motion is None:
        return Registry.classes["as modelled"]
    if not isinstance(motion, str) or motion not in behaviour_names():
        raise SomersaultError(
            f"{shown(motion)} is no motion of a joint; use {_listed(behaviour_names())}"
        )
    return Registry.classes[motion]


def behaviour_names() -> list[str]:
    """Names of the behaviours in their order, without that of what the model says.

    Returns
    -------
    list of str
    """
    return sorted(name for name in Registry.classes if name not in (None, "as modelled"))


def _every_key() -> set[str]:
    return {key for cls in Registry.classes.values() for key in cls._keys()}


def _nothing(value: Any) -> bool:
    """Whether a value is as good as none."""
    try:
        return value is None or value is False or bool(np.all(np.asarray(value) == 0))
    except (TypeError, ValueError):
        return False


def _refusal(cls: Any, key: str) -> str:
    takes = f"it takes {_listed(cls._keys())}" if cls._keys() else "it takes nothing"
    if key in _every_key():
        return f"{key} would do nothing for a joint that is {cls._called()}; leave it out ({takes})"
    return f"{key} is nothing that a joint has; one that is {cls._called()} takes {takes[9:]}"


def _listed(names: list[str]) -> str:
    return ", ".join(names)
