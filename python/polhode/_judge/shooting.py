"""Motions through data: all samples are states at once, and Newton's method closes the steps between them.

Each iteration is linear about the states X: a small change obeys e_(k+1) = Phi_k e_k + d_k, where d_k is by how much
the step from X_k misses X_(k+1). The change of the start of each segment, and shared coefficients, are fitted to the
data. No sequence of steps is integrated, so that all steps run in batches; gross errors of the data do no harm.
"""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from .law import Law
from .states import Array, State, difference, displace, rms


@dataclasses.dataclass(frozen=True, eq=False)
class Data:
    """Samples as states, (n,) times, and which of both channels were measured. `scale` is the rms of the rates."""

    t: Array
    omega: Array
    attitude: Array
    has_omega: bool = True
    has_attitude: bool = True

    @property
    def state(self) -> State:
        return self.omega, self.attitude

    @property
    def scale(self) -> float:
        return rms(self.omega) or 1.0

    @property
    def channels(self) -> list[tuple[slice, float]]:
        """The columns of each measured channel, and what they are divided by."""
        return ([(slice(0, 3), self.scale)] if self.has_omega else []) + (
            [(slice(3, 6), 1.0)] if self.has_attitude else []
        )

    def take(self, which: Any) -> Data:
        """Return these samples alone."""
        return dataclasses.replace(self, t=self.t[which], omega=self.omega[which], attitude=self.attitude[which])


def cut(count: int, length: int) -> tuple[Any, Any]:
    """Return the samples of segments, (S, M), and which of them count: the last segment overlaps the one before."""
    length = min(length, count)
    first = np.minimum(np.arange(0, count, length), count - length)
    index = first[:, None] + np.arange(length)
    new = index >= np.concatenate([[0], first[:-1] + length])[:, None]
    return index, new


@dataclasses.dataclass(eq=False)
class Track:
    """A motion along data: states in segments (S, M, .), the steps' derivatives, and what carries starts on.

    `residual` is data less motion, (S, M, 6). `carried` has six columns for the start of each segment.
    """

    data: Data
    law: Law
    index: Any
    new: Any
    omega: Array
    attitude: Array
    phi: Array
    carried: Array
    residual: Array

    @property
    def length(self) -> int:
        return int(self.index.shape[1])

    @property
    def starts(self) -> State:
        """The states from which steps go, flat."""
        return self.omega[:, :-1].reshape(-1, 3), self.attitude[:, :-1].reshape(-1, 4)

    @property
    def states(self) -> State:
        return self.omega.reshape(-1, 3), self.attitude.reshape(-1, 4)

    @property
    def steps(self) -> tuple[Array, Array]:
        """Times and lengths of the steps, flat."""
        t = self.data.t[self.index]
        return t[:, :-1].ravel(), np.diff(t, axis=1).ravel()

    def flat(self, array: Array) -> Array:
        """Return the entries of all samples in their order, each once."""
        entries: Array = array[self.new]
        return entries

    def deviation(self) -> Array:
        """Residuals with relative rates, (n, 6); those of a channel that was not measured are 0."""
        out = np.zeros((len(self.data.t), 6))
        for part, scale in self.data.channels:
            out[:, part] = self.flat(self.residual)[:, part] / scale
        return out


def carry(phi: Array, forced: Array, start: Array | None = None) -> Array:
    """Return e of e_(k+1) = Phi_k e_k + p_k, shape (S, M, 6, c), from 0 or from `start`."""
    out = np.zeros((forced.shape[0], forced.shape[1] + 1, 6, forced.shape[-1]))
    if start is not None:
        out[:, 0] = start
    for k in range(forced.shape[1]):
        out[:, k + 1] = phi[:, k] @ out[:, k] + forced[:, k]
    return out


def weighted(track: Track, columns: Array, sigma: Array | None = None) -> Array:
    """Return columns (S, M, 6, c) as rows of the measured channels, (S, rows, c); samples that do not count are 0."""
    parts = []
    for number, (part, scale) in enumerate(track.data.channels):
        weight = track.new / (scale * (1.0 if sigma is None else sigma[number]))
        rows = columns[:, :, part] * weight[:, :, None, None]
        parts.append(rows.reshape(len(rows), -1, columns.shape[-1]))
    return np.concatenate(parts, axis=1)


def compact(rows: Array) -> Array:
    """Return few rows with the same products of columns, (S, p, p) of (S, rows, p), by orthogonal factors of blocks.

    Blocks are so small that no threads are started, which cost more than the work.
    """
    width = rows.shape[2]
    block = max(3 * width, 6000 // width)
    while rows.shape[1] > 2 * width:
        count = -(-rows.shape[1] // block)
        filled = np.zeros((len(rows), count * block, width))
        filled[:, : rows.shape[1]] = rows
        parts: Any = np.linalg.qr(filled.reshape(-1, block, width), mode="r")
        rows = parts.reshape(len(rows), -1, width)
        if count == 1:
            break
    return rows


def least_squares(starts: Array, shared: Array, target: Array) -> tuple[Array, Array]:
    """Fit starts (S, rows, 6) of segments and shared columns (S, rows, c) to (S, rows): return both coefficients."""
    count = shared.shape[2]
    small = compact(np.concatenate([starts, shared, target[:, :, None]], axis=2))
    starts, shared, target = small[..., : -1 - count], small[..., -1 - count : -1], small[..., -1]
    u, inverse = basis(starts)
    side = np.concatenate([shared, target[:, :, None]], axis=2)
    inner = np.swapaxes(u, 1, 2) @ side
    rest = side - u @ inner
    rest = rest - u @ (np.swapaxes(u, 1, 2) @ rest)
    flat = rest.reshape(-1, rest.shape[2])
    found = np.zeros(count)
    if count:
        before = np.sqrt(np.sum(shared**2, axis=(0, 1)))
        norm = np.sqrt(np.sum(flat[:, :-1] ** 2, axis=0))
        seen = norm > 1e-9 * before
        if seen.any():
            found[seen] = np.linalg.lstsq(flat[:, :-1][:, seen] / norm[seen], flat[:, -1], rcond=1e-9)[0] / norm[seen]
    right = inner[:, :, -1] - inner[:, :, :-1] @ found
    return (inverse @ right[:, :, None])[:, :, 0], found


def basis(starts: Array) -> tuple[Array, Array]:
    """Return an orthonormal basis of the columns of each segment, and what makes their coefficients of its own.

    Directions that the data do not show have a zero column.
    """
    size = np.sqrt(np.sum(starts**2, axis=1, keepdims=True))
    size[size == 0] = 1.0
    u, s, v = np.linalg.svd(starts / size, full_matrices=False)
    shown = s > 1e-11 * s[:, :1]
    inverse = np.swapaxes(v, 1, 2) * np.where(shown, 1 / np.where(shown, s, 1.0), 0.0)[:, None, :]
    return u * shown[:, None, :], inverse / np.swapaxes(size, 1, 2)


OVER = 1e100  # of derivatives whose squares are summed
NEAR = 1e-5  # a change of states that leaves the derivatives of the steps as they are


def fit(data: Data, law: Law, length: int, rounds: int = 6) -> Track:
    """Fit the start of each segment of `length` samples to the data, without any cause."""
    index, new = cut(len(data.t), length)
    none = np.zeros(0)
    track = Track(data, law, index, new, data.omega[index], data.attitude[index], none, none, none)
    identity = np.broadcast_to(np.eye(6), (len(index), 6, 6))
    shape = (len(index), index.shape[1] - 1)
    seen = data.omega[index], data.attitude[index]
    last = np.inf
    for _ in range(rounds):
        t, dt = track.steps
        if last > NEAR:
            end, phi = law.slopes(t, dt, track.starts)
            track.phi = phi.reshape(*shape, 6, 6)
        else:
            end = law.flow(t, dt, track.starts)
        goal = track.omega[:, 1:].reshape(-1, 3), track.attitude[:, 1:].reshape(-1, 4)
        defect = difference(goal, end).reshape(*shape, 6, 1)
        forced = np.concatenate([np.zeros((*shape, 6, 6)), defect], axis=3)
        with np.errstate(over="ignore", invalid="ignore"):
            both = carry(track.phi, forced, np.concatenate([identity, np.zeros((len(index), 6, 1))], axis=2))
        if not np.max(np.abs(both), initial=0.0) < OVER:
            if last < np.inf:
                break
            track.carried, track.residual = np.zeros_like(both[..., :6]), np.full(both.shape[:-1], np.pi)
            return track     # not near the data at all
        track.carried, own = both[..., :6], both[..., 6:]
        residual = difference((track.omega, track.attitude), seen)[..., None] - own
        rows = weighted(track, track.carried)
        start, _ = least_squares(rows, np.zeros((*rows.shape[:2], 0)), weighted(track, residual)[..., 0])
        change = (track.carried @ start[:, None, :, None] + own)[..., 0]
        if not np.all(np.isfinite(change)):
            break
        angle = np.linalg.norm(change[..., 3:], axis=-1, keepdims=True)
        track.omega, track.attitude = displace(
            (track.omega, track.attitude), change * np.minimum(1.0, 1.0 / np.maximum(1e-300, angle))
        )
        size = max(rms(change[..., :3]) / data.scale, rms(change[..., 3:]))
        if size < 1e-13 or (size < 1e-9 and size > 0.3 * last):
            break
        last = size
    track.residual = difference((track.omega, track.attitude), seen)
    return track
