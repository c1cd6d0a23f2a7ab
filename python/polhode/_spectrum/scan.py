"""Scans over trial frequencies: what sums of cosines and sines take away, and the extrema of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core

Array = npt.NDArray[np.float64]
Places = npt.NDArray[Any]   # integers

STEP = 0.8       # of a grid, over the span of the times: a line is 2 pi / span wide
BLOCK = 20_000   # trials at once


def grid(t: Array, low: float, high: float) -> Array:
    """Return trial frequencies from `low` to `high` [rad/s]."""
    step = STEP / float(np.ptp(t))
    return np.asarray(low + step * np.arange(max(int((high - low) / step), 1) + 1), np.float64)


def _grid(f: Array) -> tuple[float, float, float]:
    return float(f[0]), float(f[1] - f[0]) if f.size > 1 else 0.0, float(f.size)


def project(t: Array, y: Array, weight: Array, lines: Sequence[tuple[int, int]], f: Array, g: Array, block: int = 1,
            ) -> Array:
    """Return Y^T P Y by blocks, (f, g, blocks, block, block), for lines a f + b g; f and g are even grids."""
    return np.asarray(_core._project_lines(t, y, weight, list(lines), _grid(f), _grid(g), block))


def periodogram(t: Array, z: npt.NDArray[Any], f: Array) -> Array:
    """Return the sum over the columns of z (n, k) of abs(sum z exp(-i f t))^2."""
    parts: Array = np.ascontiguousarray(z).view(np.float64)
    return np.asarray(_core._periodogram(t, parts, z.shape[1], _grid(f)))


def peaks(power: Array, count: int) -> npt.NDArray[np.intp]:
    """Return the places of the largest local maxima, the largest first; the ends count too."""
    padded = np.concatenate([[-np.inf], power, [-np.inf]])
    found = np.flatnonzero((power >= padded[:-2]) & (power > padded[2:]))
    return found[np.argsort(-power[found], kind="stable")[:count]]


def refine(power: Callable[[Array], Array], f: float, step: float, rounds: int = 3) -> float:
    """Return the place of a maximum near `f`, by grids of nine trials, each a quarter as wide as the last."""
    for _ in range(rounds):
        trials = f + step * np.linspace(-1, 1, 9)
        f = float(trials[int(np.argmax(power(trials)))])
        step /= 4
    return f


def largest_eigenvalue(A: Array) -> Array:
    """Return the largest eigenvalue of symmetric matrices (..., 3, 3), by the cosine (Smith 1961)."""
    q = np.trace(A, axis1=-2, axis2=-1) / 3
    B = A - q[..., None, None] * np.eye(3)
    p = np.sqrt(np.maximum((B * B).sum(axis=(-2, -1)) / 6, 1e-150))
    r = (B[..., 0, 0] * (B[..., 1, 1] * B[..., 2, 2] - B[..., 1, 2] ** 2)
         - B[..., 0, 1] * (B[..., 0, 1] * B[..., 2, 2] - B[..., 1, 2] * B[..., 0, 2])
         + B[..., 0, 2] * (B[..., 0, 1] * B[..., 1, 2] - B[..., 1, 1] * B[..., 0, 2])) / (2 * p**3)
    out: Array = q + 2 * p * np.cos(np.arccos(np.clip(r, -1, 1)) / 3)
    return out
