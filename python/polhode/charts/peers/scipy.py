"""SciPy's solve_ivp: the right-hand side written out in floats, samples from its own continuous extension."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np

from ..._scene.scene import Scene
from ..candidate import Answer, Candidate, Failure, Run, tolerances
from ..equations import in_floats, refuses
from .found import version

NAME, INSTALL = "SciPy", "pip install scipy"


def found() -> str:
    """The version, or ""."""
    return version("scipy")


def sizes(scene: Scene) -> Any:
    """Return what a tolerance is relative to: the size of the rates, and 1 for the quaternion."""
    return np.array([float(np.linalg.norm(scene.omega)) or 1.0] * 3 + [1.0] * 4)


def watched(function: Callable[[float, Any], Any], limit: float | None) -> Callable[[float, Any], Any]:
    """The same function, which ends the run after `limit` seconds of the clock."""
    if limit is None:
        return function
    end, calls = time.perf_counter() + limit, 0

    def watching(t: float, y: Any) -> Any:
        nonlocal calls
        calls += 1
        if calls % 64 == 0 and time.perf_counter() > end:
            raise Failure(f"not done within {limit:.2g} s: reached t = {t:.3g} s")
        return function(t, y)

    return watching


def _start(scene: Scene, method: str) -> Run:
    from scipy.integrate import solve_ivp  # type: ignore[import-untyped]

    f = in_floats(scene)
    start, size = np.concatenate([scene.omega, scene.attitude]), sizes(scene)
    span = (scene.t0, float(scene.times[-1]))

    def run(rtol: float, limit: float | None) -> Answer:
        with warnings.catch_warnings():   # of tolerances below 100 units of rounding, which are raised
            warnings.simplefilter("ignore")
            result = solve_ivp(watched(f, limit), span, start, method=method, t_eval=scene.times, rtol=rtol,
                               atol=rtol * size)
        if not result.success:
            raise Failure(str(result.message))
        return Answer(result.y[:3].T.copy(), result.y[3:].T.copy(), {"derivatives": int(result.nfev)})

    return run


def candidates() -> list[Candidate]:
    """RK45 and DOP853 with dense output of orders 4 and 7, LSODA, its fastest, and Radau for what damps."""
    def make(method: str) -> Candidate:
        # A run takes up to seconds, so every third decade is what there is time for.
        return Candidate(f"SciPy {method}", "peer", f"scipy.integrate.solve_ivp(method={method!r})",
                         tolerances(3, 12, 3),
                         lambda scene: _start(scene, method), lambda scene: refuses(scene, method == "Radau"),
                         right_hand_side="in Python")

    return [make(method) for method in ("RK45", "DOP853", "LSODA", "Radau")]
