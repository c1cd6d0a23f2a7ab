"""SciPy's solve_ivp on a scene, with the right-hand side a careful user writes in Python."""

from __future__ import annotations

import importlib.util
import time
from collections.abc import Callable
from math import cos, sin
from typing import Any

import numpy as np

from .. import torques
from ..motion import Floats
from ..scene import Scene

Vector = tuple[float, float, float]
Term = Callable[[float, Vector, tuple[float, float, float, float]], Vector]


class Stopped(Exception):
    """The run was ended, or SciPy gave up; the text says why."""


def refuses(scene: Scene) -> str:
    """Why the scene cannot be run here, or ""."""
    if importlib.util.find_spec("scipy") is None:
        return "SciPy is not installed: pip install 'polhode[peers]'"
    for torque in scene.torques:
        if type(torque) not in _TERMS:
            return f"no right-hand side in Python for {type(torque).__name__}"
    if (np.diff(scene.times) <= 0).any() or scene.times[0] < scene.t0:
        return "solve_ivp wants its times in order, from the start on"
    return ""


def _constant(torque: Any, scene: Scene) -> Term:
    a, b, c = (float(x) for x in torque.torque)
    if torque.frame == "body":
        return lambda t, w, q: (a, b, c)

    def term(t: float, w: Vector, q: tuple[float, float, float, float]) -> Vector:
        r = _matrix(*q)
        return (r[0][0] * a + r[1][0] * b + r[2][0] * c, r[0][1] * a + r[1][1] * b + r[2][1] * c,
                r[0][2] * a + r[1][2] * b + r[2][2] * c)

    return term


def _gravity(torque: Any, scene: Scene) -> Term:
    a, b, c = (float(x) * torque.weight for x in torque.arm)

    def term(t: float, w: Vector, q: tuple[float, float, float, float]) -> Vector:
        x, y, z, s = q   # down, in body axes: minus the third row of the matrix
        i, j, k = 2 * (s * y - x * z), -2 * (y * z + s * x), 2 * (x * x + y * y) - 1
        return b * k - c * j, c * i - a * k, a * j - b * i

    return term


def _gravity_gradient(torque: Any, scene: Scene) -> Term:
    n, phase = float(torque.mean_motion), float(torque.phase)
    inertia = scene.inertia.matrix.tolist()

    def term(t: float, w: Vector, q: tuple[float, float, float, float]) -> Vector:
        r = _matrix(*q)
        c, s = cos(n * t + phase), sin(n * t + phase)
        i, j, k = (c * r[0][m] + s * r[1][m] for m in range(3))
        a, b, d = (row[0] * i + row[1] * j + row[2] * k for row in inertia)
        f = 3 * n * n
        return f * (j * d - k * b), f * (k * a - i * d), f * (i * b - j * a)

    return term


def _damping(torque: Any, scene: Scene) -> Term:
    rows = np.asarray(torque.matrix).tolist()

    def term(t: float, w: Vector, q: tuple[float, float, float, float]) -> Vector:
        a, b, c = (-(row[0] * w[0] + row[1] * w[1] + row[2] * w[2]) for row in rows)
        return a, b, c

    return term


_TERMS: dict[type, Callable[[Any, Scene], Term]] = {
    torques.Constant: _constant, torques.Gravity: _gravity,
    torques.GravityGradient: _gravity_gradient, torques.Damping: _damping,
}


def _matrix(x: float, y: float, z: float, s: float) -> tuple[Vector, Vector, Vector]:
    return ((1 - 2 * (y * y + z * z), 2 * (x * y - s * z), 2 * (x * z + s * y)),
            (2 * (x * y + s * z), 1 - 2 * (x * x + z * z), 2 * (y * z - s * x)),
            (2 * (x * z - s * y), 2 * (y * z + s * x), 1 - 2 * (x * x + y * y)))


def right_hand_side(scene: Scene) -> Callable[[float, Floats], list[float]]:
    """Return f(t, y) for y = (omega, q): plain floats, which are faster than arrays of three."""
    inertia = scene.inertia.matrix
    rows, inverse = inertia.tolist(), np.linalg.inv(inertia).tolist()
    diagonal = not (inertia - np.diag(np.diag(inertia))).any()
    i1, i2, i3 = (float(inertia[k, k]) for k in range(3))
    terms = [_TERMS[type(torque)](torque, scene) for torque in scene.torques]

    def f(t: float, y: Floats) -> list[float]:
        a, b, c, x, y_, z, s = y.tolist()
        if diagonal:
            u, v, w = (i2 - i3) * b * c, (i3 - i1) * c * a, (i1 - i2) * a * b
        else:
            p, q, r = (row[0] * a + row[1] * b + row[2] * c for row in rows)
            u, v, w = q * c - r * b, r * a - p * c, p * b - q * a
        for term in terms:
            e, g, h = term(t, (a, b, c), (x, y_, z, s))
            u, v, w = u + e, v + g, w + h
        if diagonal:
            u, v, w = u / i1, v / i2, w / i3
        else:
            u, v, w = (row[0] * u + row[1] * v + row[2] * w for row in inverse)
        return [u, v, w, 0.5 * (s * a + y_ * c - z * b), 0.5 * (s * b + z * a - x * c),
                0.5 * (s * c + x * b - y_ * a), -0.5 * (x * a + y_ * b + z * c)]

    return f


def run(scene: Scene, method: str, rtol: float, limit: float | None) -> tuple[Floats, Floats, dict[str, int]]:
    """Answer a scene: omega, attitude and counts.

    atol is rtol times the size of the initial rates, and rtol for the quaternion: as one does who knows the scales.

    Raises
    ------
    Stopped
        Past `limit` seconds of this thread's time, or when SciPy gives up.
    """
    import warnings

    from scipy.integrate import solve_ivp  # type: ignore[import-untyped]

    f = right_hand_side(scene)
    function: Callable[[float, Floats], list[float]] = f
    if limit is not None:
        end = time.thread_time() + limit
        calls = 0

        def function(t: float, y: Floats) -> list[float]:
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
