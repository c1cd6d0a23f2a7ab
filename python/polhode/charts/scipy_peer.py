"""SciPy's solve_ivp on a scene."""

from __future__ import annotations

import importlib.util
import time
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np

from ..motion import Floats
from ..scene import Scene
from .right_hand_sides import writes


class Stopped(Exception):
    """The run was ended, or SciPy gave up; the text says why."""


def refuses(scene: Scene) -> str:
    """Why the scene cannot be run here, or ""."""
    if importlib.util.find_spec("scipy") is None:
        return "SciPy is not installed: pip install 'polhode[peers]'"
    for torque in scene.torques:
        if not writes(torque):
            return f"no right-hand side in Python for {type(torque).__name__}"
    if (np.diff(scene.times) <= 0).any() or scene.times[0] < scene.t0:
        return "solve_ivp wants its times in order, from the start on"
    return ""


def run(
    scene: Scene, make_right_hand_side: Callable[[Scene], Any], method: str, rtol: float, limit: float | None
) -> tuple[Floats, Floats, dict[str, int]]:
    """Answer a scene: omega, attitude and counts.

    atol is rtol times the size of the initial rates, and rtol for the quaternion: as one does who knows the scales.

    Raises
    ------
    Stopped
        Past `limit` seconds of this thread's time, or when SciPy gives up.
    """
    from scipy.integrate import solve_ivp  # type: ignore[import-untyped]

    f = make_right_hand_side(scene)
    function: Callable[[float, Floats], Any] = f
    if limit is not None:
        end = time.thread_time() + limit
        calls = 0

        def function(t: float, y: Floats) -> Any:
            nonlocal calls
            calls += 1
            if calls % 64 == 0 and time.thread_time() > end:
                raise Stopped(f"not done within {limit:.2g} s: reached t = {t:.3g} s")
            return f(t, y)

    size = float(np.linalg.norm(scene.omega)) or 1.0
    start = np.concatenate([scene.omega, scene.attitude])
    with warnings.catch_warnings():   # of tolerances below 100 units of rounding, which are raised
        warnings.simplefilter("ignore")
        result = solve_ivp(function, (scene.t0, float(scene.times[-1])), start, method=method, t_eval=scene.times,
                           rtol=rtol, atol=rtol * np.array([size] * 3 + [1.0] * 4))
    if not result.success:
        raise Stopped(str(result.message))
    return result.y[:3].T.copy(), result.y[3:].T.copy(), {"derivatives": int(result.nfev)}
