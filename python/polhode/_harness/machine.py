"""The machine of a measurement."""

from __future__ import annotations

import os
import platform
from importlib import metadata
from typing import Any

from .._build import processor


def machine() -> dict[str, Any]:
    """Return the properties of the machine on which times depend."""
    return {"processor": processor(), "cores": os.cpu_count(), "system": platform.platform(),
            "python": platform.python_version()}


def versions() -> dict[str, str]:
    """Return the versions of the packages that every measurement uses, of those that are installed."""
    found = {}
    for name in ("numpy", "matplotlib"):
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            pass
    return found
