"""The contract of a format: what its module states besides its reader."""

from __future__ import annotations

import pathlib
from collections.abc import Callable
from typing import NamedTuple

from ..._xml import Node, Wrong
from .link import Robot
from .paths import Search


class Format(NamedTuple):
    """A format of robot descriptions.

    `read` returns the links of a file from its root element, and raises `NoRobot` if there are none. In folders, files
    with one of `suffixes` are found; the root decides where a suffix is not the format's own. `parts` are roots of
    files that others include: they are read if they are named, and left out in folders. `mass` and `centre` name the
    attributes that a repair replaces; where they are empty, it replaces the text of the element.
    """

    name: str
    roots: tuple[str, ...]
    suffixes: tuple[str, ...]
    read: Callable[[Node, pathlib.Path, Search], Robot]
    parts: tuple[str, ...] = ()
    mass: str = ""
    centre: str = ""


class NoRobot(Wrong):
    """A file that is none of a robot, without a fault."""

    def __init__(self, root: Node, text: str) -> None:
        super().__init__(f"{root.where}: {text}", root.line)
