"""The properties of elements of a `.osim` file, with the defaults that the file sets for them."""

from __future__ import annotations

import math
from collections.abc import Sequence

from somersault._core.errors import SomersaultError
from somersault.model.read._xml import Element

_LARGEST = 1e15  # beyond any mass, length or inertia; keeps their products finite


class Words:
    """Reads properties. Those that an element leaves out are the ones of the element of its kind
    in the file's `defaults`, if there is one."""

    def __init__(self, file: str, model: Element) -> None:
        self.file = file
        defaults = model.first("defaults")
        self._defaults = {} if defaults is None else {e.tag: e for e in defaults.children}

    def child(self, element: Element, name: str) -> Element | None:
        """The element of a property, or None."""
        found = element.first(name)
        if found is None and element.tag in self._defaults:
            found = self._defaults[element.tag].first(name)
        return found

    def text(self, element: Element, name: str, default: str = "") -> str:
        """A property's text without white space around it."""
        found = self.child(element, name)
        return default if found is None else found.text.strip()

    def truth(self, element: Element, name: str) -> bool:
        """Whether a property is true; it is not if it is left out."""
        return self.text(element, name).lower() == "true"

    def number(self, element: Element, name: str, default: float | None = None) -> float:
        """A property that is one number; SomersaultError if it is left out and has no default."""
        return self.numbers(element, name, None if default is None else [default], 1)[0]

    def numbers(
        self, element: Element, name: str, default: Sequence[float] | None = None, count: int = 0
    ) -> list[float]:
        """A property that is a row of numbers, so many of them if a count is given."""
        found = self.child(element, name)
        if found is None:
            if default is None:
                raise self.error(f"has no {name}; give it one", element)
            return list(default)
        try:
            values = [float(word) for word in found.text.split()]
        except ValueError:
            values = [math.nan]
        if (count and len(values) != count) or not all(abs(v) <= _LARGEST for v in values):
            wanted = f"{count} finite numbers" if count > 1 else "a finite number"
            wanted = wanted if count else "finite numbers"
            shown = " ".join(found.text.split())[:60]
            named = self._named(element)
            raise self.error(f"of {named} is {shown!r}, which is not {wanted}; correct it", found)
        return values

    def error(self, what: str, element: Element | None) -> SomersaultError:
        """The error to raise for `what` of an element."""
        if element is None:  # a joint that no file has
            return SomersaultError(f"{self.file}: a joint {what}")
        return SomersaultError(f"{self.file}, line {element.line}: {self._named(element)} {what}")

    @staticmethod
    def _named(element: Element) -> str:
        name = element.attributes.get("name", "")[:60]
        return f"{element.tag} {name!r}" if name else element.tag
