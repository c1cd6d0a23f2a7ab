"""The options of `polhode inertia` for robots, which the command has with and without the wing that reads robots."""

from __future__ import annotations

import dataclasses
import pathlib

from .. import _wings
from .part import is_mesh

STDIN = "-"


@dataclasses.dataclass(frozen=True)
class Options:
    """The options of `polhode inertia` that are for robots."""

    form: str = "text"
    fail_on: str = "warning"
    ignore: tuple[str, ...] = ()
    path: tuple[str, ...] = ()
    package: tuple[str, ...] = ()
    fix: bool = False
    xacro: bool = True

    def given(self) -> str:
        """The first option that only robots have, or ""."""
        return next((f"--{name.replace('_', '-')}" for name in ("fail_on", "ignore", "path", "package", "fix", "xacro")
                     if getattr(self, name) != getattr(Options(), name)), "")


def is_robot(file: str) -> bool:
    """Return True for a folder, for stdin, and for the suffix of a robot description."""
    path = pathlib.Path(file)
    if file == STDIN or path.is_dir():
        return True
    try:
        return path.suffix.lower() in _wings.load("inertia.robots").suffixes
    except _wings.MissingWing:
        return not is_mesh(file) and path.suffix.lower() not in ("", ".toml")   # what no other part reads
