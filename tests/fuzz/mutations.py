"""Changes of a text or of bytes that know nothing of its format but words, lines and numbers."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np

Change = Callable[[str, np.random.Generator], str]
T = TypeVar("T")

NUMBERS = (
    "nan",
    "NaN",
    "inf",
    "-inf",
    "1e308",
    "-1e308",
    "1e400",
    "1e-320",
    "-0",
    "0",
    "-1",
    "1e10",
    "1e-10",
    "1e5",
    "-0.5",
    "9" * 5000,
    "0." + "0" * 5000 + "1",
    "",
    "x",
    "0x10",
    "1_0",
    "1,5",
    "1e",
    "--1",
    "1e999999999",
    "٣",
    "1 2",
    "1;2",
    "2147483648",
    "4294967296",
    "9223372036854775808",
    "true",
)
NAMES = (
    "",
    " ",
    "a b",
    "<b>x</b>",
    "a\nb",
    "🤸",
    "a\0b",
    "x" * 100_000,
    "../../../etc/passwd",
    "/dev/zero",
    ".",
    "nan",
    "%s%n",
    "{0}",
    "'",
    '"',
    "$(id)",
    "\u202e",
    "é",
    "world",
    "ground",
    "time",
    "shoulder",
    "left_shoulder",
    "__class__",
    "-",
    "[",
    "]",
    "#",
    "//",
    "\\",
    "&amp;",
    "&lol;",
)
LITERALS = (
    "[]",
    "{}",
    "[[]]",
    "[1, [2, 3]]",
    '"x"',
    "true",
    "null",
    "1979-05-27",
    "07:32:00",
    "nan",
    "-inf",
    "{a = 1}",
    '{"a": 1}',
    "[" * 1000 + "]" * 1000,
    "[" * 100_000,
    '["a", "b"]',
    "[nan, inf]",
    "0x7f",
    "1e308",
    "[1e308, -1e308]",
    "9" * 5000,
    "-1",
    "0",
    "2.5",
    "''",
    '"""',
    "[0.0, 0.0, 0.0, 0.0]",
)
_NUMBER = re.compile(r"(?<![\w.])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_WORD = re.compile(r"[^\s\"'<>=,;\[\]{}()]+")
_LITERAL = re.compile(r"(?<=[=:])[^=:\n#]+")


def pick(rng: np.random.Generator, things: Sequence[T]) -> T:
    """One of some things, which need not fit in an array."""
    return things[int(rng.integers(len(things)))]


def _one(
    text: str, rng: np.random.Generator, pattern: re.Pattern[str], new: Callable[[str], str]
) -> str:
    """The text with one of the pattern's places changed."""
    places = list(pattern.finditer(text))
    if not places:
        return text
    place = pick(rng, places)
    return text[: place.start()] + new(place.group()) + text[place.end() :]


# ------------------------------------------------------------------- numbers and words


def hostile_number(text: str, rng: np.random.Generator) -> str:
    """A number that is none, too large, too small or too long."""
    return _one(text, rng, _NUMBER, lambda _: pick(rng, NUMBERS))


def all_numbers(text: str, rng: np.random.Generator) -> str:
    """One hostile number in many places."""
    new, share = pick(rng, NUMBERS), rng.uniform(0.05, 1.0)
    return _NUMBER.sub(lambda place: new if rng.uniform() < share else place.group(), text)


def scaled_number(text: str, rng: np.random.Generator) -> str:
    """A number many powers of ten away, or of the other sign."""
    factor = float(rng.choice([-1.0, 1.0]) * 10.0 ** rng.integers(-12, 13))
    return _one(text, rng, _NUMBER, lambda old: repr(float(old) * factor))


def nudged(text: str, rng: np.random.Generator) -> str:
    """Some numbers a little different, or zero: mostly still read, and then to be sound."""
    share, spread = rng.uniform(0.02, 0.3), float(pick(rng, (0.01, 0.3, 2.0)))

    def new(place: re.Match[str]) -> str:
        if rng.uniform() > share:
            return place.group()
        return pick(
            rng,
            (
                f"{float(place.group()) * np.exp(rng.normal() * spread):.6g}",
                "0",
                "-" + place.group(),
            ),
        )

    return _NUMBER.sub(new, text)


def word_for_word(text: str, rng: np.random.Generator) -> str:
    """A word in the place of another: references to themselves, to others, to nothing."""
    words = _WORD.findall(text)
    return _one(text, rng, _WORD, lambda _: pick(rng, words)) if words else text


def hostile_name(text: str, rng: np.random.Generator) -> str:
    """A word that is no name."""
    return _one(text, rng, _WORD, lambda _: pick(rng, NAMES))


def renamed(text: str, rng: np.random.Generator) -> str:
    """A word slightly misspelt."""

    def misspelt(word: str) -> str:
        at = int(rng.integers(len(word)))
        return pick(
            rng, (word[:at] + word[at + 1 :], word.upper(), word + "_", word[:at] + "q" + word[at:])
        )

    return _one(text, rng, _WORD, misspelt)


def literal(text: str, rng: np.random.Generator) -> str:
    """A value of another kind, as TOML or JSON writes it."""
    return _one(text, rng, _LITERAL, lambda _: " " + pick(rng, LITERALS))


# ------------------------------------------------------------------------------ lines


def _on_lines(text: str, change: Callable[[list[str]], list[str]]) -> str:
    return "\n".join(change(text.split("\n")))


def line_dropped(text: str, rng: np.random.Generator) -> str:
    """A text without one of its lines."""
    at = int(rng.integers(text.count("\n") + 1))
    return _on_lines(text, lambda lines: lines[:at] + lines[at + 1 :])


def line_doubled(text: str, rng: np.random.Generator) -> str:
    """A line many times over, or twice."""
    at, times = int(rng.integers(text.count("\n") + 1)), int(pick(rng, (2, 2, 2, 3, 5000)))
    return _on_lines(text, lambda lines: lines[:at] + lines[at : at + 1] * times + lines[at + 1 :])


def lines_moved(text: str, rng: np.random.Generator) -> str:
    """Some lines in another place."""
    first, last, to = np.sort(rng.integers(0, text.count("\n") + 2, 3)).tolist()
    return _on_lines(
        text, lambda lines: lines[:first] + lines[last:to] + lines[first:last] + lines[to:]
    )


def words_turned(text: str, rng: np.random.Generator) -> str:
    """The words of a line the other way round, which puts limits the wrong way round."""

    def change(lines: list[str]) -> list[str]:
        at = int(rng.integers(len(lines)))
        lines[at] = " ".join(reversed(lines[at].split()))
        return lines

    return _on_lines(text, change)


def word_dropped(text: str, rng: np.random.Generator) -> str:
    """A text without one of its words."""
    return _one(text, rng, _WORD, lambda _: "")


def word_doubled(text: str, rng: np.random.Generator) -> str:
    """A word twice."""
    return _one(text, rng, _WORD, lambda word: f"{word} {word}")


# ------------------------------------------------------------------------------ bytes


def bits_flipped(data: bytes, rng: np.random.Generator) -> bytes:
    """Some bits the other way."""
    if not data:
        return data
    changed = bytearray(data)
    for at in rng.integers(0, len(data), int(rng.integers(1, 9))):
        changed[at] ^= 1 << int(rng.integers(8))
    return bytes(changed)


def bytes_random(data: bytes, rng: np.random.Generator) -> bytes:
    """A run of bytes that are anything."""
    at = int(rng.integers(len(data) + 1))
    count = int(rng.integers(1, 33))
    return data[:at] + rng.bytes(count) + data[at + count * int(rng.integers(2)) :]


def cut_off(data: bytes, rng: np.random.Generator) -> bytes:
    """The beginning alone."""
    return data[: int(rng.integers(len(data) + 1))]


def cut_out(data: bytes, rng: np.random.Generator) -> bytes:
    """All but a run of bytes."""
    first, last = np.sort(rng.integers(0, len(data) + 1, 2)).tolist()
    return data[:first] + data[last:]


def repeated(data: bytes, rng: np.random.Generator) -> bytes:
    """A run of bytes many times."""
    first = int(rng.integers(len(data) + 1))
    last = min(len(data), first + int(rng.integers(1, 200)))
    return data[:last] + data[first:last] * int(pick(rng, (1, 2, 50, 10_000))) + data[last:]


def zero_bytes(data: bytes, rng: np.random.Generator) -> bytes:
    """Zero bytes in a place, or behind everything."""
    at = int(pick(rng, (0, len(data), int(rng.integers(len(data) + 1)))))
    return data[:at] + b"\0" * int(rng.integers(1, 600)) + data[at:]


def encoded(data: bytes, rng: np.random.Generator) -> bytes:
    """The same text in another encoding, with or without a mark, or with other line ends."""
    text = data.decode("utf-8", "replace")
    ways: tuple[Callable[[], bytes], ...] = (
        lambda: text.encode("utf-16"),
        lambda: text.encode("utf-16-le"),
        lambda: text.encode("utf-16-be"),
        lambda: text.encode("utf-32"),
        lambda: text.encode("utf-8-sig"),
        lambda: "\ufeff".encode() * 2 + data,
        lambda: text.replace("a", "ä").encode("latin-1", "replace"),
        lambda: text.replace("e", "é").encode(),
        lambda: data.replace(b"\n", b"\r\n"),
        lambda: data.replace(b"\n", b"\r"),
        lambda: data.replace(b"\n", b" "),
        lambda: data.replace(b" ", b"\t"),
        lambda: data.replace(b" ", b"\xc2\xa0"),
        lambda: b"\x1f\x8b" + data,
        lambda: b"",
    )
    return pick(rng, ways)()


TEXT: tuple[Change, ...] = (
    nudged,
    hostile_number,
    nudged,
    hostile_number,
    nudged,
    all_numbers,
    scaled_number,
    scaled_number,
    word_for_word,
    word_for_word,
    hostile_name,
    renamed,
    line_dropped,
    line_doubled,
    lines_moved,
    words_turned,
    word_dropped,
    word_doubled,
)
BYTES = (bits_flipped, bytes_random, cut_off, cut_out, repeated, zero_bytes, encoded)


def spliced(one: bytes, other: bytes, rng: np.random.Generator) -> bytes:
    """The beginning of one and the end of another."""
    return cut_off(one, rng) + other[int(rng.integers(len(other) + 1)) :]
