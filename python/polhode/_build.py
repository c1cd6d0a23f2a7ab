"""The build of polhode, the folder for CMake, and the model of the processor."""

from __future__ import annotations

import importlib.util
import os.path
import platform

from . import _core
from ._core import InvalidInput
from ._core import build_info as build_info


def cmake_prefix() -> str:
    """Return the folder that CMake needs to find the installed C++ library.

    Returns
    -------
    str
        For ``cmake -DCMAKE_PREFIX_PATH=...``; ``find_package(polhode)`` then gives ``polhode::polhode``.

    Raises
    ------
    InvalidInput
        The C++ library is not installed, or has another version. A wheel holds the Python module alone:
        ``pip install 'polhode[cpp]'`` adds the library. An installation from the source has both.
    """
    # Not from __file__: in an editable install only the compiled module stands beside include and lib.
    own = os.path.dirname(os.path.abspath(_core.__file__))
    if os.path.isdir(os.path.join(own, "lib", "cmake", "polhode")):
        return own
    cure = f"pip install polhode-cpp=={build_info()['version']}, or install polhode from its source"
    package = importlib.util.find_spec("polhode_cpp")
    if package is None or package.origin is None:
        raise InvalidInput(f"cmake_prefix: needs the C++ library, which is not installed: {cure}")
    prefix = os.path.dirname(os.path.abspath(package.origin))
    with open(os.path.join(prefix, "include", "polhode", "core", "version.hpp"), encoding="utf-8") as header:
        if f'POLHODE_VERSION "{build_info()["version"]}"' not in header.read():
            raise InvalidInput(f"cmake_prefix: polhode-cpp is installed in another version: {cure}")
    return prefix


def processor() -> str:
    """Return the model of this machine's processor."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as lines:
            model = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), "")
    except OSError:   # not Linux
        model = ""
    return model or platform.processor() or platform.machine()
