"""Whether a program is installed, without importing it."""

from __future__ import annotations

import importlib.util
from importlib import metadata


def version(package: str, module: str = "") -> str:
    """The installed version of a distribution whose module can be found, or ""."""
    try:
        if importlib.util.find_spec(module or package) is None:
            return ""
        return metadata.version(package)
    except (metadata.PackageNotFoundError, ModuleNotFoundError, ValueError):
        return ""
