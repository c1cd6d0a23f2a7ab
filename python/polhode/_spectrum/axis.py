"""Bodies from one body axis seen in space: the nutation's frequency by a 3 x 3 eigenvalue, then that of the precession.

The direction l of the angular momentum is constant, so the part of the axis along l has the harmonics of the nutation
alone. They are the even ones for the encircled axis, the odd ones for the two others, and all for any other. A sum of
squares of what these harmonics leave is a quadratic form in l. Its least eigenvalue shows the frequency, whatever the
precession is. Where that part hardly changes, lines beside the highest one across l show it. The curve along l over one
period chooses shapes of a table. Each shape says how the part across l turns, up to one line, 2 kappa.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from functools import partial

import numpy as np
import numpy.typing as npt

from .._sensitivity import rotations
from ..measured import Axis
from .curve import PHASES, carried, fourier
from .scan import BLOCK, Array, grid, largest_eigenvalue, peaks, periodogram, project, refine
from .shapes import attitudes_of, relabelled, table, variants

NUTATIONS = 5      # minima of each kind that are followed
PART = 0.3         # of the median of what is left: other minima are none
GRID = (16, 12)    # angles and moduli of the shapes
SHAPES = 12        # of a minimum
HIGHEST = 2        # lines across l
PRECESSIONS = 3    # of a shape


def _kinds(known: Array, top: int) -> dict[str, list[int]]:
    """Return the harmonics of the part along l: two kinds for a principal axis, else one."""
    if np.count_nonzero(np.abs(known) > 1e-12) == 1:
        return {"encircled": list(range(0, top + 1, 2)), "other": list(range(1, top, 2))}
    return {"any": list(range(top + 1))}


def candidates(data: Axis, low: float, fastest: float, top: int) -> Iterator[tuple[float, Array, Array]]:
    """Give (chi2 that is left, moments, omega at t = 0) of bodies, one nutation after the other, up to a rate."""
    middle = 0.5 * float(data.t[0] + data.t[-1])
    t, size = data.t - middle, float(np.linalg.norm(data.known))
    known = data.known / size
    weight = np.sqrt(np.mean(np.einsum("nii->ni", data.whitener) ** 2, axis=1)) * size
    X = np.ascontiguousarray(weight[:, None] * data.y / size)
    square, zero = X.T @ X, np.zeros(1)
    trials = grid(t, low, fastest)
    step, found = float(trials[1] - trials[0]), []
    for name, orders in _kinds(known, top).items():

        def left(nu: Array, orders: list[int] = orders) -> Array:
            return -largest_eigenvalue(project(t, X, weight, [(0, k) for k in orders], zero, nu, 3)[0, :, 0] - square)

        rest = np.concatenate([left(trials[first : first + BLOCK]) for first in range(0, trials.size, BLOCK)])
        limit = max(PART * float(np.median(rest)), 3.0 * len(t))
        for k in peaks(-rest, NUTATIONS):
            if rest[k] <= limit:
                nu = refine(lambda f: -left(f), float(trials[k]), step)
                found.append((float(left(np.array([nu]))[0]), nu, name, orders))
    found.sort(key=lambda one: one[0])
    others: list[tuple[float, float, str, list[int]]] = []
    for _, nu, name, orders in found:
        if name not in [other[2] for other in others]:
            l = _momentum(t, weight, X, nu, orders)
            others += [(rest, nu, name, orders) for rest, nu in _across(t, weight, X, l, orders, trials)]
    others.sort(key=lambda one: one[0])
    followed = [one for pair in itertools.zip_longest(found, others) for one in pair if one is not None]
    for rest_of, nu, name, orders in followed:
        l = _momentum(t, weight, X, nu, orders)
        A = weight[:, None] * fourier(nu * t, orders)
        along = fourier(2 * np.pi * np.arange(PHASES) / PHASES, orders) @ np.linalg.lstsq(A, X @ l, rcond=None)[0]
        moments, omega = _bodies(t, weight, X, l, along, known, name, nu, trials)
        yield rest_of, moments, carried(moments, omega, -middle)


def _momentum(t: Array, weight: Array, X: Array, nu: float, orders: list[int]) -> Array:
    """Return the direction along which the harmonics leave least."""
    A = weight[:, None] * fourier(nu * t, orders)
    return np.asarray(np.linalg.eigh(X.T @ (X - A @ np.linalg.lstsq(A, X, rcond=None)[0]))[1][:, 0])


def _transverse(t: Array, weight: Array, X: Array, l: Array) -> npt.NDArray[np.complex128]:
    """Return the part across l as complex numbers, times the weight."""
    first = np.cross(l, np.eye(3)[int(np.argmin(np.abs(l)))])
    first /= np.linalg.norm(first)
    return np.asarray(X @ first + 1j * (X @ np.cross(l, first)))


def _highest(t: Array, z: npt.NDArray[np.complex128], trials: Array) -> list[float]:
    """Return the frequencies of the highest lines, of both signs."""
    step, series = float(trials[1] - trials[0]), np.ascontiguousarray(z[:, None])
    f = grid(t, -2 * float(trials[-1]), 2 * float(trials[-1]))
    return [refine(partial(periodogram, t, series), float(f[k]), step)
            for k in peaks(periodogram(t, series, f), HIGHEST)]


def _across(t: Array, weight: Array, X: Array, l: Array, orders: list[int], trials: Array) -> list[tuple[float, float]]:
    """Return (what is left, nu) where the part along l hardly changes: lines beside the highest one across l."""
    z = _transverse(t, weight, X, l)
    step, found = float(trials[1] - trials[0]), []
    beside = [(0, k) for k in ((0, 2) if 1 not in orders or 0 not in orders else (0, 1, 2))]
    for f in _highest(t, weight * z, trials):
        w = z * np.exp(-1j * f * t)
        flat = [np.ascontiguousarray(part) for part in (np.stack([w.real, w.imag], axis=1), (X @ l)[:, None])]

        def left(nu: Array, flat: list[Array] = flat) -> Array:
            taken = sum(project(t, part, weight, lines, np.zeros(1), nu)[0, :, :, 0, 0].sum(axis=1)
                        for part, lines in zip(flat, (beside, [(0, k) for k in orders]), strict=True))
            return np.asarray(sum(float((part * part).sum()) for part in flat) - taken)

        rest = left(trials)
        for k in peaks(-rest, NUTATIONS):
            nu = refine(lambda f: -left(f), float(trials[k]), step)
            found.append((float(left(np.array([nu]))[0]), nu))
    return sorted(found)[:NUTATIONS]


def _bodies(t: Array, weight: Array, X: Array, l: Array, along: Array, known: Array, kind: str, nu: float,
            trials: Array) -> tuple[Array, Array]:
    """Return (moments, omega) at the phase 0."""
    shapes = table(*GRID)
    across = weight * _transverse(t, weight, X, l)
    spectrum = np.fft.fft(along).conj()
    costs, shifts, which, labels = [], [], [], []
    for order, flip in variants():
        back = relabelled(order, flip)
        seen = rotations.rotate(back, known)
        encircled = abs(abs(seen[2]) - 1) < 1e-9
        if (kind == "encircled" and not (encircled and order[0] < order[1])) or (kind == "other" and encircled):
            continue   # about the encircled axis both orders are the same motion
        curve = shapes.m @ seen
        met = np.fft.ifft(spectrum * np.fft.fft(curve, axis=1), axis=1).real
        best = met.argmax(axis=1)
        costs.append((curve**2).sum(axis=1) - 2 * met[np.arange(len(met)), best])
        shifts.append(best)
        which.append(np.arange(len(met)))
        labels += [(order, back)] * len(met)
    cost, shift, shape = (np.concatenate(part) for part in (costs, shifts, which))
    moments, omega = [np.zeros((0, 3))], [np.zeros((0, 3))]
    step = float(trials[1] - trials[0])
    lines = np.array(_highest(t, across, trials))
    near = (lines[:, None] + nu * np.arange(-3, 4)).ravel()
    phase = nu * t / (2 * np.pi) * PHASES
    for k in np.argsort(cost, kind="stable")[:SHAPES]:
        order, back = labels[k]
        seen = rotations.rotate(attitudes_of(shapes, shape[k : k + 1], slice(None))[0], rotations.rotate(back, known))
        here = (phase + shift[k]) % PHASES
        low = here.astype(int) % PHASES
        part = (here - low)[:, None]
        seen = (1 - part) * seen[low] + part * seen[(low + 1) % PHASES]
        line = np.ascontiguousarray((across * (seen[:, 0] - 1j * seen[:, 1]))[:, None])
        power = np.concatenate([periodogram(t, line, np.array([f])) for f in near])
        best = np.argsort(-power, kind="stable")[:PRECESSIONS]
        kappa2 = np.array([refine(partial(periodogram, t, line), float(f), step) for f in near[best]])
        same = np.full(len(kappa2), shape[k])
        inertia, rate, _ = shapes.bodies(same, np.full(len(kappa2), shift[k]), nu, kappa2)
        moments.append(inertia[:, np.argsort(order)])
        omega.append(rotations.rotate(rotations.conjugate(back), rate))
    return np.concatenate(moments), np.concatenate(omega)
