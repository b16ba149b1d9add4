"""Changes of XML that know elements and attributes."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable

import numpy as np

from .mutations import NAMES, NUMBERS, pick

Way = Callable[[ET.Element, np.random.Generator], None]
_DEPTHS = (2, 3, 50, 98, 150)
_DEEPEST = 500  # levels that ElementTree, which recurses, can still write


def _elements(root: ET.Element) -> list[ET.Element]:
    return list(root.iter())


def _levels(root: ET.Element) -> int:
    levels, row = 0, [root]
    while row:
        levels, row = levels + 1, [child for element in row for child in element]
    return levels


def _with_parent(
    root: ET.Element, rng: np.random.Generator
) -> tuple[ET.Element, ET.Element] | None:
    pairs = [(parent, child) for parent in root.iter() for child in parent]
    return pick(rng, pairs) if pairs else None


def _attribute(root: ET.Element, rng: np.random.Generator) -> tuple[ET.Element, str] | None:
    places = [(element, name) for element in root.iter() for name in element.attrib]
    return pick(rng, places) if places else None


def value(root: ET.Element, rng: np.random.Generator) -> None:
    """An attribute, or a text, that is a hostile number, a hostile name or another's."""
    said = [v for e in root.iter() for v in e.attrib.values()]
    said += [e.text for e in root.iter() if e.text and e.text.strip()]
    place = _attribute(root, rng)
    texts = [e for e in root.iter() if e.text and e.text.strip()]
    new = pick(rng, (NUMBERS, NAMES, said or NAMES, said or NAMES))
    if texts and (place is None or rng.uniform() < 0.6):
        pick(rng, texts).text = _in_row(pick(rng, texts).text or "", pick(rng, new), rng)
    elif place is not None:
        element, name = place
        element.attrib[name] = _in_row(element.attrib[name], pick(rng, new), rng)


def _in_row(old: str, new: str, rng: np.random.Generator) -> str:
    """A new value in the place of one of several words, or of all of them."""
    words = old.split()
    if len(words) < 2 or rng.uniform() < 0.3:
        return new
    words[int(rng.integers(len(words)))] = new
    return " ".join(words)


def turned(root: ET.Element, rng: np.random.Generator) -> None:
    """Words of an attribute the other way round, a sign changed, or a word more or less."""
    place = _attribute(root, rng)
    if place is None:
        return
    element, name = place
    words = element.attrib[name].split()
    ways = ([*reversed(words)], [f"-{w}" for w in words], words[1:], words * 2, ["-1", *words])
    element.attrib[name] = " ".join(pick(rng, ways))


def attribute_dropped(root: ET.Element, rng: np.random.Generator) -> None:
    """An element without one of its attributes."""
    place = _attribute(root, rng)
    if place is not None:
        del place[0].attrib[place[1]]


def attribute_moved(root: ET.Element, rng: np.random.Generator) -> None:
    """An attribute under another's name, or at another element."""
    place = _attribute(root, rng)
    if place is not None:
        element, name = place
        names = [name for e in root.iter() for name in e.attrib]
        pick(rng, (element, pick(rng, _elements(root)))).attrib[pick(rng, names)] = element.attrib[
            name
        ]


def element_dropped(root: ET.Element, rng: np.random.Generator) -> None:
    """A tree without one of its elements."""
    pair = _with_parent(root, rng)
    if pair is not None:
        pair[0].remove(pair[1])


def element_copied(root: ET.Element, rng: np.random.Generator) -> None:
    """An element twice or often, in its place or another."""
    pair = _with_parent(root, rng)
    if pair is None:
        return
    into = pick(rng, (pair[0], pair[0], pick(rng, _elements(root))))
    text = ET.tostring(pair[1], encoding="unicode")
    for _ in range(int(pick(rng, (1, 1, 1, 2, 300)))):
        into.insert(int(rng.integers(len(into) + 1)), ET.fromstring(text))


def element_moved(root: ET.Element, rng: np.random.Generator) -> None:
    """An element in another place, which is not within it."""
    pair = _with_parent(root, rng)
    if pair is None:
        return
    parent, child = pair
    outside = [e for e in root.iter() if e not in set(child.iter())]
    parent.remove(child)
    pick(rng, outside).append(child)


def element_named(root: ET.Element, rng: np.random.Generator) -> None:
    """An element with another's tag."""
    tags = [e.tag for e in root.iter()]
    pick(rng, _elements(root)).tag = pick(rng, [*tags, "x", "include", "replicate", "frame"])


def element_deep(root: ET.Element, rng: np.random.Generator) -> None:
    """An element in itself, many times."""
    at = pick(rng, _elements(root))
    for _ in range(int(pick(rng, _DEPTHS))):
        at = ET.SubElement(at, at.tag, {**at.attrib, "name": f"deep{rng.integers(10**9)}"})


def included(root: ET.Element, rng: np.random.Generator) -> None:
    """Another file, which is itself, a device, a pipe or nothing."""
    files = (
        "main.xml",
        "beside.xml",
        "pipe",
        "/dev/zero",
        "/dev/stdin",
        ".",
        "none.xml",
        "",
        "x\0",
    )
    new = ET.SubElement(pick(rng, (root, pick(rng, _elements(root)))), "include")
    new.attrib["file"] = pick(rng, files)


WAYS: tuple[Way, ...] = (
    value, value, value, value, turned, turned, attribute_dropped, attribute_moved, element_dropped,
    element_copied, element_copied, element_moved, element_named, element_deep, included,
)  # fmt: skip


def changed(text: str, rng: np.random.Generator) -> str:
    """A tree changed in one way; the text as it is where it is no tree any more."""
    try:
        root = ET.fromstring(text)
    except (ET.ParseError, ValueError):
        return text
    if _levels(root) > _DEEPEST:
        return text
    pick(rng, WAYS)(root, rng)
    if _levels(root) > _DEEPEST:
        return text
    return ET.tostring(root, encoding="unicode")


def deep(text: str, rng: np.random.Generator) -> str:
    """One of its elements ten thousand times in itself, deeper than any tree can be built."""
    at = [
        place
        for place in range(len(text))
        if text[place] == "<" and text[place + 1 : place + 2].isalpha()
    ]
    if not at:
        return text
    place = pick(rng, at)
    tag = text[place + 1 :].split(maxsplit=1)[0].strip("/>").split(">")[0]
    return text[:place] + f"<{tag}>" * 10_000 + f"</{tag}>" * 10_000 + text[place:]
