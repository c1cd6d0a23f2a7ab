"""How fast this machine is, beside the one that the forecasts were made on: measured once, kept in the user's cache."""

from __future__ import annotations

import functools
import json
import math
import os
import pathlib
import platform
import sys
import time
from collections.abc import Callable
from typing import Any

from . import _core

MOST_SECONDS = 15.0   # of all measurements together


def cache_file() -> pathlib.Path:
    """Return where the measured costs are kept: $POLHODE_CACHE, or the user's cache folder."""
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
    try:
        with open("/proc/cpuinfo") as lines:
            model = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), "")
    except OSError:
        model = ""
    return f"{model or platform.processor() or platform.machine()}, {os.environ.get('POLHODE_SIMD', 'best')} lanes"


def _read() -> tuple[dict[str, float], str]:
    """Return the factors and a sentence on where they are from; never fails."""
    shipped = "as shipped, not measured on this machine"
    file = cache_file()
    try:
        text = file.read_text()
    except FileNotFoundError:
        return {}, f"{shipped} (polhode calibrate does that)"
    except (OSError, UnicodeDecodeError) as error:
        return {}, f"{shipped}: {file} cannot be read ({type(error).__name__})"
    try:
        content = json.loads(text)
        factors = {str(name): float(value) for name, value in content["factors"].items()}
        version, machine = content["polhode"], content["machine"]
        if not all(math.isfinite(value) and value > 0 for value in factors.values()):
            raise ValueError("a factor is not positive")
    except (ValueError, KeyError, TypeError, AttributeError):
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
    """Return the factors in use, as the core takes them."""
    return _load()[0]


def describe() -> str:
    """Return where the costs in use are from, in a sentence."""
    return _load()[1]


def _seconds(run: Callable[[], Any], most: float) -> float:
    """The least CPU time of a few runs."""
    best, spent, runs = math.inf, 0.0, 0
    while runs < 3 or (spent < most and runs < 30):
        start = time.thread_time()
        run()
        took = time.thread_time() - start
        best, spent, runs = min(best, took), spent + took, runs + 1
        if spent > 10 * most:
            break
    return best


def _scenes() -> list[Any]:
    """One scene an exact model, and three that are stepped."""
    from . import torques
    from .scene import Scene

    def even(span: float, count: int) -> list[float]:
        return [span * i / (count - 1) for i in range(count)]

    block, times = (0.2, 0.4, 0.52), even(40.0, 401)
    tilted = (math.sin(0.25), 0.0, 0.0, math.cos(0.25))
    return [
        Scene(inertia=block, omega=(0, 0, 0), times=times), Scene(inertia=(1, 1, 1), omega=(1, 2, 3), times=times),
        Scene(inertia=block, omega=(0, 4, 0), times=times), Scene(inertia=(1, 1, 2), omega=(1, 2, 3), times=times),
        Scene(inertia=(3, 4, 6), omega=(2, 1, 1), times=times), Scene(inertia=block, omega=(1, 2, 3), times=times),
        Scene(inertia=(1, 1, 0.5), omega=(0, 0, 6), attitude=tilted, torques=[torques.Gravity(2, (0, 0, 1))], times=times),
        Scene(inertia=(1, 2, 2.5), omega=(0.3, 0.2, 3), attitude=tilted, torques=[torques.Gravity(2, (0.3, 0.2, 0.5))],
              times=times),
        Scene(inertia=block, omega=(1, 2, 3), torques=[torques.Damping((1e-3, 2e-3, 3e-3))], times=times),
        Scene(inertia=block, omega=(0.1, 0.2, 0.3), torques=[torques.Constant((0.01, -0.02, 0.03))], times=times),
    ]


def measure(progress: Callable[[int, int], object] | None = None) -> dict[str, float]:
    """Measure every exact model and every method that plans choose from; returns seconds by forecast seconds, by name."""
    from .planning import Plan
    from .solver import solve

    shipped = _core.CostFactors({})
    jobs: list[tuple[str, Any, float]] = []
    for scene in _scenes():
        for accuracy in (1e-5, 1e-9):
            report = _core.plan(scene, accuracy, None, False, "euler", shipped)
            stepped = report["plan"][1] != "exact"
            names = [one[0] for one in report["candidates"] if not one[1] and not one[2]] if stepped else ["exact"]
            jobs += [(name, scene, accuracy) for name in names]
    ratios: dict[str, list[float]] = {}
    for done, (name, scene, accuracy) in enumerate(jobs):
        forecast = Plan(scene, _core.plan(scene, accuracy, name, False, "euler", shipped)["plan"], {})
        took = _seconds(lambda: solve(scene, accuracy, method=name, certify=False), MOST_SECONDS / len(jobs) / 4)
        key = forecast.model if name == "exact" else name
        ratios.setdefault(key, []).append(took / forecast.predicted_seconds)
        if progress is not None:
            progress(done + 1, len(jobs))
    return {key: math.exp(sum(map(math.log, values)) / len(values)) for key, values in ratios.items()}


def calibrate(progress: Callable[[int, int], object] | None = None) -> dict[str, float]:
    """Measure this machine and keep the result for the plans to come, in the file that `cache_file` names.

    Returns
    -------
    dict
        For each exact model and method, its time by the shipped forecast's.
    """
    found = measure(progress)
    file = cache_file()
    content = {"polhode": _core.__version__, "machine": _machine(), "date": time.strftime("%Y-%m-%d"), "factors": found}
    file.parent.mkdir(parents=True, exist_ok=True)
    temporary = file.with_suffix(f".{os.getpid()}")
    temporary.write_text(json.dumps(content, indent=1))
    temporary.replace(file)
    _load.cache_clear()
    return found
