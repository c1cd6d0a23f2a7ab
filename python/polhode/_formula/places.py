"""Refusals of a trace, with the line of the user's function."""

from __future__ import annotations

import linecache
import os
import sys
from typing import NoReturn

import numpy as np

from .._core import InvalidInput

_OURS = (os.path.dirname(os.path.dirname(os.path.abspath(__file__))), os.path.dirname(os.path.abspath(np.__file__)))


def _is_ours(path: str) -> bool:
    return path.startswith("<__array_function__") or any(path.startswith(folder + os.sep) for folder in _OURS)


def find_line() -> str:
    """Return file, line and text of the innermost line that is neither ours nor NumPy's."""
    frame = sys._getframe(1)
    while frame.f_back is not None and _is_ours(frame.f_code.co_filename):
        frame = frame.f_back
    path, number = frame.f_code.co_filename, frame.f_lineno
    text = linecache.getline(path, number).strip()
    return f"{os.path.basename(path)}, line {number}" + (f": {text}" if text else "")


def refuse(what: str, instead: str) -> NoReturn:
    """Refuse what cannot be traced.

    Raises
    ------
    InvalidInput
        Always.
    """
    raise InvalidInput(f"Formula.function: must be traceable, got {what} ({find_line()}); {instead}, or use "
                       "polhode.torques.Custom")
