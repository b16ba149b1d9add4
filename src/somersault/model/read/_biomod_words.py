"""The words and numbers of a `.bioMod` text.

The format is a stream of words separated by white space; line ends mean nothing, except that
a comment `//` ends there. A number may be written as arithmetic over numbers, `pi` and `$names`
(biorbd, src/Utils/Equation.cpp). Biorbd adds before it subtracts, so that it takes
1-2+3 for minus four; here arithmetic has its usual order.
"""

from __future__ import annotations

import math
import re
from pathlib import Path

from somersault._core.errors import SomersaultError
from somersault._core.files import read_bytes
from somersault.model._strange import Strange

LARGEST_FILE = 50_000_000  # bytes; the largest athlete models are some 10 MB, all mesh points
_LARGEST_NUMBER = 1e15  # beyond any mass, length or inertia; keeps their products finite
_LONGEST = 1000  # characters of one number
_DEEPEST = 50  # brackets within brackets

_WORD = re.compile(r"(?<!\S)//[^\n]*|(?<!\S)/\*.*?\*/|\S+", re.DOTALL)
_PART = re.compile(r"([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?|[pP][iI]|\$\w+|[-+*/()]")
_NAME = re.compile(r"\$\w+")


def read_text(path: Path) -> str:
    """The text of the file; SomersaultError if it cannot be one."""
    try:
        data = read_bytes(path, LARGEST_FILE + 1)
    except (OSError, ValueError) as error:  # ValueError: a null character in the path
        reason = getattr(error, "strerror", None) or str(error)
        raise SomersaultError(
            f"{path.name}: cannot be read ({reason.lower()}); check the path"
        ) from None
    if len(data) > LARGEST_FILE:
        raise SomersaultError(
            f"{path.name}: is larger than {LARGEST_FILE // 1_000_000} MB; move its meshes into "
            "mesh files"
        )
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise SomersaultError(
            f"{path.name}, line {line}: is not UTF-8 text; save the file as UTF-8"
        ) from None


class Words:
    """The words of a file one after another, with the line on which each stands."""

    def __init__(self, file: str, text: str) -> None:
        self.file = file
        self.strange = Strange()
        self.line = 1
        self.starts_line = True
        self.variables: dict[str, float] = {}
        self._text = text
        self._matches = _WORD.finditer(text)
        self._at = 0

    def next(self) -> str | None:
        """The next word that is not a comment, or None at the end of the file."""
        self.starts_line = self._at == 0
        for match in self._matches:
            lines = self._text.count("\n", self._at, match.start())
            self.line += lines
            self._at = match.start()
            self.starts_line = self.starts_line or lines > 0
            word = match.group()
            if word.startswith("/*") and not (len(word) > 3 and word.endswith("*/")):
                raise self.error("the comment /* never ends; close it with */")
            if not word.startswith(("//", "/*")):
                return word
        return None

    def word(self, what: str) -> str:
        """The next word; SomersaultError if the file ends before `what`."""
        word = self.next()
        if word is None:
            raise self.error(f"the file ends where {what} is expected; complete the file")
        return word

    def number(self, what: str) -> float:
        """The next word as a number, its arithmetic done."""
        return self.value(self.word(what), what)

    def value(self, word: str, what: str) -> float:
        """A word as a number, its arithmetic done."""
        try:
            reckoned = _Sum(word, self.variables)
            value = reckoned.value()
        except KeyError as error:
            raise self.error(
                f"{shown(error.args[0])} is not a variable defined above; define it in a variables "
                "block"
            ) from None
        except (ValueError, ZeroDivisionError):
            raise self.error(
                f"{shown(word)} is not a number, which {what} must be; correct it"
            ) from None
        if not math.isfinite(value) or abs(value) > _LARGEST_NUMBER:
            raise self.error(f"{shown(word)} is too large for {what}; give a finite number")
        if reckoned.dropped:
            self.strange.add(
                "numbers with pi right behind them, which biorbd drops, as we do; write 3*pi",
                self.at(word[:40]),
            )
        return value

    def numbers(self, count: int, what: str) -> list[float]:
        """The next `count` words as numbers."""
        return [self.number(f"number {n + 1} of the {count} of {what}") for n in range(count)]

    def variable(self, name: str) -> None:
        """Read the value of the variable `name` ($ included) and keep it."""
        if not _NAME.fullmatch(name):
            raise self.error(
                f"{shown(name)} is not a variable's name; use $ and letters, digits and _"
            )
        if name in self.variables:
            raise self.error(f"the variable {shown(name)} is defined twice; remove one of them")
        self.variables[name] = self.number(f"the variable {shown(name)}")

    def at(self, what: str) -> str:
        """Something of the file and the line on which it stands."""
        return f"{what} (line {self.line})"

    def error(self, what: str, line: int | None = None) -> SomersaultError:
        """The error to raise for `what`, on the line of the last word unless another is given."""
        return SomersaultError(f"{self.file}, line {line or self.line}: {what}")


def shown(word: str) -> str:
    """A word of the file as it can stand in a message."""
    return repr(word if len(word) <= 40 else word[:39] + "…")


class _Sum:
    """Recursive descent over one word of arithmetic; ValueError where it is none."""

    def __init__(self, word: str, variables: dict[str, float]) -> None:
        if len(word) > _LONGEST or word.count("(") > _DEEPEST:
            raise ValueError("not written by a person")
        self._parts = [match.group() for match in _PART.finditer(word)]
        if sum(map(len, self._parts)) != len(word):
            raise ValueError("something between the parts")
        self._parts.reverse()
        self._variables = variables
        self.dropped = False  # a pi that follows a number, as biorbd drops it

    def value(self) -> float:
        value = self._sum()
        if self._parts:
            raise ValueError(self._parts[-1])
        return value

    def _take(self, choices: str) -> str:
        """The next part if it is one of `choices`, else nothing."""
        if self._parts and self._parts[-1] in choices:
            return self._parts.pop()
        return ""

    def _sum(self) -> float:
        value = self._product()
        while sign := self._take("+-"):
            value = value + self._product() if sign == "+" else value - self._product()
        return value

    def _product(self) -> float:
        value = self._signed()
        while sign := self._take("*/"):
            value = value * self._signed() if sign == "*" else value / self._signed()
        return value

    def _signed(self) -> float:
        sign = 1.0
        while taken := self._take("+-"):
            sign = -sign if taken == "-" else sign
        return sign * self._atom()

    def _atom(self) -> float:
        if self._take("("):
            value = self._sum()
            if not self._take(")"):
                raise ValueError("unclosed bracket")
            return value
        if not self._parts:
            raise ValueError("nothing")
        part = self._parts.pop()
        if part.startswith("$"):
            return self._variables[part]
        if part.lower() == "pi":
            return math.pi
        if self._parts and self._parts[-1].lower() == "pi":
            self._parts.pop()
            self.dropped = True
        return float(part)
