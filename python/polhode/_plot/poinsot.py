"""Poinsot's construction as curves: the ellipsoid of constant energy, the polhodes on it, and the herpolhode.

The tip of omega, in principal axes, moves on the ellipsoid I1 w1^2 + I2 w2^2 + I3 w3^2 = 2 T along its cut with that of
constant angular momentum: the polhode. In space it moves on a plane across the angular momentum: the herpolhode
(Goldstein, Poole and Safko 2002, section 5.6).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from .._solve.motion import Floats


class View(NamedTuple):
    """Parallel projection: what of a vector goes right and up on paper, and what towards the reader."""

    right: Floats
    up: Floats
    towards: Floats


def make_view(azimuth: float = 35.0, elevation: float = 22.0) -> View:
    """Return the view from these angles [degrees], with axis 3 upright."""
    a, e = math.radians(azimuth), math.radians(elevation)
    towards = np.array([math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e)])
    right = np.array([-math.sin(a), math.cos(a), 0.0])
    return View(right, np.cross(towards, right), towards)


def outline(semi_axes: Floats, view: View, count: int = 241) -> Floats:
    """Return the outline of an ellipsoid on paper, shape (count, 2): that of P A P^T for A = diag(semi_axes^2)."""
    p = np.stack([view.right, view.up])
    lower = np.linalg.cholesky(p @ np.diag(semi_axes**2) @ p.T)
    angle = np.linspace(0, 2 * math.pi, count)
    found: Floats = np.stack([np.cos(angle), np.sin(angle)], axis=1) @ lower.T
    return found


def in_front(points: Floats, semi_axes: Floats, view: View) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Whether points of the ellipsoid are on the reader's side."""
    seen: np.ndarray[tuple[int], np.dtype[np.bool_]] = points / semi_axes**2 @ view.towards >= 0
    return seen


def _round_axis(moments: Floats, energy2: float, momentum2: float, axis: int, count: int) -> list[Floats]:
    """The two polhodes round axis 0 or 2 for 2 T and L^2: its own rate eliminated, the other two are on an ellipse."""
    others = [k for k in range(3) if k != axis]
    own = moments[axis]
    weights = [moments[k] * abs(own - moments[k]) for k in others]
    size = abs(energy2 * own - momentum2)
    if min(weights) <= 1e-9 * own**2:
        return []
    angle = np.linspace(0, 2 * math.pi, count)
    w = np.zeros((count, 3))
    for k, weight, wave in zip(others, weights, (np.cos(angle), np.sin(angle))):
        w[:, k] = math.sqrt(size / weight) * wave
    left = np.maximum(0.0, energy2 - sum(moments[k] * w[:, k] ** 2 for k in others))
    w[:, axis] = np.sqrt(left / own)
    mirrored = w.copy()
    mirrored[:, axis] *= -1
    return [w, mirrored]


def family(moments: Floats, energy2: float, count: int = 4, points: int = 181) -> tuple[list[Floats], list[Floats]]:
    """Return polhodes of one energy for a body: some round axes 1 and 3, and the separatrix through axis 2.

    Parameters
    ----------
    moments : ndarray, shape (3,)
        Ascending [kg m^2].
    energy2 : float
        2 T [J].
    """
    low, middle, high = moments
    curves: list[Floats] = []
    for k in range(1, count + 1):
        share = (k / (count + 1)) ** 2   # evenly far apart on the ellipsoid, about
        curves += _round_axis(moments, energy2, energy2 * (low + (middle - low) * share), 0, points)
        curves += _round_axis(moments, energy2, energy2 * (high + (middle - high) * share), 2, points)
    between = _round_axis(moments, energy2, energy2 * middle, 2, points)
    return curves, between if middle - low > 1e-9 * high and high - middle > 1e-9 * high else []


def herpolhode(omega_W: Floats, momentum_W: Floats) -> Floats:
    """Return the path of omega's tip on the plane across the angular momentum at the start, shape (n, 2) [rad/s]."""
    axis = momentum_W / np.linalg.norm(momentum_W)
    helper = np.eye(3)[int(np.argmin(np.abs(axis)))]
    right = np.cross(axis, helper)
    right /= np.linalg.norm(right)
    return np.stack([omega_W @ right, omega_W @ np.cross(axis, right)], axis=1)
