"""Quaternions and rotation vectors as arrays, for fits."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .. import _core

Array = npt.NDArray[np.float64]


def product(p: Array, q: Array) -> Array:
    """Return the Hamilton product of quaternions (..., 4)."""
    out: Array = _core.attitude.product(p, q)
    return out


def conjugate(q: Array) -> Array:
    """Return the inverse of unit quaternions."""
    out: Array = np.asarray(q) * np.array([-1.0, -1.0, -1.0, 1.0])
    return out


def to_matrix(q: Array) -> Array:
    """Return rotation matrices (..., 3, 3)."""
    x, y, z, w = np.moveaxis(np.asarray(q), -1, 0)
    rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def of_matrix(R: Array) -> Array:
    """Return the unit quaternion of a rotation matrix (3, 3)."""
    trace = np.trace(R)
    four = np.array([[R[0, 0] * 2 - trace, R[0, 1] + R[1, 0], R[0, 2] + R[2, 0], R[2, 1] - R[1, 2]],
                     [0, R[1, 1] * 2 - trace, R[1, 2] + R[2, 1], R[0, 2] - R[2, 0]],
                     [0, 0, R[2, 2] * 2 - trace, R[1, 0] - R[0, 1]], [0, 0, 0, trace]])
    _, vectors = np.linalg.eigh(four, UPLO="U")
    found: Array = vectors[:, -1] * (1 if vectors[3, -1] >= 0 else -1)
    return found


def rotate(q: Array, v: Array) -> Array:
    """Rotate vectors."""
    out: Array = np.einsum("...ij,...j->...i", to_matrix(q), v)
    return out


def cross_matrix(v: Array) -> Array:
    """Return [v]x, shape (..., 3, 3)."""
    x, y, z = np.moveaxis(np.asarray(v), -1, 0)
    o = np.zeros_like(x)
    return np.moveaxis(np.array([[o, -z, y], [z, o, -x], [-y, x, o]]), (0, 1), (-2, -1))


def exp(vector: Array) -> Array:
    """Return the quaternions of rotation vectors (..., 3)."""
    vector = np.asarray(vector)
    angle = np.linalg.norm(vector, axis=-1, keepdims=True)
    return np.concatenate([0.5 * np.sinc(angle / (2 * np.pi)) * vector, np.cos(0.5 * angle)], axis=-1)


def log(q: Array) -> Array:
    """Return the rotation vectors of quaternions, of angle at most pi."""
    q = np.where(q[..., 3:] < 0, -q, q)
    sine = np.linalg.norm(q[..., :3], axis=-1, keepdims=True)
    half = np.arctan2(sine, q[..., 3:])
    out: Array = q[..., :3] * np.where(sine > 1e-150, 2 * half / np.where(sine > 1e-150, sine, 1), 2.0)
    return out


def inverse_right_jacobian(vector: Array) -> Array:
    """Return d log(R exp(e)) / d e at log(R) = vector; its transpose is the inverse left Jacobian."""
    angle = np.linalg.norm(vector, axis=-1)[..., None, None]
    K = cross_matrix(vector)
    small = angle < 1e-2
    safe = np.where(small, 1.0, angle)
    factor = np.where(small, 1 / 12 + angle**2 / 720,
                      1 / safe**2 - 1 / (2 * safe * np.tan(np.minimum(safe, np.pi - 1e-12) / 2)))
    out: Array = np.eye(3) + 0.5 * K + factor * (K @ K)
    return out
