"""XML by a parser that follows no entities, and the numbers in it."""

from __future__ import annotations

import pathlib
from collections.abc import Iterator
from xml.etree.ElementTree import Element, ParseError

import numpy as np
import numpy.typing as npt

from ... import _files
from ..._core import InvalidInput

Array = npt.NDArray[np.float64]

LARGEST = 1e30         # number; squares and volumes of it are finite
DEEPEST = 1000


class Node:
    """An element that knows where it stands, for what is said about it."""

    def __init__(self, element: Element, where: str) -> None:
        self.element, self.where, self.tag = element, where, element.tag

    def wrong(self, text: str) -> InvalidInput:
        return InvalidInput(f"{self.where}: {text}")

    def child(self, tag: str) -> Node | None:
        found = self.element.find(tag)
        return None if found is None else Node(found, f"{self.where} <{tag}>")

    def need(self, tag: str) -> Node:
        if (found := self.child(tag)) is None:
            raise self.wrong(f"<{tag}> is missing")
        return found

    def children(self, tag: str | None = None) -> Iterator[Node]:
        for element in self.element:
            if isinstance(element.tag, str) and (tag is None or element.tag == tag):
                name = element.get("name")
                yield Node(element, f"{self.where} <{element.tag}{f' {name!r}' if name else ''}>")

    def get(self, name: str) -> str | None:
        return self.element.get(name)

    @property
    def text(self) -> str:
        return (self.element.text or "").strip()

    def word(self, name: str) -> str:
        if (value := self.element.get(name)) is None:
            raise self.wrong(f"{name} is missing")
        return value

    def numbers(self, name: str, count: int | None, default: str | None = None, finite: bool = True) -> Array:
        """The numbers of an attribute; `count` None: any number of them."""
        value = self.word(name) if default is None else self.element.get(name, default)
        return to_numbers(value, count, f"{self.where}: {name}", finite)

    def content(self, count: int, finite: bool = True) -> Array:
        """The numbers between the tags."""
        return to_numbers(self.text, count, self.where, finite)

    def number(self, name: str, finite: bool = True) -> float:
        return float(self.numbers(name, 1, finite=finite)[0])


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
    try:
        from defusedxml import DefusedXmlException  # type: ignore[import-untyped, unused-ignore]
        from defusedxml.ElementTree import fromstring  # type: ignore[import-untyped, unused-ignore]
    except ImportError:
        raise InvalidInput("robot files need defusedxml: pip install 'polhode[cli]'") from None
    data = _files.read(file, _files.TEXT)
    try:
        root = fromstring(data, forbid_dtd=True)
    except DefusedXmlException:
        raise InvalidInput(f"{file}: declares a document type or entities, which can blow up: refused") from None
    except ParseError as error:
        raise InvalidInput(f"{file}: is no XML: {error}") from None
    except (ValueError, LookupError) as error:   # an encoding that is none
        raise InvalidInput(f"{file}: is no XML: {error}") from None
    _check_depth(root, file)
    return Node(root, str(file))


def _check_depth(root: Element, file: pathlib.Path) -> None:
    level, depth = [root], 0
    while level:
        level, depth = [child for element in level for child in element], depth + 1
        if depth > DEEPEST:
            raise InvalidInput(f"{file}: elements are nested more than {DEEPEST} deep")
