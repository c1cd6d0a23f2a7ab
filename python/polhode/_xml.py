"""XML as the parsers of robots take it, without entities, and the numbers in it with their places in the file."""

from __future__ import annotations

import pathlib
import re
from collections.abc import Iterator
from xml.parsers import expat

import numpy as np
import numpy.typing as npt

from . import _files
from ._core import InvalidInput

Array = npt.NDArray[np.float64]

LARGEST = 1e30         # number; squares and volumes of it are finite
DEEPEST = 1000


class Node:
    """An element that knows where it stands: `line` from 1, and `start`, the byte of its `<`."""

    __slots__ = ("_parts", "attrib", "file", "line", "nodes", "parent", "start", "tag")

    def __init__(self, tag: str, attrib: dict[str, str], parent: Node | None, file: str, line: int, start: int) -> None:
        self.tag, self.attrib, self.parent, self.file = tag, attrib, parent, file
        self.line, self.start = line, start
        self.nodes: list[Node] = []
        self._parts: list[str] = []

    @property
    def where(self) -> str:
        if self.parent is None:
            return self.file
        name = self.attrib.get("name")
        return f"{self.parent.where} <{self.tag}{f' {name!r}' if name else ''}>"

    @property
    def text(self) -> str:
        return "".join(self._parts).strip()

    def wrong(self, text: str) -> Wrong:
        return Wrong(f"{self.where}: {text}", self.line)

    def child(self, tag: str) -> Node | None:
        return next((node for node in self.nodes if node.tag == tag), None)

    def need(self, tag: str) -> Node:
        if (found := self.child(tag)) is None:
            raise self.wrong(f"<{tag}> is missing")
        return found

    def children(self, tag: str | None = None) -> Iterator[Node]:
        return (node for node in self.nodes if tag is None or node.tag == tag)

    def walk(self) -> Iterator[Node]:
        left = [self]
        while left:
            node = left.pop()
            yield node
            left += node.nodes[::-1]

    def get(self, name: str) -> str | None:
        return self.attrib.get(name)

    def word(self, name: str) -> str:
        if (value := self.attrib.get(name)) is None:
            raise self.wrong(f"{name} is missing")
        return value

    def numbers(self, name: str, count: int | None, default: str | None = None, finite: bool = True) -> Array:
        """The numbers of an attribute; `count` None: any number of them."""
        value = self.word(name) if default is None else self.attrib.get(name, default)
        return self.convert(value, count, name, finite)

    def content(self, count: int, finite: bool = True) -> Array:
        """The numbers between the tags."""
        return self.convert(self.text, count, "", finite)

    def number(self, name: str, finite: bool = True) -> float:
        return float(self.numbers(name, 1, finite=finite)[0])

    def convert(self, text: str, count: int | None, name: str, finite: bool = True) -> Array:
        try:
            return to_numbers(text, count, f"{self.where}{': ' + name if name else ''}", finite)
        except InvalidInput as error:
            raise Wrong(str(error), self.line) from None

    def copy(self, parent: Node | None = None) -> Node:
        """The element with all that it holds, to be changed freely."""
        made = Node(self.tag, dict(self.attrib), parent or self.parent, self.file, self.line, self.start)
        made._parts = self._parts
        made.nodes = [node.copy(made) for node in self.nodes]
        return made


class Wrong(InvalidInput):
    """An error with the line of the file at which it stands."""

    def __init__(self, text: str, line: int | None = None) -> None:
        super().__init__(text)
        self.line = line


def to_numbers(text: str, count: int | None, where: str, finite: bool = True) -> Array:
    """Read numbers with blanks between them."""
    try:
        values = [float(word) for word in text.split()]
    except ValueError:
        raise InvalidInput(f"{where}: must be numbers, got {_short(text)}") from None
    if count is not None and len(values) != count:
        raise InvalidInput(f"{where}: must be {count} number{'s' if count > 1 else ''}, got {_short(text)}")
    if finite and not all(abs(value) < LARGEST for value in values):   # NaN is not
        raise InvalidInput(f"{where}: must be finite and below {LARGEST:g}, got {_short(text)}")
    return np.array(values, dtype=float)


def _short(text: str) -> str:
    return repr(text if len(text) <= 60 else text[:57] + "...")


def parse(file: pathlib.Path) -> Node:
    """Read a file's root element."""
    return parse_bytes(_files.read(file, _files.TEXT), str(file))


def parse_bytes(data: bytes, name: str) -> Node:
    """Read the root element of a text.

    The parsers of ROS and Gazebo take more than XML allows: a prefix that is not declared, text before the declaration,
    two hyphens in a comment, several roots. So does this one. Document types and entities are refused.
    """
    builder = _Builder(name)
    data, encoding = _without_declaration(data)
    error = builder.feed(data, encoding)
    if builder.done:
        error = None   # the first root counts, not what follows it
    if error is not None and b"<!--" in data:
        again = _Builder(name)   # a comment may hold what XML forbids there
        error, builder = again.feed(_COMMENT.sub(_blank, data), encoding), again
        if builder.done:
            error = None
    if error is not None or builder.root is None:
        raise Wrong(f"{name}: is no XML: {error or 'it has no element'}", getattr(error, "lineno", None))
    return builder.root


_COMMENT = re.compile(rb"<!--.*?-->", re.S)
_BLANKS = re.compile(rb"\s*")
_LEADING = re.compile(rb"[^<\0\xef]+(?=<)")
_DECLARATION = re.compile(rb"<\?xml\b[^>]*?\?>")


def _blank(found: re.Match[bytes]) -> bytes:
    return re.sub(rb"[^\n]", b" ", found[0])


def _without_declaration(data: bytes) -> tuple[bytes, str | None]:
    """Blank the XML declaration, wherever it stands before the root, so that bytes and lines keep their numbers."""
    if data[:2] not in (b"\xff\xfe", b"\xfe\xff") and (found := _LEADING.match(data)) is not None:
        data = _blank(found) + data[found.end():]   # text before the first element
    found = _DECLARATION.match(data, _after_comments(data))
    if found is None:
        return data, None
    encoding = re.search(rb"encoding\s*=\s*[\"']([A-Za-z0-9._-]+)[\"']", found[0])
    blanked = data[:found.start()] + _blank(found) + data[found.end():]
    return blanked, encoding[1].decode() if encoding else None


def _after_comments(data: bytes) -> int:
    """The place behind a byte order mark, blanks and comments at the beginning."""
    place = 3 if data.startswith(b"\xef\xbb\xbf") else 0
    while True:
        found = _BLANKS.match(data, place)
        place = found.end() if found else place
        end = data.find(b"-->", place) if data.startswith(b"<!--", place) else -1
        if end < 0:
            return place
        place = end + 3


class _Builder:
    """Builds the tree, and refuses what can blow up."""

    def __init__(self, name: str) -> None:
        self.name, self.done = name, False
        self.root: Node | None = None
        self._open: list[Node] = []

    def feed(self, data: bytes, encoding: str | None) -> expat.ExpatError | None:
        try:
            parser = expat.ParserCreate(encoding)   # without namespaces: a prefix is part of the name
        except (ValueError, LookupError) as error:
            raise Wrong(f"{self.name}: is no XML: {error}") from None
        parser.buffer_text = True
        parser.StartElementHandler, parser.EndElementHandler = self._begin, self._end
        parser.CharacterDataHandler = self._text
        for handler in ("StartDoctypeDecl", "EntityDecl", "ExternalEntityRef", "UnparsedEntityDecl"):
            setattr(parser, f"{handler}Handler", self._refuse)
        self._parser = parser
        try:
            parser.Parse(data, True)
        except expat.ExpatError as error:
            return error
        except (ValueError, LookupError) as error:   # an encoding that is none
            if isinstance(error, InvalidInput):
                raise
            raise Wrong(f"{self.name}: is no XML: {error}") from None
        return None

    def _begin(self, tag: str, attrib: dict[str, str]) -> None:
        if len(self._open) >= DEEPEST:
            raise Wrong(f"{self.name}: elements are nested more than {DEEPEST} deep", self._parser.CurrentLineNumber)
        parent = self._open[-1] if self._open else None
        node = Node(tag, attrib, parent, self.name, self._parser.CurrentLineNumber, self._parser.CurrentByteIndex)
        if parent is None:
            self.root = node
        else:
            parent.nodes.append(node)
        self._open.append(node)

    def _end(self, tag: str) -> None:
        self._open.pop()
        self.done = not self._open

    def _text(self, text: str) -> None:
        if self._open and not self._open[-1].nodes:
            self._open[-1]._parts.append(text)

    def _refuse(self, *declared: object) -> None:
        raise Wrong(f"{self.name}: declares a document type or entities, which can blow up: refused",
                    self._parser.CurrentLineNumber)
