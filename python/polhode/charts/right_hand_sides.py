"""Right-hand sides in Python for other programs: in floats, which is fastest, and in NumPy, as most are written."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, sin
from typing import Any

import numpy as np

from .. import torques
from ..motion import Floats
from ..scene import Scene

Vector = tuple[float, float, float]
Term = Callable[[float, Vector, tuple[float, float, float, float]], Vector]


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


def in_floats(scene: Scene) -> Callable[[float, Floats], list[float]]:
    """Return f(t, y) for y = (omega, q), written out in floats: thirty times faster than arrays of three."""
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


def _numpy_torque(torque: Any, scene: Scene) -> Callable[[float, Floats, Floats], Floats]:
    """Return the torque as a function of time, omega and R_WB."""
    if isinstance(torque, torques.Constant):
        constant = np.array(torque.torque)
        return (lambda t, w, r: constant) if torque.frame == "body" else (lambda t, w, r: r.T @ constant)
    if isinstance(torque, torques.Gravity):
        arm, weight = np.array(torque.arm), torque.weight
        return lambda t, w, r: np.cross(arm, -weight * r[2])
    if isinstance(torque, torques.Damping):
        matrix = np.array(torque.matrix)
        return lambda t, w, r: -matrix @ w
    inertia, n, phase = scene.inertia.matrix, torque.mean_motion, torque.phase

    def gravity_gradient(t: float, w: Floats, r: Floats) -> Floats:
        u = np.cos(n * t + phase) * r[0] + np.sin(n * t + phase) * r[1]
        found: Floats = 3 * n**2 * np.cross(u, inertia @ u)
        return found

    return gravity_gradient


def in_numpy(scene: Scene) -> Callable[[float, Floats], Floats]:
    """Return f(t, y) for y = (omega, q) in NumPy's words."""
    inertia = scene.inertia.matrix
    inverse = np.linalg.inv(inertia)
    terms = [_numpy_torque(torque, scene) for torque in scene.torques]

    def f(t: float, y: Floats) -> Floats:
        w, (x, y_, z, s) = y[:3], y[3:]
        tau = np.cross(inertia @ w, w)
        if terms:
            r = np.array(_matrix(x, y_, z, s))
            for term in terms:
                tau = tau + term(t, w, r)
        turn = np.array([[s, -z, y_], [z, s, -x], [-y_, x, s], [-x, -y_, -z]])
        return np.concatenate([inverse @ tau, 0.5 * turn @ w])

    return f


def writes(torque: object) -> bool:
    """Whether there is a right-hand side for this torque here."""
    return type(torque) in _TERMS
