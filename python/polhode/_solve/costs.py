"""Costs of the methods on this machine: as shipped, or as measured by `calibrate` and saved in the user's cache."""

from __future__ import annotations

import functools
import json
import math
import os
import pathlib
import sys
import time

from .. import _core, _files
from .._build import processor

LONGEST = 1_000_000   # bytes of the file, which takes a few hundred


def cache_file() -> pathlib.Path:
    """Return the file of the measured costs, in $POLHODE_CACHE or the user's cache folder."""
    folder = os.environ.get("POLHODE_CACHE")
    if folder:
        return pathlib.Path(folder) / "costs.json"
    home = pathlib.Path.home()
    if sys.platform == "darwin":
        base = home / "Library" / "Caches"
    elif sys.platform == "win32":
        base = pathlib.Path(os.environ.get("LOCALAPPDATA", home / "AppData" / "Local"))
    else:
        base = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or home / ".cache")
    return base / "polhode" / "costs.json"


def _machine() -> str:
    return f"{processor()}, {os.environ.get('POLHODE_SIMD', 'best')} lanes"


def _read() -> tuple[dict[str, float], str]:
    """Return the factors and a sentence about their origin; never fails."""
    shipped = "as shipped, not measured on this machine"
    file = cache_file()
    try:
        file.lstat()
    except OSError:
        return {}, f"{shipped} (polhode calibrate does that)"
    try:
        text = _files.read(file, LONGEST)
    except _core.InvalidInput as error:
        return {}, f"{shipped}: {error}"
    try:
        content = json.loads(text)
        factors = {str(name): float(value) for name, value in content["factors"].items()}
        version, machine = content["polhode"], content["machine"]
        if not all(math.isfinite(value) and value > 0 for value in factors.values()):
            raise ValueError("a factor is not positive")
    except (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError):
        return {}, f"{shipped}: {file} is damaged and was ignored; run polhode calibrate"
    if version != _core.__version__ or machine != _machine():
        other = f"polhode {version}" if version != _core.__version__ else f"another machine ({machine})"
        return {}, f"{shipped}: {file} is of {other} and was ignored; run polhode calibrate"
    return factors, f"measured on this machine, {content.get('date', 'once')}"


@functools.cache
def _load() -> tuple[_core.CostFactors, str]:
    factors, text = _read()
    return _core.CostFactors(factors), text


def factors() -> _core.CostFactors:
    """Return the factors in use, for the core."""
    return _load()[0]


def describe() -> str:
    """Return the origin of the costs in use, as a sentence."""
    return _load()[1]


def keep(found: dict[str, float]) -> None:
    """Write measured factors to `cache_file()` atomically, and use them in this process."""
    file = cache_file()
    content = {"polhode": _core.__version__, "machine": _machine(), "date": time.strftime("%Y-%m-%d"), "factors": found}
    file.parent.mkdir(parents=True, exist_ok=True)
    _files.write(file, json.dumps(content, indent=1))
    _load.cache_clear()
