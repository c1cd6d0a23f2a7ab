"""States of samples that have one channel alone, and a body that was not given."""

from __future__ import annotations

import math

import numpy as np

from .. import measured
from .._core import InertiaTensor
from .._sensitivity.fit import fit as fit_body
from .conventions import rates_between
from .findings import Finding
from .law import Law
from .laws import Variant, choose
from .read import Samples
from .shooting import Data, Track
from .states import Array, conjugate, difference, exponential, multiply, rms, to_body

MOST_FITTED, MOST_FOLLOWED = 300, 100
NEAR = 0.05  # of the rates, and rad


def to_data(samples: Samples) -> Data:
    """Return states: rates from attitudes, or attitudes from rates, where the other was not given."""
    t = samples.t
    if samples.omega is None:
        assert samples.attitude is not None
        mean = rates_between(samples.attitude[:-1], samples.attitude[1:], np.diff(t), False)
        middle = 0.5 * (t[1:] + t[:-1])
        omega = np.stack([np.interp(t, middle, mean[:, k]) for k in range(3)], axis=1)
        return Data(t, omega, samples.attitude, has_omega=False)
    if samples.attitude is None:
        steps = exponential(0.5 * (samples.omega[1:] + samples.omega[:-1]) * np.diff(t)[:, None])
        attitude = products(np.concatenate([[[0.0, 0.0, 0.0, 1.0]], steps]))
        return Data(t, samples.omega, attitude, has_attitude=False)
    return Data(t, samples.omega, samples.attitude)


def products(steps: Array) -> Array:
    """Return the products of the first one, two, three ... rotations: in blocks, and then of whole blocks."""
    count = len(steps)
    width = max(1, int(math.sqrt(count)))
    rows = -(-count // width)
    padded = np.concatenate([steps, np.tile([0.0, 0.0, 0.0, 1.0], (rows * width - count, 1))])
    blocks = padded.reshape(rows, width, 4)
    for k in range(1, width):
        blocks[:, k] = multiply(blocks[:, k - 1], blocks[:, k])
    for k in range(1, rows):
        blocks[k] = multiply(blocks[k - 1, -1], blocks[k])
    out: Array = blocks.reshape(-1, 4)[:count]
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    return out


def follows(samples: Samples, law: Law) -> bool:
    """Return True if the law takes samples to the next ones as they are declared, at any distance."""
    assert samples.omega is not None and samples.attitude is not None
    omega = to_body(samples.attitude, samples.omega) if samples.space else samples.omega
    first = np.unique(np.linspace(0, len(samples.t) - 2, MOST_FOLLOWED).astype(int))
    start, goal = ((omega[k], samples.attitude[k]) for k in (first, first + 1))
    gap = difference(law.flow(samples.t[first], samples.t[first + 1] - samples.t[first], start), goal)
    return bool(
        np.median(np.linalg.norm(gap[:, :3], axis=1)) < NEAR * rms(omega)
        and np.median(np.linalg.norm(gap[:, 3:], axis=1)) < NEAR
    )


def fitted_body(data: Data) -> Array:
    """Fit ratios of moments and the principal axes of a free body, and return its tensor."""
    thin = data.take(slice(None, None, max(1, len(data.t) // MOST_FITTED)))
    t = thin.t - thin.t[0]
    given: list[measured.Measurement] = []
    if data.has_omega:
        given.append(measured.Rates(t, thin.omega, 1e-3 * data.scale))
    if data.has_attitude:
        given.append(measured.Attitudes(t, thin.attitude, 1e-3))
    groups = ("omega", "attitude", "inertia", "axes") if data.has_attitude else ("omega", "inertia", "axes")
    inertia = fit_body(given if len(given) > 1 else given[0], fit=groups).inertia
    matrix: Array = inertia.matrix if isinstance(inertia, InertiaTensor) else np.diag(inertia)
    return matrix


def read_again(data: Data, law: Law, track: Track) -> tuple[Finding, Data, Track, Variant | None] | None:
    """Try the other readings of attitudes alone; return the one that a body obeys much better, or None."""
    best, found = (track.length, -rms(track.deviation())), None
    for cause, text, attitude in (
        ("conjugate", "attitudes take space to body: the reverse rotation", conjugate(data.attitude)),
        ("scalar order", "the scalar stands at the other end of the four numbers", np.roll(data.attitude, -1, axis=1)),
        ("scalar order", "the scalar stands at the other end of the four numbers", np.roll(data.attitude, 1, axis=1)),
    ):
        other = to_data(Samples(data.t, None, attitude))
        kind, trial = choose(other, law)
        value = (trial.length, -rms(trial.deviation()))
        if value[0] > best[0] or value[0] == best[0] and value[1] > math.exp(-1.5) * best[1]:
            best, found = value, (Finding(cause, text, effect=0.5), other, trial, kind)
    return found
