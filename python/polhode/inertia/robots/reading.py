"""One description read, by its root element."""

from __future__ import annotations

import os

from ... import _files
from ..._core import InvalidInput
from ..._xml import parse, parse_bytes
from .formats import FORMATS, ROOTS
from .link import Robot
from .paths import Search


def read(path: str | os.PathLike[str], *, search: Search | None = None, data: bytes | None = None) -> Robot:
    """Read a robot description; its root element determines the format.

    Parameters
    ----------
    path : path
    search : Search, optional
        Where packages, models and meshes are.
    data : bytes, optional
        The text, if it is not that of the file.

    Returns
    -------
    Robot
        Its links. A link that cannot be read has its `trouble`.

    Raises
    ------
    InvalidInput
        For a file that cannot be read, is not XML, declares entities, or has no link that can be read.
    """
    file = _files.to_path(path, "path")
    root = parse(file) if data is None else parse_bytes(data, str(file))
    if (format := ROOTS.get(root.tag)) is None:
        roots = " or ".join(f"<{format.roots[0]}> ({name})" for name, format in FORMATS.items())
        raise InvalidInput(f"{file}: must have the root {roots}; got <{root.tag}>")
    robot = format.read(root, file, search or Search.of())
    troubles = [link.trouble for link in robot.links if link.trouble is not None]
    if troubles and len(troubles) == len(robot.links):
        raise troubles[0]
    return robot
