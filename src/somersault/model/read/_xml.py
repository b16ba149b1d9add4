"""XML elements of a file, within bounds: the plain part of XML that robots are written in.

The parser is expat's, told to expand no entity and to open nothing. It is stricter than tinyxml2,
with which ROS and MuJoCo read: what that forgives (two hyphens in a comment, a bare ampersand, a
blank line before the declaration, a comment that is not UTF-8) is mended before a second try.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.parsers import expat

from somersault._core.errors import SomersaultError
from somersault._core.files import read_bytes

MOST_BYTES = 50 * 2**20
_MOST_ELEMENTS = 500_000
_DEEPEST = 100
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_COMMENT_BYTES = re.compile(rb"<!--.*?-->", re.DOTALL)
_BARE = re.compile(r"&(?!(?:amp|lt|gt|quot|apos|#\d{1,7}|#x[0-9a-fA-F]{1,6});)")
_DECLARED = re.compile(rb"\A\s*<\?xml[^>]{0,200}?encoding\s*=\s*[\"']([A-Za-z0-9_-]{1,40})[\"']")
_ENCODINGS = {"iso-8859-1", "latin-1", "latin1", "iso-8859-15", "windows-1252", "cp1252"}
_MARKS = {b"\xff\xfe": "utf-16-le", b"\xfe\xff": "utf-16-be", b"\xef\xbb": "utf-8"}


@dataclass(slots=True)
class Element:
    """One element: its tag and attributes as written, its children, the line it starts on, and
    the text before its first child."""

    tag: str
    attributes: dict[str, str]
    line: int
    children: list[Element] = field(default_factory=list)
    text: str = ""

    def all(self, tag: str) -> list[Element]:
        """The children of that tag, in order."""
        return [child for child in self.children if child.tag == tag]

    def first(self, tag: str) -> Element | None:
        """The first child of that tag, if there is one."""
        return next(iter(self.all(tag)), None)

    def below(self, *tags: str) -> list[Element]:
        """The children of the first child of the first tag, of that one's first child of the
        second tag, and so on; none where one is missing."""
        at: Element | None = self
        for tag in tags:
            at = None if at is None else at.first(tag)
        return [] if at is None else at.children

    def descendants(self) -> Iterator[Element]:
        """Every element below this one."""
        waiting = list(self.children)
        while waiting:
            element = waiting.pop()
            yield element
            waiting += element.children


def read_xml(path: Path, latin: bool = False) -> Element:
    """The root element of a file, with all that is in it.

    Parameters
    ----------
    path : Path
    latin : bool, optional
        Whether to take for Latin-1 what is not in the encoding that the file declares.

    Raises
    ------
    SomersaultError
        For a file that cannot be read, is too large or too deep, is not XML, or declares
        entities.
    """
    return parse_xml(path.name, _bytes(path), latin)[0]


def parse_xml(name: str, data: bytes, latin: bool = False) -> tuple[Element, str]:
    """The root element of what a file of some name holds, and its text; see `read_xml`."""
    text = _decoded(name, data, latin).lstrip("\ufeff \t\r\n\0")
    try:
        return _Tree(name).parse(text), text
    except expat.ExpatError:
        text = _BARE.sub("&amp;", _COMMENT.sub(_line_ends, text))
    try:
        return _Tree(name).parse(text), text
    except expat.ExpatError as error:
        reason = expat.errors.messages.get(error.code, "not well-formed")
        raise SomersaultError(
            f"{name}, line {error.lineno}: it is not XML there ({reason}); correct it"
        ) from None


def root_tag(path: Path) -> str:
    """The tag of a file's root element, or nothing where it has none that can be read."""
    text = _decoded(path.name, _bytes(path), latin=False)[: 2**20]
    tags = re.finditer(r"<([A-Za-z_][\w:.-]*)", _COMMENT.sub("", text))
    return next((tag.group(1) for tag in tags), "")


def _line_ends(match: re.Match[str]) -> str:
    return "\n" * match.group().count("\n")


def _bytes(path: Path) -> bytes:
    try:
        data = read_bytes(path, MOST_BYTES + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise SomersaultError(
            f"{path.name}: cannot be read ({reason.lower()}); check the path"
        ) from None
    if len(data) > MOST_BYTES:
        raise SomersaultError(
            f"{path.name} is larger than 50 MB, which no model is; check the file"
        )
    return data


def _decoded(name: str, data: bytes, latin: bool) -> str:
    declared = _DECLARED.match(data)
    encoding = declared.group(1).decode().lower() if declared else ""
    mark = _MARKS.get(data[:2], "")
    tries = [mark] if mark else ["utf-8", *({encoding} & _ENCODINGS), *(["latin-1"] * latin)]
    for attempt in tries:
        for content in (data, _COMMENT_BYTES.sub(lambda c: b"\n" * c.group().count(b"\n"), data)):
            try:
                return content.decode(attempt)
            except UnicodeDecodeError:
                continue
    raise SomersaultError(f"{name} has names that are not UTF-8; save it as UTF-8")


class _Tree:
    """Elements as expat comes to them, within bounds."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._root: Element | None = None
        self._open: list[Element] = []
        self._count = 0
        self._texts: list[str] = []
        self._parser: Any = expat.ParserCreate()
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.CharacterDataHandler = self._texts.append
        self._parser.EntityDeclHandler = self._entity
        self._parser.SetParamEntityParsing(expat.XML_PARAM_ENTITY_PARSING_NEVER)

    def parse(self, text: str) -> Element:
        try:
            self._parser.Parse(text, True)  # a str: what it declares as its encoding is past
        finally:
            self._parser.StartElementHandler = self._parser.EndElementHandler = None
            self._parser.CharacterDataHandler = None
            self._parser.EntityDeclHandler = None  # they and the parser would keep each other
        assert self._root is not None
        return self._root

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self._count += 1
        line = self._parser.CurrentLineNumber
        if self._count > _MOST_ELEMENTS or len(self._open) >= _DEEPEST:
            most = f"{_MOST_ELEMENTS} elements" if self._count > _MOST_ELEMENTS else "100 levels"
            raise SomersaultError(
                f"{self._name}, line {line}: more than {most}, which no model has; check the file"
            )
        self._flush()
        element = Element(tag, attributes, line)
        if self._open:
            self._open[-1].children.append(element)
        else:
            self._root = element
        self._open.append(element)

    def _end(self, tag: str) -> None:
        self._flush()
        self._open.pop()

    def _flush(self) -> None:
        """Give the innermost open element the text since its tag, unless a child came between."""
        if self._open and not self._open[-1].children:
            self._open[-1].text = "".join(self._texts)
        self._texts.clear()

    def _entity(self, name: str, *_: Any) -> None:
        raise SomersaultError(
            f"{self._name}, line {self._parser.CurrentLineNumber}: it declares the entity "
            f"{name[:40]!r}, which models do not need; write out what it stands for"
        )
