"""Robot descriptions: checks of the links of URDF, MJCF and SDF files, alone and against their geometry."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Callable

from ... import _files
from ..._core import InvalidInput
from . import mjcf, sdf, urdf
from .link import Link, Robot
from .xml import Node, parse

__all__ = ["Link", "Robot", "read", "suffixes"]

suffixes = (".urdf", ".mjcf", ".sdf", ".xml", ".xacro", ".world")

_readers: dict[str, Callable[[Node, pathlib.Path], Robot]] = {"robot": urdf.read, "mujoco": mjcf.read, "sdf": sdf.read}


def read(path: str | os.PathLike[str]) -> Robot:
    """Read a robot description; its root element determines the format.

    Raises
    ------
    InvalidInput
        For a file that cannot be read, is not XML, declares entities, or lacks a required part of a link.
    """
    file = _files.to_path(path, "path")
    root = parse(file)
    if (reader := _readers.get(root.tag)) is None:
        raise InvalidInput(f"{file}: must have the root <robot> (URDF), <mujoco> (MJCF) or <sdf>; got <{root.tag}>")
    return reader(root, file)
