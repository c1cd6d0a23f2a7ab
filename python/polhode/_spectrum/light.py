"""Bodies from one number a sample, as a light curve: two frequencies, then shapes of a table by quadratic functions.

A number that depends on the squares of the body's axes has the lines a sigma + j mu with mu = 2 nu, sigma = 2 kappa +
nu and a = 0, 1, 2. The highest lines, each as one of these, leave one frequency to scan. Then the function of the
attitude is replaced by the nearest quadratic one of the body axes. That gives the best attitude of a curve of the table
by linear algebra.
"""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable

import numpy as np

from .. import _core
from .._sensitivity import rotations
from ..measured import Brightness, Scalar
from .curve import PHASES
from .scan import Array, grid, peaks, project, refine
from .shapes import attitudes_of, relabelled, table

HIGHEST = 6        # lines that are tried
EACH = 3           # maxima of a scan
PAIRS = 16         # of frequencies that are followed
SLOWEST = 2.0      # over the span: slower lines are not separated
ABOVE = 1.3        # the highest line: beyond it are no frequencies
SAME = 0.3         # over the span: such frequencies are the same
APART = 1.0        # over the span: pairs nearer than that are one
GRID = (8, 5)      # angles and moduli of the shapes
SHIFTS = 8         # phases of the nutation, over half a period
ATTITUDES = 500    # of the momentum's frame
THIN = 150         # samples that choose the shapes, about
RANDOM = 1500      # attitudes that give the quadratic function
LEFT = 0.35        # of the variance of a function, beyond a quadratic one: it is none of this kind then
LINES = [(0, 0), (0, 1), (0, 2), *((a, j) for a in (1, 2) for j in range(-2, 3))]


Order = tuple[int, ...]


def uniform_attitudes(count: int) -> Array:
    """Return unit quaternions on super-Fibonacci spirals (Alexa 2022), evenly over all rotations."""
    s = np.arange(count) + 0.5
    r, R = np.sqrt(s / count), np.sqrt(1 - s / count)
    a, b = 2 * np.pi * s / 2**0.5, 2 * np.pi * s / 1.533751168755204288118041
    return np.stack([r * np.sin(a), r * np.cos(a), R * np.sin(b), R * np.cos(b)], axis=1)


def _columns(R: Array) -> Array:
    """Return the constant and the quadratic functions of the first two body axes, (n, 11)."""
    out = [np.ones(len(R))]
    for axis in range(2):
        x, y, z = R[:, :, axis].T
        out += [x * x - z * z, y * y - z * z, 2 * x * y, 2 * x * z, 2 * y * z]
    return np.stack(out, axis=1)


def _matrices(numbers: Array) -> Array:
    a, b, xy, xz, yz = numbers
    return np.array([[a, xy, xz], [xy, b, yz], [xz, yz, -a - b]])


def quadratic(fun: Callable[[Array], Array]) -> tuple[Array, float]:
    """Return the quadratic function nearest to a function of the attitude, (11,), and the part of it that is left."""
    q = np.random.default_rng(0).normal(size=(RANDOM, 4))
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    y, A = fun(q), _columns(rotations.to_matrix(q))
    found = np.asarray(np.linalg.lstsq(A, y, rcond=None)[0], dtype=float)
    left = float(((y - A @ found) ** 2).sum() / max(float(((y - y.mean()) ** 2).sum()), 1e-300))
    return found, left


def _rotated(function: Array, attitudes: Array) -> Array:
    """Return the function for each attitude of the momentum's frame, (n, 11)."""
    S = rotations.to_matrix(attitudes)
    out = np.empty((len(S), 11))
    out[:, 0] = function[0]
    for axis in range(2):
        W = np.einsum("nji,jk,nkl->nil", S, _matrices(function[1 + 5 * axis : 6 + 5 * axis]), S)
        out[:, 1 + 5 * axis : 6 + 5 * axis] = np.stack(
            [W[:, 0, 0], W[:, 1, 1], W[:, 0, 1], W[:, 0, 2], W[:, 1, 2]], axis=1)
    return out


@dataclasses.dataclass(frozen=True)
class Light:
    """Samples about the middle of their times, and the function of the attitude that they show."""

    t: Array
    y: Array          # times the weight
    weight: Array
    function: Array   # (11,)
    scale: bool
    offset: bool


def _clean(light: Light, high: float) -> list[float]:
    """Return the frequencies of the highest lines, each found in what the others leave."""
    t = light.t
    found: list[float] = []
    trials = grid(t, 0.5 / float(np.ptp(t)), high)
    step, zero = float(trials[1] - trials[0]), np.zeros(1)
    for _ in range(HIGHEST):
        waves = [part(f * t) for f in found for part in (np.cos, np.sin)]
        A = light.weight[:, None] * np.stack([np.ones_like(t), *waves], axis=1)
        rest = np.ascontiguousarray((light.y - A @ np.linalg.lstsq(A, light.y, rcond=None)[0])[:, None])

        def power(f: Array, rest: Array = rest) -> Array:
            return project(t, rest, light.weight, [(0, 0), (0, 1)], zero, f)[0, :, 0, 0, 0]

        k = int(np.argmax(power(trials)))
        found.append(refine(power, float(trials[k]), step))
    return found


def pairs(light: Light, high: float) -> list[tuple[float, float, float]]:
    """Return (what is left, sigma, mu) of the pairs that leave least; no line is above `high`."""
    t, y = light.t, np.ascontiguousarray(light.y[:, None])
    span = float(np.ptp(t))
    square = float((light.y**2).sum())
    lines = _clean(light, high)
    half = grid(t, SLOWEST / span, max(ABOVE * max(lines), 4 * SLOWEST / span))
    found: list[tuple[float, float, float]] = []

    def scan(kinds: list[tuple[int, int]], f: float, trials: Array, pair: Callable[[float], tuple[float, float]],
             ) -> None:
        power = project(t, y, light.weight, kinds, np.array([f]), trials)[0, :, 0, 0, 0]
        found.extend((square - float(power[k]), *pair(float(trials[k]))) for k in peaks(power, EACH))

    for f in lines:
        scan(LINES, f, half, lambda mu, f=f: (f, mu))                        # type: ignore[misc]
        scan(LINES, 0.5 * f, half, lambda mu, f=f: (0.5 * f, mu))            # type: ignore[misc]
        scan([(a, 2 * j - a) for a, j in LINES], 0.5 * f, 0.5 * half,
             lambda g, f=f: (0.5 * f - g, 2 * g))                            # type: ignore[misc]
        scan([(j, a) for a, j in LINES], f, half, lambda sigma, f=f: (sigma, f))   # type: ignore[misc]
    found.sort()
    out: list[tuple[float, float, float]] = []
    for _, sigma, mu in found[: 4 * PAIRS]:
        step = 0.4 / span
        for _ in range(3):
            s, m = sigma + step * np.linspace(-1, 1, 5), mu + step * np.linspace(-1, 1, 5)
            power = project(t, y, light.weight, LINES, s, m)[:, :, 0, 0, 0]
            i, j = np.unravel_index(int(np.argmax(power)), power.shape)
            sigma, mu, left = float(s[i]), float(m[j]), square - float(power[i, j])
            step /= 2.5
        new = all(abs(abs(sigma) - s) + abs(mu - m) > APART / span for _, s, m in out)
        if new and mu > 0.8 * SLOWEST / span and left > 0:
            out.append((left, abs(sigma), mu))
    return sorted(out)[:PAIRS]


def light_of(data: Brightness | Scalar) -> tuple[Light, float] | None:
    """Return the samples with their function, and the middle of their times; None where it is not quadratic."""
    middle = 0.5 * float(data.t[0] + data.t[-1])
    y, weight = data.y, np.array(data.whitener[:, 0, 0])
    if isinstance(data, Brightness):
        sun, observer = (v.mean(axis=0) / np.linalg.norm(v.mean(axis=0)) for v in (data.sun, data.observer))

        def fun(q: Array) -> Array:
            back = rotations.to_matrix(q).swapaxes(1, 2)
            return data.body.light(back @ sun, back @ observer)

        if data.scale:   # each night has a scale of its own
            counts = np.bincount(data.night)
            means = np.bincount(data.night, weights=y) / counts
            means = np.where(means > 0, means, 1.0)[data.night]
            y, weight = y / means, weight * means
        scale, offset = data.scale, data.offset
    else:
        def fun(q: Array) -> Array:
            return data.values_of(q)

        scale = offset = False
    function, left = quadratic(fun)
    if left > LEFT:
        return None
    return Light(data.t - middle, y * weight, weight, function, scale, offset), middle


@functools.cache
def _curves(orders: tuple[tuple[Order, ...], tuple[Order, ...]]) -> tuple[Array, Array, Array, Array, Array]:
    """Return the curves of two body axes, and of each the shape, the order, and the attitudes at all phases.

    `orders` are for bodies that encircle their greatest axis, and for those that encircle their least one.
    """
    shapes = table(*GRID)
    kinds = np.arange(len(shapes.u)) % 2     # of the table: its last loop is over both
    shape, labels, backs, attitudes = [], [], [], []
    for kind, labelled in enumerate(orders):
        here = np.flatnonzero(kinds == kind)
        q = attitudes_of(shapes, here, slice(None))
        for order in labelled:
            back = relabelled(order, False)
            attitudes.append(rotations.product(q, back))
            shape.append(here)
            labels.append(np.tile(order, (len(here), 1)))
            backs.append(np.tile(back, (len(here), 1)))
    q = np.concatenate(attitudes)
    R = rotations.to_matrix(q)
    axes = np.ascontiguousarray(np.stack([R[..., 0], R[..., 1]], axis=2))
    return axes, np.concatenate(shape), np.concatenate(labels), np.concatenate(backs), q


def bodies(light: Light, found: list[tuple[float, float, float]], orders: tuple[tuple[Order, ...], tuple[Order, ...]],
           most: int) -> tuple[Array, Array, Array]:
    """Return (moments, omega, attitude) in the middle of the times of bodies with these frequencies, the best first.

    `orders` has the ways to label the axes (a, b, c) of the table by body axes, for bodies that encircle their greatest
    axis and for those that encircle their least one.
    """
    shapes, spirals = table(*GRID), uniform_attitudes(ATTITUDES)
    axes, shape, labels, backs, attitudes = _curves(orders)
    zero = np.zeros(len(shape), dtype=int)
    which, nus, kappas = [], [], []
    seen: list[tuple[float, float]] = []      # other pairs of lines are the same two frequencies
    for _, sigma, mu in found:
        for kappa in [sign * sigma + 0.5 * k * mu for sign in (1, -1) for k in (-3, -1, 1, 3)]:
            apart = [max(abs(0.5 * mu - a), abs(kappa - b)) for a, b in seen]
            if min(apart, default=np.inf) * np.ptp(light.t) < SAME:
                continue
            seen.append((0.5 * mu, kappa))
            there = shapes.bodies(shape, zero, 0.5 * mu, np.full(len(shape), kappa))[2]
            which.append(there)
            nus.append(np.full(len(there), 0.5 * mu))
            kappas.append(np.full(len(there), kappa))
    curve, nu, kappa2 = np.concatenate(which), np.concatenate(nus), np.concatenate(kappas)
    if not len(curve):
        return np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 4))
    few = slice(None, None, max(1, len(light.t) // THIN))
    cost, best = _core._match_quadratics(
        light.t[few], light.y[few], light.weight[few], axes, PHASES, list(curve), nu, kappa2, SHIFTS,
        np.ascontiguousarray(_rotated(light.function, spirals)), light.scale, light.offset)
    trial, shift = np.unravel_index(np.argsort(cost, axis=None, kind="stable")[:most], cost.shape)
    phase, one = shift * (PHASES // (2 * SHIFTS)), curve[trial]
    S = spirals[best[trial, shift].astype(int)]
    moments, omega, _ = shapes.bodies(shape[one], phase, nu[trial], kappa2[trial])
    moments = np.take_along_axis(moments, np.argsort(labels[one], axis=1), axis=1)
    return (moments, rotations.rotate(rotations.conjugate(backs[one]), omega),
            rotations.product(S, attitudes[one, phase]))
