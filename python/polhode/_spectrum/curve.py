"""The closed curve of the angular momentum in the body, and the bodies that have it."""

from __future__ import annotations

import dataclasses

import numpy as np

from .._batch.closed_forms import free_motion
from .._core import FreeMotion, InertiaTensor, InvalidInput
from .scan import Array

PHASES = 64
SLACK = 1.02    # of the triangle inequality: noise may break it
LEAST = 1e-6    # of the second moments of mass, over the largest


@dataclasses.dataclass(frozen=True)
class Curve:
    """m / L over one period of the nutation, in principal axes (a, b, c) with c encircled and m_c > 0.

    `u` and `v` are g_a - g_c and g_b - g_c of g = L / I, for which the motion of m has the frequency `nu` exactly.
    `start` is m at the phase 0, and `precession` is 2 kappa - g_c (docs/exact.md).
    """

    nu: float
    u: float
    v: float
    start: Array
    precession: float

    def bodies(self, kappa2: Array) -> tuple[Array, Array]:
        """Return (moments, omega) at the phase 0 of the bodies with such values of 2 kappa; L = 1 for the moments."""
        g = (kappa2 - self.precession)[:, None] + np.array([self.u, self.v, 0.0])
        g = g[(np.abs(np.sign(g).sum(axis=1)) == 3)]      # where all are negative, L was taken the other way round
        moments = 1 / np.abs(g)
        possible = 2 * moments.max(axis=1) <= SLACK * moments.sum(axis=1)
        seconds = 0.5 * moments[possible].sum(axis=1, keepdims=True) - moments[possible]
        seconds = np.maximum(seconds, LEAST * seconds.max(axis=1, keepdims=True))
        return seconds.sum(axis=1, keepdims=True) - seconds, g[possible] * self.start


def make_curve(m: Array, nu: float) -> Curve | None:
    """Return the curve from m at even phases of one period, (PHASES, 3), or None where no body has it."""
    m = m / np.linalg.norm(m, axis=1, keepdims=True)
    # dm/dt = m x g m: (-v m_b m_c, u m_a m_c, (v - u) m_a m_b)
    rate = nu * derivative(m)
    a, b, c = m.T
    zero = np.zeros_like(a)
    columns = np.stack([np.concatenate([zero, a * c, -a * b]), np.concatenate([-b * c, zero, a * b])], axis=1)
    u, v = np.linalg.lstsq(columns, rate.T.ravel(), rcond=None)[0]
    if not u * v > 0:
        return None
    large = 10 * max(abs(u), abs(v))
    g = large + np.array([u, v, 0.0])
    try:
        motion = FreeMotion(InertiaTensor.from_moments(1 / g, physical=False), g * m[0])
        period = abs(motion.period)
    except InvalidInput:
        return None
    if not 0 < period < np.inf:
        return None
    factor = nu * period / (2 * np.pi)                # (f u, f v) has the frequency f nu
    exact = motion.at(period * np.arange(PHASES) / PHASES)[0] / g
    bend = ((u * exact[:, 0] ** 2 + v * exact[:, 1] ** 2) / (1 + exact[:, 2])).mean()
    return Curve(nu, factor * u, factor * v, m[0], factor * bend)


def derivative(m: Array) -> Array:
    """Return d m / d phase of a curve at even phases, by its Fourier series."""
    order = np.fft.fftfreq(PHASES, 1 / PHASES)
    order[PHASES // 2] = 0
    out: Array = np.fft.ifft(1j * order[:, None] * np.fft.fft(m, axis=0), axis=0).real
    return out


def orders(top: int, bias: bool = False) -> tuple[list[int], list[int]]:
    """Return the even harmonics up to `top`, and the odd ones below it; with a bias a constant beside them."""
    return list(range(0, top + 1, 2)), [*([0] if bias else []), *range(1, top, 2)]


def fourier(phase: Array, kinds: list[int]) -> Array:
    """Return cosines and sines of the harmonics as columns; 0 is the constant."""
    return np.stack([part(k * phase) for k in kinds for part in ((np.cos, np.sin) if k else (np.cos,))], axis=-1)


def carried(moments: Array, omega: Array, t: float) -> Array:
    """Return omega of free bodies after a time."""
    if not len(moments):
        return omega
    return np.asarray(free_motion(moments, omega, (0, 0, 0, 1), np.array(t), want="omega"))
