"""The truth of ensembles, in NumPy and Python's own sums: the words of draws, and summaries in blocks and a tree."""

import math

import numpy as np

DEFAULT = {"angle": (2.0**-58, 4.0), "axis_angle": (2.0**-58, 4.0), "omega": (2.0**-40, 2.0**20),
           "energy": (2.0**-60, 2.0**40)}


def draw_key(name):
    """FNV-1a, 64 bits (Fowler, Noll, Vo)."""
    value = 0xCBF29CE484222325
    for byte in name.encode():
        value = (value ^ byte) * 0x100000001B3 % 2**64
    return value


def draw_words(seed, key, first, count, attempt=0):
    """Eight words for each body: NumPy's Philox4x64-10."""
    philox = np.random.Philox(key=[seed, draw_key(key)], counter=[2 * first, attempt, 0, 0])
    return philox.random_raw(8 * count).reshape(count, 8)


def conjugate_times(a, b):
    """conj(a) b of quaternions (x, y, z, w)."""
    vector = a[..., 3:] * b[..., :3] - b[..., 3:] * a[..., :3] - np.cross(a[..., :3], b[..., :3])
    return np.concatenate([vector, (a * b).sum(-1, keepdims=True)], axis=-1)


def rotate(q, v):
    """Body to space."""
    t = 2 * np.cross(q[..., :3], v)
    return v + q[..., 3:] * t + np.cross(q[..., :3], t)


def value_of(quantity, omega, attitude, inertia, value=None):
    """The number of each state that a summary is of, shape (bodies, times)."""
    kind = quantity["of"]
    if kind == "angle":
        turn = conjugate_times(np.broadcast_to(quantity["nominal"], attitude.shape), attitude)
        return 2 * np.arctan2(np.linalg.norm(turn[..., :3], axis=-1), np.abs(turn[..., 3]))
    if kind == "axis_angle":
        axis = rotate(attitude, np.broadcast_to(np.asarray(quantity["axis"], float), attitude.shape[:-1] + (3,)))
        target = np.broadcast_to(np.asarray(quantity["target"], float), axis.shape)
        return np.arctan2(np.linalg.norm(np.cross(axis, target), axis=-1), (axis * target).sum(-1))
    if kind == "omega":
        return np.linalg.norm(omega, axis=-1)
    if kind == "energy":
        inertia = np.asarray(getattr(inertia, "matrix", inertia))
        if inertia.ndim == 3 or inertia.shape == (3, 3) and hasattr(inertia, "matrix"):
            return 0.5 * np.einsum("nti,nij,ntj->nt", omega, np.broadcast_to(inertia, (len(omega), 3, 3)), omega)
        return 0.5 * (np.broadcast_to(inertia, (len(omega), 3))[:, None] * omega**2).sum(-1)
    return value


def exact_sums(values):
    """The correctly rounded mean, rms, and the least and largest of each time, of the rows that are no NaN."""
    kept = values[~np.isnan(values).any(axis=1)]
    mean = [math.fsum(column) / len(kept) for column in kept.T]
    rms = [math.sqrt(math.fsum(column * column) / len(kept)) for column in kept.T]
    return np.array(mean), np.array(rms), kept.min(axis=0), kept.max(axis=0)
