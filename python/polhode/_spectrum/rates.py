"""Bodies from sparse rates: the nutation's frequency by what its harmonics leave, then Euler's equations on the curve.

The rate about the encircled axis has the even harmonics of the nutation, the two others the odd ones. The curve of
omega over one period then gives the three numbers (I_b - I_c) / I_a of Euler's equations by least squares.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .._core import FreeMotion, InertiaTensor, InvalidInput
from ..measured import Rates
from .curve import PHASES, carried, derivative, fourier, orders
from .scan import BLOCK, Array, grid, peaks, project, refine

NUTATIONS = 24    # minima that are followed
PART = 0.5        # of the median of what is left: other minima are none


def _left(t: Array, y: Array, weight: Array, nu: Array, top: int, bias: bool) -> Array:
    zero = np.zeros(1)
    even, odd = (project(t, y, weight, [(0, k) for k in kind], zero, nu)[0, :, :, 0, 0] for kind in orders(top, bias))
    out: Array = (y * y).sum() - (odd.sum(axis=1, keepdims=True) + even - odd)
    return out


def candidates(data: Rates, low: float, top: int) -> Iterator[tuple[float, Array, Array]]:
    """Give (chi2 that is left, moments, omega at t = 0) of bodies, one nutation after the other."""
    middle = 0.5 * float(data.t[0] + data.t[-1])
    t, bias = data.t - middle, bool(data.bias)
    weight = np.sqrt(np.mean(np.einsum("nii->ni", data.whitener) ** 2, axis=1))
    y = np.ascontiguousarray(weight[:, None] * data.y)
    trials = grid(t, low, float(np.linalg.norm(data.y, axis=1).max()))   # nu <= |omega| for every body
    step, found, medians = float(trials[1] - trials[0]), [], []
    for first in range(0, trials.size, BLOCK):
        here = trials[first : first + BLOCK + 2]
        rest = _left(t, y, weight, here, top, bias)
        medians.append(np.median(rest))
        found += [(float(rest[k, c]), float(here[k]), c) for c in range(3) for k in peaks(-rest[:, c], NUTATIONS)]
    limit = max(PART * float(np.median(medians)), 3.0 * y.size)
    refined = []
    for _, nu, c in sorted(one for one in found if one[0] <= limit)[:NUTATIONS]:
        nu = refine(lambda f, c=c: -_left(t, y, weight, f, top, bias)[:, c], nu, step)   # type: ignore[misc]
        refined.append((float(_left(t, y, weight, np.array([nu]), top, bias)[0, c]), nu, c))
    for left, nu, c in sorted(refined):
        axes = [(c + 1) % 3, (c + 2) % 3, c]
        curve = np.empty((PHASES, 3))
        for place, axis in enumerate(axes):
            kind = orders(top, bias)[0 if axis == c else 1]
            A = fourier(nu * t, kind)
            fitted = np.linalg.lstsq(weight[:, None] * A, y[:, axis], rcond=None)[0]
            if bias and axis != c:
                fitted[0] = 0.0
            curve[:, place] = fourier(2 * np.pi * np.arange(PHASES) / PHASES, kind) @ fitted
        body = _body(curve, nu)
        if body is not None:
            moments, omega = body
            back = np.argsort(axes)
            yield left, moments[None, back], carried(moments[None], omega[None], -middle)[:, back]


def _body(omega: Array, nu: float) -> tuple[Array, Array] | None:
    """Return (moments, omega at the phase 0) of a body with this curve of omega, and this frequency exactly."""
    rate = nu * derivative(omega)
    products = omega[:, [1, 2, 0]] * omega[:, [2, 0, 1]]
    weight = (products**2).sum(axis=0)
    if not (weight > 0).all():
        return None
    shares = np.clip((rate * products).sum(axis=0) / weight, -0.99, 0.99)   # (I_b - I_c) / I_a, and so on
    logs = -2 * np.arctanh(shares)     # log(P_b / P_c), log(P_c / P_a), log(P_a / P_b): their sum is 0
    spread = 1 / (weight * (1 - shares**2) ** 2)
    logs = logs - logs.sum() * spread / spread.sum()
    P = np.exp(np.array([logs[2], 0.0, -logs[0]]))
    moments = P.sum() - P
    try:
        period = abs(FreeMotion(InertiaTensor.from_moments(moments, physical=False), omega[0]).period)
    except InvalidInput:
        return None
    factor = nu * period / (2 * np.pi)
    return (moments, factor * omega[0]) if 0.2 < factor < 5 else None
