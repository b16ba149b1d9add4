"""Tables as frozen dataclasses: what each key may hold is the type of its field.

`structured` makes a dataclass of a table, `plain` a table of a dataclass. What does not fit is one
sentence that names its key.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial
from operator import eq
from typing import Any, Literal, TypeVar, get_args, get_origin

import numpy as np

from somersault._core.checks import shown
from somersault._core.errors import SomersaultError

T = TypeVar("T")
Hook = Callable[[Any, Any], Any]
_hooks: dict[Any, Hook] = {}
_plain: dict[type, Callable[[Any], Any]] = {}


class Unfit(ValueError):  # noqa: N818
    """A value that is not what its key holds: `wanted` says what that would be."""

    def __init__(self, wanted: str, value: Any) -> None:
        super().__init__(wanted)
        self.wanted, self.value = wanted, value


class Misplaced(ValueError):  # noqa: N818
    """A key that does not belong in its table; the message begins with it."""


def structured(table: Any, kind: type[T], where: str = "", of: str = "a SPEC") -> T:
    """A dataclass of a table.

    Parameters
    ----------
    table : mapping
        As TOML has it.
    kind : type
        A dataclass whose fields are the keys.
    where : str
        What stands before a key in a message: "takeoff.", say.
    of : str
        What the table is a part of, where it is no SPEC: the option of a command, say.

    Returns
    -------
    kind

    Raises
    ------
    SomersaultError
        For a key that is none, and a value of another kind, naming the key.
    """
    try:
        return _converter().structure(table, kind)
    except Exception as trouble:
        raise SomersaultError(_sentence(trouble, where.rstrip("."), of)) from None


def structured_within(value: Any, kind: Any) -> Any:
    """A dataclass of a table, for a hook of `read_as`.

    As `structured`, but what does not fit is reported by the call of `structured` that runs the
    hook, with the whole key.

    Parameters
    ----------
    value
        As TOML has it.
    kind : type

    Returns
    -------
    kind
    """
    return _converter().structure(value, kind)


def plain(value: Any) -> Any:
    """A value as TOML has it.

    Parameters
    ----------
    value
        A dataclass, mapping, array, sequence, number or text.

    Returns
    -------
    dict, list, number or str
        A dataclass is a table of those fields that are not at their default.
    """
    for kind, how in _plain.items():
        if isinstance(value, kind):
            return how(value)
    if dataclasses.is_dataclass(value):
        return plain_fields(value)
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return value


def plain_fields(value: Any) -> dict[str, Any]:
    """A dataclass as a table of those fields that are not at their default.

    Unlike `plain`, it does not ask how the class itself is written (`written_as`), so that what
    writes a class can begin with it.

    Parameters
    ----------
    value
        A dataclass.

    Returns
    -------
    dict

    Raises
    ------
    SomersaultError
        For what is none.
    """
    if not dataclasses.is_dataclass(value) or isinstance(value, type):
        raise SomersaultError(f"a table is written from a dataclass, and not from {shown(value)}")
    return {
        field.name: plain(getattr(value, field.name))
        for field in dataclasses.fields(value)
        if not _by_default(field, getattr(value, field.name))
    }


def read_as(kind: Any, hook: Hook) -> None:
    """Register how values of a type are read.

    Parameters
    ----------
    kind : type
    hook : callable
        Of the value as TOML has it and the type; it returns what is to be in the field, or raises
        `Unfit`.
    """
    _hooks[kind] = hook
    _converter.cache_clear()


def written_as(kind: type, how: Callable[[Any], Any]) -> None:
    """Register how values of a class are written.

    Parameters
    ----------
    kind : type
    how : callable
        Of the value; it returns what TOML can hold.
    """
    _plain[kind] = how


def _by_default(field: dataclasses.Field[Any], value: Any) -> bool:
    if field.default is not dataclasses.MISSING:
        standard = field.default
    elif field.default_factory is not dataclasses.MISSING:
        standard = field.default_factory()
    else:
        return False
    try:
        return bool(value is standard or np.array_equal(value, standard))
    except (TypeError, ValueError):
        return False


# ------------------------------------------------------------------------------ what a key holds


def _number(value: Any, _: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise Unfit("a number", value)
    return _as_float(value)


def _as_float(value: float) -> float:
    try:
        return float(value)
    except OverflowError:
        raise Unfit("a finite number below 1e9", value) from None


def _whole(value: Any, _: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise Unfit("a whole number", value)
    if not _as_float(value).is_integer():
        raise Unfit("a whole number", value)
    return int(value)


def _word(value: Any, kind: Any) -> Any:
    words = get_args(kind)
    if not any(type(value) is type(word) and value == word for word in words):
        raise Unfit(" or ".join(map(repr, words)), value)
    return value


def _text(value: Any, _: Any) -> str:
    if not isinstance(value, str):
        raise Unfit("a text", value)
    return value


def _yes(value: Any, _: Any) -> bool:
    if not isinstance(value, bool):
        raise Unfit("true or false", value)
    return value


def _row(value: Any, _: Any) -> tuple[float, ...]:
    try:
        if not isinstance(value, list | tuple):
            raise Unfit("", value)
        return tuple(_number(item, float) for item in value)
    except Unfit:
        raise Unfit("a list of numbers", value) from None


def _texts(value: Any, _: Any) -> tuple[str, ...]:
    if not isinstance(value, list | tuple) or not all(isinstance(item, str) for item in value):
        raise Unfit("a list of texts", value)
    return tuple(value)


_SIMPLE: dict[Any, Hook] = {
    float: _number, int: _whole, str: _text, bool: _yes,
    Sequence[float]: _row, tuple[float, ...]: _row,
    Sequence[str]: _texts, tuple[str, ...]: _texts,
}  # fmt: skip


@cache
def _converter() -> Any:
    import cattrs
    from cattrs.gen import make_dict_structure_fn

    converter = cattrs.Converter(forbid_extra_keys=True)
    for kind, hook in {**_SIMPLE, **_hooks}.items():
        if kind in (float, int, str, bool):  # which cattrs would convert
            converter.register_structure_hook(kind, hook)
        else:
            converter.register_structure_hook_func(partial(eq, kind), hook)

    converter.register_structure_hook_func(lambda t: get_origin(t) is Literal, _word)

    def table(kind: Any) -> Hook:
        inner = make_dict_structure_fn(kind, converter, _cattrs_forbid_extra_keys=True)

        def read(value: Any, wanted: Any) -> Any:
            if not isinstance(value, Mapping):
                raise Unfit("a table", value)
            return inner(value, wanted)

        return read

    def is_table(kind: Any) -> bool:
        return dataclasses.is_dataclass(kind) and kind not in _hooks

    converter.register_structure_hook_factory(is_table, table)

    def tables(value: Any, kind: Any) -> Any:
        inner = get_args(kind)[1]
        if not isinstance(value, Mapping):
            raise Unfit("a table", value)
        return dict(_each(value, lambda item: converter.structure(item, inner)))

    converter.register_structure_hook_func(
        lambda t: get_origin(t) in (dict, Mapping) and get_args(t)[1] is not Any, tables
    )
    return converter


def _each(values: Mapping[str, Any], read: Callable[[Any], Any]) -> Any:
    for name, item in values.items():
        try:
            yield name, read(item)
        except Exception as trouble:
            raise _Within(name, trouble) from None


class _Within(ValueError):  # noqa: N818
    """Trouble with what stands under a name."""

    def __init__(self, name: str, trouble: Exception) -> None:
        super().__init__(name)
        self.name, self.trouble = name, trouble


def _sentence(trouble: BaseException, where: str, of: str) -> str:
    """The first thing that is wrong, by its key."""
    for note in getattr(trouble, "__notes__", ()):
        if hasattr(note, "name"):
            where = _joined(where, str(note.name))
    if isinstance(trouble, _Within):
        return _sentence(trouble.trouble, _joined(where, trouble.name), of)
    if isinstance(trouble, Unfit):
        return f"{where} must be {trouble.wanted}, and is {shown(trouble.value)}"
    if isinstance(trouble, Misplaced):
        return _joined(where, str(trouble))
    strange: Any = trouble
    if hasattr(strange, "extra_fields"):
        known = ", ".join(field.name for field in dataclasses.fields(strange.cl))
        key = _joined(where, sorted(strange.extra_fields)[0])
        return f"{key} is no key of {of}; here it takes {known}"
    if isinstance(trouble, KeyError):
        key = str(trouble.args[0])
        return f"{where if where.rpartition('.')[2] == key else _joined(where, key)} is missing"
    inner = getattr(trouble, "exceptions", None)
    if inner:
        return _sentence(_worst(inner), where, of)
    if isinstance(trouble, SomersaultError):
        said = str(trouble)
        return said if not where or where.rpartition(".")[2] in said else f"{where}: {said}"
    return f"{where} cannot be read ({trouble}); see what it takes"


def _worst(troubles: Sequence[BaseException]) -> BaseException:
    """A key that is none before the others: it may be why another is missing."""
    return next((t for t in troubles if hasattr(t, "extra_fields")), troubles[0])


def _joined(where: str, key: str) -> str:
    return f"{where}.{key}" if where else key
