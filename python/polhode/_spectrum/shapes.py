"""A table of the motions of free bodies by their shape, for a nutation of frequency 1 and L = 1 (docs/exact.md).

A free body with given frequencies has two more numbers: a3, the largest part of the momentum along the encircled
axis, and the modulus k. The table has both on a grid. It holds bodies that encircle their greatest axis (s = 1) and
their least one (s = -1).
"""

from __future__ import annotations

import dataclasses
import functools
import itertools
from collections.abc import Iterator

import numpy as np

from .._batch.closed_forms import free_motion
from .._sensitivity import rotations
from .curve import LEAST, PHASES, SLACK
from .scan import Array, Places

ANGLES = 8                                                   # of the encircled axis from the momentum, where nearest


@dataclasses.dataclass(frozen=True)
class Shapes:
    """Curves m (B, PHASES, 3) of axes (a, b, c), c encircled and b the middle one, and u, v and bend as of `Curve`."""

    m: Array
    u: Array
    v: Array
    bend: Array

    def bodies(self, which: Places, phase: Places, nu: float | Array, kappa2: Array) -> tuple[Array, Array, Array]:
        """Return (moments, omega, places in the arguments) of the bodies that exist, at phases of the curves.

        `which`, `phase` and `kappa2` have one number a body, `nu` one for all or one a body. `phase` counts the table's
        phases.
        """
        g = (kappa2 - nu * self.bend[which])[:, None] + np.reshape(nu, (-1, 1)) * np.stack(
            [self.u[which], self.v[which], np.zeros(len(which))], axis=1)
        here = np.flatnonzero(np.abs(np.sign(g).sum(axis=1)) == 3)
        moments = 1 / np.abs(g[here])
        possible = 2 * moments.max(axis=1) <= SLACK * moments.sum(axis=1)
        here, moments = here[possible], moments[possible]
        seconds = 0.5 * moments.sum(axis=1, keepdims=True) - moments
        seconds = np.maximum(seconds, LEAST * seconds.max(axis=1, keepdims=True))
        return seconds.sum(axis=1, keepdims=True) - seconds, g[here] * self.m[which[here], phase[here]], here


@functools.cache
def table(angles: int, moduli: int) -> Shapes:
    """Return the table for angles of the encircled axis from the momentum, where nearest, and moduli."""
    angle = (np.arange(angles) + 0.5) * (0.5 * np.pi / angles)
    near = ((np.arange(moduli) + 0.5) / moduli) ** 2      # k'^2, denser near the separatrix
    return make_shapes(*(part.ravel() for part in np.meshgrid(angle, 1 - near, (1.0, -1.0), indexing="ij")))


def around(centre: Array, half: Array, s: float, count: int) -> tuple[Shapes, Array]:
    """Return shapes on a grid, count x count, about (angle, k'), and these two of each; `half` is half of the width."""
    steps = np.linspace(-1, 1, count)
    angle, root = np.meshgrid(np.clip(centre[0] + half[0] * steps, 1e-3, 0.5 * np.pi - 1e-3),
                              np.clip(centre[1] + half[1] * steps, 1e-3, 1 - 1e-6), indexing="ij")
    places = np.stack([angle.ravel(), root.ravel()], axis=1)
    return make_shapes(places[:, 0], 1 - places[:, 1] ** 2, np.full(len(places), s)), places


def cell_of(angles: int, moduli: int, which: int) -> tuple[Array, Array, float]:
    """Return the centre (angle, k') of a cell of a table, half of its width, and the sign of its bodies."""
    i, j, k = np.unravel_index(which, (angles, moduli, 2))
    half = np.array([0.25 * np.pi / angles, 0.5 / moduli])
    return half * np.array([2 * int(i) + 1, 2 * int(j) + 1]), half, 1.0 - 2 * int(k)


def make_shapes(angle: Array, square: Array, s: Array) -> Shapes:
    """Return the shapes of angles, k^2 and signs: 1 for bodies that encircle their greatest axis."""
    a1, a3 = np.sin(angle), np.cos(angle)
    r = a1**2 / (a1**2 + square * a3**2)
    K = _complete(square)
    u = s * 2 * K / (np.pi * a3 * np.sqrt(r))
    v = r * u
    large = 10 * np.abs(u)
    g = large[:, None] + np.stack([u, v, np.zeros_like(u)], axis=1)
    start = np.stack([a1, np.zeros_like(a1), a3], axis=1)
    t = 2 * np.pi * np.arange(PHASES) / PHASES
    omega = free_motion(1 / g[:, None], (g * start)[:, None], (0, 0, 0, 1), t, want="omega")
    m = np.asarray(omega) / g[:, None]
    bend = ((u[:, None] * m[..., 0] ** 2 + v[:, None] * m[..., 1] ** 2) / (1 + m[..., 2])).mean(axis=1)
    return Shapes(m, u, v, bend)


def _complete(square: Array) -> Array:
    """Return K(k) by the arithmetic and geometric mean."""
    a, b = np.ones_like(square), np.sqrt(1 - square)
    for _ in range(8):
        a, b = 0.5 * (a + b), np.sqrt(a * b)
    return np.asarray(np.pi / (2 * a))


def attitudes_of(shapes: Shapes, which: slice | Places, phases: slice | Array) -> Array:
    """Return attitudes from the table's axes to the frame of the momentum, with 2 kappa t left out."""
    m = shapes.m[which]
    rate = (shapes.u[which, None] * m[..., 0] ** 2 + shapes.v[which, None] * m[..., 1] ** 2) / (1 + m[..., 2])
    order = np.fft.fftfreq(PHASES, 1 / PHASES)
    order[0] = 1.0
    angle = np.fft.ifft(np.fft.fft(rate - rate.mean(axis=-1, keepdims=True), axis=-1) / (1j * order), axis=-1).real
    w = np.sqrt(0.5 * (1 + m[..., 2]))
    # the least rotation that takes m to the third axis, then the rotation about it
    q = np.stack([0.5 * m[..., 1] / w, -0.5 * m[..., 0] / w, np.zeros_like(w), w], axis=-1)
    about = np.zeros_like(q)
    about[..., 2], about[..., 3] = np.sin(0.5 * angle), np.cos(0.5 * angle)
    out: Array = rotations.product(about, q)
    return out[:, phases]


def variants() -> Iterator[tuple[tuple[int, ...], bool]]:
    """Give all ways to label the axes of the table, and whether a half turn about axis a comes after."""
    yield from itertools.product(itertools.permutations(range(3)), (False, True))


def relabelled(order: tuple[int, ...], flip: bool) -> Array:
    """Return the rotation from the body axes to the table's: axis order[k] of the body is axis k of the table.

    Axis a is reversed where the permutation is odd. With `flip` there is a half turn about axis a in addition.
    """
    P = np.zeros((3, 3))
    P[np.arange(3), list(order)] = 1
    if np.linalg.det(P) < 0:
        P[0] *= -1
    if flip:
        P[1:] *= -1
    return rotations.of_matrix(P)
