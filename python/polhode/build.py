"""How this polhode was built, and where C++ projects find it."""

from __future__ import annotations

import os.path

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
