"""Bodies from sparse attitudes: the nutation's frequency by a 3 x 3 eigenvalue, then that of the precession.

The direction l of the angular momentum is constant in space, so R^T l is periodic in the body. Its component along the
encircled axis has the even harmonics of the nutation alone (dn), the two others the odd ones (cn and sn). A sum of
squares of what these harmonics leave is a quadratic form in l. Its least eigenvalue shows whether a trial frequency is
right, whatever the phase, the body and the precession are.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator

import numpy as np

from .._sensitivity import rotations
from ..measured import Attitudes
from .curve import PHASES, Curve, carried, fourier, make_curve, orders
from .scan import BLOCK, Array, grid, largest_eigenvalue, peaks, periodogram, project, refine

HARMONICS = (4, 8)      # the highest even one; the odd ones go to one below. The second: near the separatrix.
NUTATIONS = 6           # minima that are followed
PART = 0.3              # of the median of what is left: other minima are none
PRECESSIONS = 8         # maxima for each of them


@dataclasses.dataclass(frozen=True)
class Samples:
    """Attitudes about the middle of their times: X (n, 9) with X_a at 3 a, weights, and the matrices (n, 3, 3)."""

    t: Array
    middle: float
    X: Array
    weight: Array
    R: Array
    variance: float   # of the noise, where the weight is 1


def samples_of(data: Attitudes) -> Samples:
    """Return the samples about the middle of their times."""
    middle = 0.5 * float(data.t[0] + data.t[-1])
    weight = np.sqrt(np.mean(np.einsum("nii->ni", data.whitener) ** 2, axis=1))
    variance = 1 / float(np.mean(weight**2))
    weight = weight * variance**0.5
    R = rotations.to_matrix(data.y)
    X = weight[:, None] * R.transpose(0, 2, 1).reshape(-1, 9)   # component a of R^T l is sum_j R_ja l_j
    return Samples(data.t - middle, middle, np.ascontiguousarray(X), weight, R, variance)


def _left(samples: Samples, nu: Array, top: int) -> Array:
    """Return what the harmonics leave of the best l for each trial, for each axis that may be encircled: (n, 3)."""
    zero = np.zeros(1)
    even, odd = (project(samples.t, samples.X, samples.weight, [(0, k) for k in kind], zero, nu, 3)[0]
                 for kind in orders(top))
    taken = odd.sum(axis=1, keepdims=True) + even - odd
    out: Array = len(samples.t) - largest_eigenvalue(taken)
    return out


def nutations(samples: Samples, low: float, high: float, top: int) -> list[tuple[float, float, int]]:
    """Return (what is left, nu, encircled axis) of the deepest minima between two rates."""
    found, medians = [], []
    trials = grid(samples.t, low, high)
    step = float(trials[1] - trials[0])
    for first in range(0, trials.size, BLOCK):
        here = trials[first : first + BLOCK + 2]
        if here.size < 2:
            continue
        left = _left(samples, here, top)
        medians.append(np.median(left))
        for c in range(3):
            for k in peaks(-left[:, c], NUTATIONS):
                found.append((float(left[k, c]), float(here[k]), c))
    limit = max(PART * float(np.median(medians)), 3 * samples.variance * len(samples.t))
    found = sorted(one for one in found if one[0] <= limit)
    refined = []
    for _, nu, c in found[:NUTATIONS]:
        nu = refine(lambda f, c=c: -_left(samples, f, top)[:, c], nu, step)   # type: ignore[misc]
        refined.append((float(_left(samples, np.array([nu]), top)[0, c]), nu, c))
    return sorted(refined)


def curve_of(samples: Samples, nu: float, c: int, top: int) -> tuple[Array, Curve, tuple[int, int, int]] | None:
    """Return (l, the curve in the axes (a, b, c), these axes) of a frequency, or None where no body has it."""
    kinds = orders(top)
    axes = ((c + 1) % 3, (c + 2) % 3, c)
    columns = [samples.weight[:, None] * fourier(nu * samples.t, kind) for kind in kinds]
    M = np.zeros((3, 3))
    for axis in axes:
        X, A = samples.X[:, 3 * axis : 3 * axis + 3], columns[0 if axis == c else 1]
        M += X.T @ (X - A @ np.linalg.lstsq(A, X, rcond=None)[0])
    l = np.linalg.eigh(M)[1][:, 0]
    phases = 2 * np.pi * np.arange(PHASES) / PHASES
    m = np.empty((PHASES, 3))
    for place, axis in enumerate(axes):
        kind = 0 if axis == c else 1
        found = np.linalg.lstsq(columns[kind], samples.X[:, 3 * axis : 3 * axis + 3] @ l, rcond=None)[0]
        m[:, place] = fourier(phases, kinds[kind]) @ found
    if m[:, 2].mean() < 0:
        l, m = -l, -m
    curve = make_curve(m, nu)
    return None if curve is None else (l, curve, axes)


def precessions(samples: Samples, l: Array, curve: Curve, axes: tuple[int, int, int], fastest: float) -> Array:
    """Return values of 2 kappa, the likely ones first: it is a line of the squares of Cayley's and Klein's numbers."""
    third = l
    first = np.cross(third, np.eye(3)[int(np.argmin(np.abs(third)))])
    first /= np.linalg.norm(first)
    Q = np.stack([first, np.cross(third, first), third]) @ samples.R[:, :, axes]
    # (w + iz)^2 and (x + iy)^2 from the matrix: the sign of a quaternion does not matter.
    alpha2 = 0.5 * (Q[:, 0, 0] + Q[:, 1, 1] + 1j * (Q[:, 1, 0] - Q[:, 0, 1]))
    beta2 = 0.5 * (Q[:, 0, 0] - Q[:, 1, 1] + 1j * (Q[:, 1, 0] + Q[:, 0, 1]))
    nu, t = curve.nu, samples.t
    shifts = samples.weight[:, None] * np.exp(1j * np.outer(t, [0, 2 * nu, -2 * nu]))
    basis = np.linalg.qr(shifts)[0].conj()
    z = samples.weight[:, None] * np.stack([alpha2, beta2], axis=1)
    series = (basis[:, :, None] * z[:, None, :]).reshape(t.size, -1)
    trials = grid(t, -2 * fastest, 2 * fastest)
    step = float(trials[1] - trials[0])
    found = [refine(lambda f: periodogram(t, series, f), float(trials[k]), step)
             for k in peaks(periodogram(t, series, trials), PRECESSIONS)]
    out: Array = (np.array(found)[:, None] + np.array([0, 2 * nu, -2 * nu])).ravel()
    return out


def candidates(data: Attitudes, low: float, fastest: float, top: int) -> Iterator[tuple[float, Array, Array]]:
    """Give (chi2 that is left, moments, omega at t = 0) of bodies, one nutation after the other, up to a rate."""
    samples = samples_of(data)
    for left, nu, c in nutations(samples, low, fastest, top):
        found = curve_of(samples, nu, c, top)
        if found is None:
            continue
        l, curve, axes = found
        moments, omega = curve.bodies(precessions(samples, l, curve, axes, fastest))
        back = np.argsort(axes)
        yield left / samples.variance, moments[:, back], carried(moments, omega, -samples.middle)[:, back]
