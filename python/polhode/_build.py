"""The build of polhode, the folder for CMake, and the model of the processor."""

from __future__ import annotations

import os.path
import platform

from . import _core
from ._core import build_info as build_info


def cmake_prefix() -> str:
    """Return the folder that CMake needs to find the C++ library of the installed package.

    Returns
    -------
    str
        For ``cmake -DCMAKE_PREFIX_PATH=...``; ``find_package(polhode)`` then gives ``polhode::polhode``.
    """
    # Not from __file__: in an editable install only the compiled module stands beside include and lib.
    return os.path.dirname(os.path.abspath(_core.__file__))


def processor() -> str:
    """Return the model of this machine's processor."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as lines:
            model = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), "")
    except OSError:   # not Linux
        model = ""
    return model or platform.processor() or platform.machine()
