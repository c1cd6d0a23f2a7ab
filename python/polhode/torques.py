"""Torques on a body. Each class is made from a record of the list of torques of the core."""

from __future__ import annotations

from typing import Any

from . import _core
from ._core.torques import *  # noqa: F403  the list is the compiled one

__all__ = [record["name"] for record in _core.torque_records()] + ["During", "records"]  # noqa: F405

for _name in __all__[:-1]:
    globals()[_name].__module__ = "polhode.torques"


def records() -> list[dict[str, Any]]:
    """Return the records of all torques: name, scene-file key, doc, source and parameters."""
    return list(_core.torque_records())
