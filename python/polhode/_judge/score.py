"""The score of causes: how much each explains of what a motion leaves of the data, in nats."""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from .causes import Cause, Scope, pattern
from .shooting import Track, basis, carry, compact, least_squares
from .states import Array


@dataclasses.dataclass(eq=False)
class Score:
    """A cause with its numbers, its log-likelihood, what it leaves of each channel, and the errors of its numbers."""

    cause: Cause | None
    c: Array
    likelihood: float
    rest: tuple[float, ...]
    sigma: Array
    refined: bool = False
    track: Track | None = None
    held: int = 0  # substeps of a method in a sample

    gain: float = 0.0


Numbers = tuple[float, ...]


def likelihood(rest: Numbers, floor: Numbers, rows: int, count: int, sigma: Numbers | None) -> float:
    """Return the log-likelihood of residuals with a mean square of `rest` in each channel of `rows` numbers."""
    if sigma is not None:
        total = sum(-0.5 * rows * r / (s * s + f * f) for r, s, f in zip(rest, sigma, floor, strict=True))
    else:
        total = sum(-0.5 * rows * math.log(r + f * f) for r, f in zip(rest, floor, strict=True))
    return total - 0.5 * count * math.log(2 * rows)


def compress(track: Track, columns: Array) -> list[Array]:
    """Return the rows of each channel, (S, rows, c), by orthogonal factors where these are fewer."""
    weight = track.new[:, :, None, None]
    return [
        compact((columns[:, :, part] * weight / scale).reshape(len(columns), -1, columns.shape[-1]))
        for part, scale in track.data.channels
    ]


@dataclasses.dataclass(frozen=True, eq=False)
class Rated:
    """A weighted fit: log-likelihood, mean squares left, shared coefficients with errors, and the starts' changes."""

    likelihood: float
    rest: Numbers
    c: Array
    sigma: Array
    start: Array


def rate(rows: list[Array], floor: Numbers, count: int, sigma: Numbers | None, extra: int = 0) -> Rated:
    """Fit the columns between the six of the start and the last, with the weights of their own residual.

    `extra` numbers count as fitted although they have no column.
    """
    low = np.array(floor)
    weights = np.hypot(sigma, low) if sigma is not None else np.ones(len(rows))
    for _ in range(1 if sigma is not None else 5):
        stacked = np.concatenate([r / w for r, w in zip(rows, weights, strict=True)], axis=1)
        start, c = least_squares(stacked[..., :6], stacked[..., 6:-1], stacked[..., -1])
        left = [r[..., -1] - r[..., 6:-1] @ c - np.einsum("srk,sk->sr", r[..., :6], start) for r in rows]
        rest = tuple(float(np.sum(part * part)) / count for part in left)
        if sigma is None:
            weights = np.maximum(np.sqrt(np.array(rest) + low * low), 1e-300)
    value = likelihood(rest, floor, count, stacked.shape[-1] - 7 + extra, sigma)
    return Rated(
        value, rest, c, _errors(np.concatenate([r / w for r, w in zip(rows, weights, strict=True)], axis=1)), start
    )


def _errors(stacked: Array) -> Array:
    if stacked.shape[-1] == 7:
        return np.zeros(0)
    stacked = compact(stacked)
    u = basis(stacked[..., :6])[0]
    rest = stacked[..., 6:-1] - u @ (np.swapaxes(u, 1, 2) @ stacked[..., 6:-1])
    flat = rest.reshape(-1, rest.shape[-1])
    size = np.linalg.norm(flat, axis=0)
    size[size == 0] = 1e-300
    inverse = np.linalg.pinv(flat / size, rcond=1e-9)
    errors: Array = np.linalg.norm(inverse, axis=1) / size
    return errors


def rank(
    scope: Scope, causes: list[Cause], floor: Numbers, sigma: Numbers | None = None, nuisance: Array | None = None
) -> list[Score]:
    """Score all causes at first order; the first entry is the start alone, the rest are sorted by likelihood.

    `nuisance` are columns (S, M, 6, c) that every cause has beside its own.
    """
    track = scope.track
    pushes, shows = zip(*(pattern(cause, scope) for cause in causes), strict=True) if causes else ((), ())
    widths = [cause.count for cause in causes]
    always = nuisance if nuisance is not None else np.zeros((*track.omega.shape[:2], 6, 0))
    if causes:
        forced = carry(track.phi, np.concatenate(pushes, axis=-1)) + np.concatenate(shows, axis=-1)
    else:
        forced = np.zeros((*track.omega.shape[:2], 6, 0))
    forced[~(np.abs(forced) < 1e60)] = 0.0
    count = 3 * int(track.new.sum())

    def find(which: slice) -> Rated:
        every = [track.carried, always, forced[..., which], track.residual[..., None]]
        return rate(compress(track, np.concatenate(every, axis=-1)), floor, count, sigma)

    first, own, place = find(slice(0, 0)), slice(always.shape[-1], None), 0
    out = [Score(None, np.zeros(0), first.likelihood, first.rest, np.zeros(0), track=track)]
    for cause, width in zip(causes, widths, strict=True):
        found = find(slice(place, place + width))
        place += width
        c = found.c[own]
        if cause.substeps and not 0 < c[0] <= (cause.substeps / 0.8) ** cause.order:
            continue
        out.append(Score(cause, c, found.likelihood, found.rest, found.sigma[own]))
    for score in out:
        score.gain = score.likelihood - first.likelihood
    return [out[0], *sorted(out[1:], key=lambda s: -s.likelihood)]
