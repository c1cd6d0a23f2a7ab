"""Measure the speed of this machine relative to the machine of the forecasts."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

from .. import _core, torques
from .._core import Rotor
from .._scene.scene import Scene
from .costs import keep
from .solve import solve

MOST_SECONDS = 15.0   # of all measurements together


def _seconds(run: Callable[[], Any], most: float) -> float:
    """Return the least CPU time of a few runs."""
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
    """Return one scene for each exact model, and three that are integrated."""
    def even(span: float, count: int) -> list[float]:
        return [span * i / (count - 1) for i in range(count)]

    block, times = (0.2, 0.4, 0.52), even(40.0, 401)
    tilted = (math.sin(0.25), 0.0, 0.0, math.cos(0.25))
    return [
        Scene(inertia=block, omega=(0, 0, 0), times=times), Scene(inertia=(1, 1, 1), omega=(1, 2, 3), times=times),
        Scene(inertia=block, omega=(0, 4, 0), times=times), Scene(inertia=(1, 1, 2), omega=(1, 2, 3), times=times),
        Scene(inertia=(3, 4, 6), omega=(2, 1, 1), times=times), Scene(inertia=block, omega=(1, 2, 3), times=times),
        Scene(inertia=(1, 1, 0.5), omega=(0, 0, 6), attitude=tilted, torques=[torques.Gravity(2, (0, 0, 1))],
              times=times),
        Scene(inertia=block, omega=(1, 0, 0), torques=[torques.Gravity(2, (0, 0, -0.5))], times=times),
        Scene(inertia=(1, 2, 2.5), omega=(0.3, 0.2, 3), attitude=tilted, torques=[torques.Gravity(2, (0.3, 0.2, 0.5))],
              times=times),
        Scene(inertia=block, omega=(1, 2, 3), torques=[torques.AngularDamping(0.01)], times=times),
        Scene(inertia=block, omega=(1, 2, 3), rotors=[Rotor((1, 2, 2), momentum=0.5)], times=times),
        Scene(inertia=(1, 1, 0.5), omega=(0, 0, 6), attitude=tilted, torques=[torques.Gravity(2, (0, 0, 1))],
              rotors=[Rotor((0, 0, 1), momentum=1.0)], times=times),
        Scene(inertia=block, omega=(1, 2, 3), torques=[torques.Damping((1e-3, 2e-3, 3e-3))], times=times),
        Scene(inertia=block, omega=(0.1, 0.2, 0.3), torques=[torques.Constant((0.01, -0.02, 0.03))], times=times),
    ]


def measure(progress: Callable[[int, int], object] | None = None) -> dict[str, float]:
    """Measure every exact model and every method that a plan can choose.

    Returns
    -------
    dict
        By name, the measured time over the forecast time.
    """
    shipped = _core.CostFactors({})
    jobs: list[tuple[str, Any, float]] = []
    for scene in _scenes():
        for accuracy in (1e-5, 1e-9):
            planned = _core.PlannedScene(scene, {"accuracy": accuracy, "certify": False, "cost_factors": shipped})
            able = [candidate["name"] for candidate in planned.report["candidates"]
                    if not candidate["exact"] and not candidate["why_not"]]
            names = ["exact"] if planned.parts["method"] == "exact" else able
            jobs += [(name, scene, accuracy) for name in names]
    ratios: dict[str, list[float]] = {}
    for done, (name, scene, accuracy) in enumerate(jobs):
        options = {"accuracy": accuracy, "method": name, "certify": False, "cost_factors": shipped}
        forecast = _core.PlannedScene(scene, options).parts
        took = _seconds(lambda: solve(scene, accuracy, method=name, certify=False), MOST_SECONDS / len(jobs) / 4)
        key = forecast["model"] if name == "exact" else name
        ratios.setdefault(key, []).append(took / forecast["predicted_seconds"])
        if progress is not None:
            progress(done + 1, len(jobs))
    return {key: math.exp(sum(map(math.log, values)) / len(values)) for key, values in ratios.items()}


def calibrate(progress: Callable[[int, int], object] | None = None) -> dict[str, float]:
    """Measure this machine and save the result in `cache_file()` for later plans.

    Returns
    -------
    dict
        For each exact model and method, its time over the shipped forecast.
    """
    found = measure(progress)
    keep(found)
    return found
