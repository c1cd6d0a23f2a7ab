"""Bodies from one space vector seen in the body: the nutation's frequency by lines, then shapes of a table by sums.

In the frame of the angular momentum the attitude is a turn by 2 kappa t and a periodic part. So the component of the
vector along the encircled axis has the lines j nu with j even and 2 kappa + j nu with j odd, the two others have j odd
and j even. The harmonics alone show nu where the vector has a part along the momentum; lines beside the highest one
show it where it has a part across. For a body of the table the best vector is a sum over the samples. Fourier series of
the table give these sums for all phases at once.
"""

from __future__ import annotations

import functools
import itertools
from collections.abc import Iterator
from functools import partial

import numpy as np

from .._sensitivity import rotations
from ..measured import Direction
from .attitudes import HARMONICS
from .curve import carried, orders
from .scan import BLOCK, Array, grid, peaks, periodogram, project, refine
from .shapes import Shapes, attitudes_of, relabelled, table, variants
from .zoom import NEAR, Complex, Sums, series_of, zoom

NUTATIONS = 4      # maxima of each kind that are followed
ALONG = 0.85       # of the median of what is left by harmonics: other minima are none
BESIDE = 0.7       # the same beside a line
EACH = 2           # maxima beside each line
HIGHEST = 2        # lines of each component
GRID = (10, 6)     # angles and moduli of the shapes
CELLS = 6          # of the table that are looked into


Owner = tuple[int, tuple[int, ...], Array]


def _rows(shapes: Shapes, back: Array) -> tuple[Complex, Complex]:
    """Return the series of the body axes across the momentum, x + i y, and along it, (bodies, 2 TOP + 1, 3) each."""
    R = rotations.to_matrix(rotations.product(attitudes_of(shapes, slice(None), slice(None)), back))
    return series_of(R[:, :, 0] + 1j * R[:, :, 1]), series_of(R[:, :, 2])


@functools.cache
def _series(c: int) -> tuple[list[Owner], Complex, Complex]:
    """Return (shape, order, rotation to the table's axes) of bodies that encircle axis c, and their series."""
    shapes = table(*GRID)
    owners: list[Owner] = []
    rows = []
    for order, flip in variants():
        if order[2] == c:
            back = relabelled(order, flip)
            rows.append(_rows(shapes, back))
            owners += [(k, order, back) for k in range(len(shapes.u))]
    across, along = (np.concatenate(part) for part in zip(*rows, strict=True))
    return owners, across, along


def _from_harmonics(t: Array, X: Array, weight: Array, trials: Array, top: int) -> list[tuple[float, float, int]]:
    """Return (what is taken, nu, encircled axis) by the harmonics of nu alone."""
    kinds, zero = orders(top), np.zeros(1)

    def taken(nu: Array) -> Array:
        even, odd = (project(t, X, weight, [(0, k) for k in kind], zero, nu)[0, :, :, 0, 0] for kind in kinds)
        return np.asarray(odd.sum(axis=1, keepdims=True) + even - odd)

    power = np.concatenate([taken(trials[first : first + BLOCK]) for first in range(0, trials.size, BLOCK)])
    step, found, square = float(trials[1] - trials[0]), [], float((X * X).sum())
    limit = square - ALONG * (square - float(np.median(power)))
    for c in range(3):
        for k in peaks(power[:, c], NUTATIONS):
            if power[k, c] < limit:
                break
            nu = refine(lambda f, c=c: taken(f)[:, c], float(trials[k]), step)   # type: ignore[misc]
            found.append((float(taken(np.array([nu]))[0, c]), nu, c))
    return sorted(found, reverse=True)[:NUTATIONS]


def highest(t: Array, X: Array, high: float) -> list[tuple[float, int]]:
    """Return (frequency, component) of the highest lines of each component, without its mean."""
    trials = grid(t, 0.3 / float(np.ptp(t)), high)
    step, found = float(trials[1] - trials[0]), []
    for i in range(3):
        z = np.ascontiguousarray((X[:, i] - X[:, i].mean())[:, None].astype(complex))
        found += [(refine(partial(periodogram, t, z), float(trials[k]), step), i)
                  for k in peaks(periodogram(t, z, trials), HIGHEST)]
    return found


def _beside(t: Array, X: Array, weight: Array, lines: list[tuple[float, int]], trials: Array,
            ) -> list[tuple[float, float, int]]:
    """Return (what is taken, nu, encircled axis) by lines beside the highest ones and low harmonics."""
    step, found, square = float(trials[1] - trials[0]), [], float((X * X).sum())
    same, next_to = [(1, 0), (1, 2), (1, -2)], [(1, 1), (1, -1)]
    for (f, i), c in itertools.product(lines, range(3)):
        others = [k for k in range(3) if k != c]
        parts = [([c], [(0, 0), (0, 2), *(same if i == c else next_to)]),
                 (others, [(0, 1), (0, 3), *(next_to if i == c else same)])]

        def taken(nu: Array, f: float = f, parts: list[tuple[list[int], list[tuple[int, int]]]] = parts) -> Array:
            return np.asarray(sum(project(t, np.ascontiguousarray(X[:, axes]), weight, columns, np.array([f]), nu)
                                  [0, :, :, 0, 0].sum(axis=1) for axes, columns in parts))

        power = taken(trials)
        limit = square - BESIDE * (square - float(np.median(power)))
        for k in peaks(power, EACH):
            if power[k] < limit:
                break
            nu = refine(taken, float(trials[k]), step)
            found.append((float(taken(np.array([nu]))[0]), nu, c))
    return sorted(found, reverse=True)[:NUTATIONS]


def candidates(data: Direction, low: float, fastest: float, top: int) -> Iterator[tuple[float, Array, Array]]:
    """Give (chi2 that is left, moments, omega at t = 0) of bodies, one nutation after the other, up to a rate."""
    middle = 0.5 * float(data.t[0] + data.t[-1])
    t, size = data.t - middle, float(np.linalg.norm(data.known))
    weight = np.sqrt(np.mean(np.einsum("nii->ni", data.whitener) ** 2, axis=1)) * size
    X = np.ascontiguousarray(weight[:, None] * data.y / size)
    square = float((X * X).sum())
    trials = grid(t, low, fastest)
    lines = highest(t, X, 2 * fastest)
    by_lines = _beside(t, X, weight, lines, trials) if top == HARMONICS[0] else []
    by_harmonics = _from_harmonics(t, X, weight, trials, top)
    near = np.array([sign * f for f, _ in lines for sign in (1, -1)])
    for pair in itertools.zip_longest(by_lines, by_harmonics):
        for found in pair:
            if found is not None:
                taken, nu, c = found
                moments, omega = _bodies(t, weight, X, nu, c, near)
                yield square - taken, moments, carried(moments, omega, -middle)


def _join(across: Array, along: Array) -> Array:
    """Return the square of the length of the sum, which the best vector has."""
    return np.asarray(across**2 + along**2)


def _bodies(t: Array, weight: Array, X: Array, nu: float, c: int, near: Array) -> tuple[Array, Array]:
    """Return (moments, omega) at the phase 0 of the bodies with the largest sums."""
    owners, across, along = _series(c)
    shapes, u = table(*GRID), weight[:, None] * X
    sums = Sums(t, u, u, _join)
    kappas = np.unique(np.round((near[:, None] + nu * np.arange(-3, 4)).ravel(), 12))
    shape, zero = np.array([k for k, _, _ in owners]), np.zeros(len(owners), dtype=int)
    found: list[tuple[float, int, float]] = []
    for kappa2 in kappas:
        there = shapes.bodies(shape, zero, nu, np.full(len(shape), kappa2))[2]
        best = sums.met(across[there], along[there], nu, float(kappa2)).max(axis=1, initial=0.0)
        found += [(float(best[k]), int(there[k]), float(kappa2)) for k in np.argsort(-best)[:CELLS]]
    moments, omega = [np.zeros((0, 3))], [np.zeros((0, 3))]
    seen: list[tuple[int, float]] = []
    for score, b, kappa2 in sorted(found, reverse=True):
        if len(seen) == CELLS or score < (NEAR * float((X * X).sum())) ** 2:
            break
        if any(b == other and abs(kappa2 - near_by) * np.ptp(t) < 1 for other, near_by in seen):
            continue
        seen.append((b, kappa2))
        which, order, back = owners[b]
        finer, best_one, phase, kappa2 = zoom(sums, partial(_rows, back=back), nu, kappa2, which, GRID)
        inertia, rate, _ = finer.bodies(np.array([best_one]), np.array([phase]), nu, np.array([kappa2]))
        moments.append(inertia[:, np.argsort(order)])
        omega.append(rotations.rotate(rotations.conjugate(back), rate))
    return np.concatenate(moments), np.concatenate(omega)
