"""States of a body as pairs of arrays, and their small differences.

A state is (omega, attitude): rates in body axes, and a unit quaternion (x, y, z, w) from body to space. A difference is
six numbers: that of the rates, and the rotation vector in body axes that takes one attitude to the other.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .._core import attitude as _kernels

Array = npt.NDArray[np.float64]
State = tuple[Array, Array]


def multiply(first: Array, second: Array) -> Array:
    """Return products of unit quaternions; the arrays broadcast."""
    shape = np.broadcast_shapes(first.shape, second.shape)
    product: Array = _kernels.multiply(np.broadcast_to(first, shape), np.broadcast_to(second, shape))
    return product


def conjugate(attitude: Array) -> Array:
    """Return the quaternions of the reversed rotations."""
    reverse: Array = attitude * np.array([-1.0, -1.0, -1.0, 1.0])
    return reverse


def exponential(vector: Array) -> Array:
    """Return the quaternions of rotation vectors [rad]."""
    return _kernels.from_rotvec(np.ascontiguousarray(vector), False)


def angle_vector(attitude: Array) -> Array:
    """Return the rotation vectors of unit quaternions, of angles up to pi [rad]."""
    return _kernels.as_rotvec(np.ascontiguousarray(attitude), False)


def to_body(attitude: Array, vector: Array) -> Array:
    """Return space vectors in body axes."""
    shape = np.broadcast_shapes(attitude.shape[:-1], vector.shape[:-1])
    return _kernels.apply(np.broadcast_to(attitude, (*shape, 4)), np.broadcast_to(vector, (*shape, 3)), True)


def difference(state: State, other: State) -> Array:
    """Return the six numbers by which `other` differs from `state`, shape (..., 6)."""
    return np.concatenate([other[0] - state[0], angle_vector(multiply(conjugate(state[1]), other[1]))], axis=-1)


def displace(state: State, by: Array) -> State:
    """Return states moved by six numbers each: the reverse of `difference`."""
    return state[0] + by[..., :3], multiply(state[1], exponential(by[..., 3:]))


def rms(array: Array) -> float:
    """Return the root of the mean square of the rows' lengths."""
    return float(np.sqrt(np.mean(np.sum(array * array, axis=-1)))) if array.size else 0.0
