"""The faulty model itself: start and numbers of one cause are fitted, with the cause's own steps at any size."""

from __future__ import annotations

import dataclasses

import numpy as np

from .causes import Cause, Scope, slopes
from .score import Numbers, Rated, Score, compress, rate
from .shooting import carry
from .states import Array, difference, displace, rms

MOST_SUBSTEPS = 48
SETTLED = 1e-3  # of what is left: a smaller change moves no likelihood by a hundredth of a nat


def refine(first: Scope, score: Score, floor: Numbers, sigma: Numbers | None = None, rounds: int = 8) -> Score:
    """Return the score of the exact faulty model; that of the first order where it cannot be run."""
    cause = score.cause
    assert cause is not None
    if not cause.substeps:
        return _run(first, cause, score.c, floor, sigma, rounds, 0) or score
    wanted = cause.substeps / score.c[0] ** (1 / cause.order)
    counts = sorted({max(1, int(np.floor(wanted))), max(1, int(np.ceil(wanted)))})
    done = [found for count in counts if (found := _run(first, cause, np.zeros(0), floor, sigma, rounds, count))]
    return max(done, key=lambda s: s.likelihood, default=score)


def _run(
    first: Scope, cause: Cause, c: Array, floor: Numbers, sigma: Numbers | None, rounds: int, held: int
) -> Score | None:
    track = first.track
    now = dataclasses.replace(track)
    segments, length = now.index.shape
    seen = now.data.omega[now.index], now.data.attitude[now.index]
    count, last, phi, carried = 3 * int(now.new.sum()), np.inf, track.phi, track.carried
    found: Rated | None = None
    c = c.copy()
    for number in range(rounds):
        scope = Scope(now) if number else first
        if held:
            run = min(held, MOST_SUBSTEPS)
            push = (
                cause.push(scope, np.array([run])) * (run / held) ** cause.order
                if cause.push
                else np.zeros((len(scope.t), 6))
            )
            d_push, d_show = np.zeros((segments, length - 1, 6, 0)), np.zeros((segments, length, 6, 0))
        else:
            push = cause.push(scope, c) if cause.push else np.zeros((len(scope.t), 6))
            d_push, d_show = slopes(cause, scope, c)
        shown = cause.show(scope, c) if cause.show and not held else np.zeros((segments, length, 6))
        if not (np.all(np.isfinite(push)) and np.all(np.isfinite(shown)) and np.all(np.isfinite(d_push))):
            return None
        end = displace(scope.end, push)
        goal = now.omega[:, 1:].reshape(-1, 3), now.attitude[:, 1:].reshape(-1, 4)
        forced = np.concatenate([d_push, difference(goal, end).reshape(segments, length - 1, 6, 1)], axis=-1)
        both = carry(phi, forced)
        columns, own = both[..., :-1] + d_show, both[..., -1:]
        output = displace((now.omega, now.attitude), shown)
        residual = difference(output, seen)[..., None] - own
        rows = compress(now, np.concatenate([carried, columns, residual], axis=-1))
        found = rate(rows, floor, count, sigma, extra=1 if held else 0)
        change = (carried @ found.start[:, None, :, None] + both[..., :-1] @ found.c[:, None] + own)[..., 0]
        c = c + found.c
        angle = np.linalg.norm(change[..., 3:], axis=-1, keepdims=True)
        now.omega, now.attitude = displace(
            (now.omega, now.attitude), change * np.minimum(1, 1 / np.maximum(1e-300, angle))
        )
        size = max(rms(change[..., :3]) / now.data.scale, rms(change[..., 3:]))
        if not np.isfinite(size) or size > 10:
            return None
        if size < max(1e-13, SETTLED * min(found.rest) ** 0.5) or (size < 1e-9 and size > 0.3 * last):
            break
        if size > 1e-2:
            phi = now.law.slopes(*now.steps, now.starts)[1].reshape(segments, length - 1, 6, 6)
            identity = np.broadcast_to(np.eye(6), (segments, 6, 6))
            carried = carry(phi, np.zeros((segments, length - 1, 6, 6)), identity)
        last = size
    assert found is not None
    shown = cause.show(Scope(now), c) if cause.show and not held else np.zeros((segments, length, 6))
    now.residual = difference(displace((now.omega, now.attitude), shown), seen)
    now.phi, now.carried = phi, carried
    return Score(cause, c, found.likelihood, found.rest, found.sigma, True, now, held)
