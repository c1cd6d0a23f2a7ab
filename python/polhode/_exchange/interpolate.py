"""Attitudes between knots, as the readers of a file interpolate them."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
METHODS = ("lagrange", "linear")


def normalise(rows: Floats) -> Floats:
    """Return unit quaternions, shape (n, 4)."""
    return np.asarray(rows / np.linalg.norm(rows, axis=1, keepdims=True))


def angle_between(first: Floats, second: Floats) -> Floats:
    """Return the angles of the rotations between unit quaternions, shape (n,) [rad]; the signs do not matter."""
    near = np.where(np.sum(first * second, axis=1, keepdims=True) < 0, -second, second)
    chord = np.linalg.norm(first - near, axis=1)
    return np.asarray(4.0 * np.arcsin(np.minimum(chord / 2.0, 1.0)))


def make_continuous(rows: Floats) -> Floats:
    """Return quaternions whose signs go on: each lies on the side of the one before."""
    flips = np.sum(rows[1:] * rows[:-1], axis=1) < 0
    signs = np.where(np.cumsum(np.concatenate([[False], flips])) % 2 == 1, -1.0, 1.0)
    return np.asarray(rows * signs[:, None])


def lagrange(t: Floats, rows: Floats, at: Floats, degree: int, cut: bool = False) -> Floats:
    """Interpolate each component by a polynomial, and normalise.

    Parameters
    ----------
    t : ndarray, shape (n,)
        Knots, ascending [s].
    rows : ndarray, shape (n, 4)
        Quaternions whose signs go on.
    at : ndarray, shape (m,)
        Times between the first knot and the last [s].
    degree : int
        Odd: the window has as many knots on both sides.
    cut : bool
        Next to an end the window loses the knots that are not there, as in SPICE. Else it is moved inside.

    Returns
    -------
    ndarray, shape (m, 4)
    """
    count = min(degree + 1, len(t))
    interval = np.clip(np.searchsorted(t, at, side="right") - 1, 0, len(t) - 2)
    first = interval - (degree - 1) // 2
    if cut:
        count = degree + 1
    else:
        first = np.clip(first, 0, len(t) - count)
    window = first[:, None] + np.arange(count)
    there = (window >= 0) & (window < len(t))
    window = np.clip(window, 0, len(t) - 1)
    # Differences of times are exact enough only from a near origin.
    knots = t[window] - t[interval][:, None]
    here = at - t[interval]
    weights = there.astype(float)
    for j in range(count):
        for k in range(count):
            if k != j:
                both = there[:, j] & there[:, k]
                width = np.where(both, knots[:, j] - knots[:, k], 1.0)
                weights[:, j] *= np.where(both, (here - knots[:, k]) / width, 1.0)
    return normalise(np.einsum("mj,mji->mi", weights, rows[window]))


def slerp(t: Floats, rows: Floats, at: Floats) -> Floats:
    """Turn about a fixed axis with a constant rate between knots; arguments as in `lagrange` (Shoemake 1985)."""
    interval = np.clip(np.searchsorted(t, at, side="right") - 1, 0, len(t) - 2)
    share = ((at - t[interval]) / (t[interval + 1] - t[interval]))[:, None]
    first, second = rows[interval], rows[interval + 1]
    chord = np.linalg.norm(second - first, axis=1)
    half = 2.0 * np.arcsin(np.minimum(chord / 2.0, 1.0))[:, None]   # the angle between the quaternions
    small = half < 1e-9
    size = np.where(small, 1.0, np.sin(half))
    early = np.where(small, 1.0 - share, np.sin((1.0 - share) * half) / size)
    late = np.where(small, share, np.sin(share * half) / size)
    return normalise(early * first + late * second)


def reaches(span: float, rate: float) -> int:
    """Return the fewest intervals with which a quaternion's sign can be followed: below half a revolution each."""
    return max(1, math.ceil(abs(span) * rate / 3.0))
