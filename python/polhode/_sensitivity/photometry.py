"""The light that a convex body sends to an observer, and its derivatives by the directions of the Sun and the observer.

All directions are unit vectors in body axes. An ellipsoid is the image of the unit sphere under diag(a, b, c), so the
integrals over its surface become integrals over the sphere, with sqrt(C) s for the direction s, C = diag(a, b, c)^-2.
"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from .._attitude.arrays import to_numbers
from .._core import InvalidInput

Array = npt.NDArray[np.float64]

LAWS = ("lambert", "lommel-seeliger", "geometric")
NODES = 24       # of Gauss and Legendre along each angle of Lambert's integral: 4e-6 of the full light for axes 1, 5, 2
FLAT = 1e-6      # of the size: a vertex so far outside of a face's plane makes a body that is not convex
ROUGH = 8        # the same for a search: 1e-3
AT_ONCE = 1 << 20   # numbers of an intermediate array


class Reflector(Protocol):
    """A body that reflects light."""

    def light(self, sun: Array, observer: Array) -> Array:
        """Return the light (...,) for directions (..., 3)."""

    def gradients(self, sun: Array, observer: Array) -> tuple[Array, Array, Array]:
        """Return the light (n,) and its derivatives by both directions, (n, 3) each."""


def make_reflector(body: Any, law: str) -> Reflector:
    """Return the body of three semi-axes, or of (vertices, faces)."""
    if isinstance(body, (tuple, list)) and len(body) == 2:
        return Facets(body[0], body[1], law)
    axes = to_numbers(body, "body")
    if axes.shape != (3,) or not (np.isfinite(axes) & (axes > 0)).all():
        raise InvalidInput(f"body: must be three positive semi-axes, or (vertices, faces), got {body!r}")
    return Ellipsoid(axes, law)


class Ellipsoid:
    """An ellipsoid with its semi-axes along the body axes."""

    def __init__(self, axes: Array, law: str, nodes: int = NODES) -> None:
        self.nodes = nodes
        self.C: Array = axes**-2.0
        self.size = float(np.prod(axes))
        self.law = law

    def rough(self) -> Ellipsoid:
        """Return the same body with a cheaper integral."""
        return Ellipsoid(self.C**-0.5, self.law, ROUGH)

    def _forms(self, sun: Array, observer: Array) -> tuple[Array, Array, Array, Array]:
        """Return s C s, e C e, s C e, and the square of the sine term, (s C s)(e C e) - (s C e)^2."""
        root = np.sqrt(self.C)
        s, e = root * sun, root * observer
        across = np.cross(s, e)
        return (s * s).sum(-1), (e * e).sum(-1), (s * e).sum(-1), (across * across).sum(-1)

    def light(self, sun: Array, observer: Array) -> Array:
        """Return the light (...,) for directions (..., 3)."""
        if self.law == "lambert":
            return np.asarray(self._lambert(sun, observer, False)[0])
        A, B, D, G = self._forms(sun, observer)
        if self.law == "geometric":   # half the outline, and half the ellipse that the terminator is
            return np.asarray(0.5 * np.pi * self.size * (np.sqrt(B) + D / np.sqrt(A)))
        W = np.maximum(A + B + 2 * D, 1e-12 * (A + B))
        a, b, S = np.sqrt(A), np.sqrt(B), np.sqrt(W)
        L = np.log((a * S + A + D) * (b * S + B + D) / np.maximum(G, 1e-30 * A * B))
        return np.asarray(0.5 * np.pi * self.size * ((a * (B + D) + b * (A + D)) / W - G * L / (W * S)))

    def gradients(self, sun: Array, observer: Array) -> tuple[Array, Array, Array]:
        """Return the light and its derivatives by both directions.

        Lommel and Seeliger's law: Muinonen and Lumme (2015), in the three forms of `_forms`.
        """
        if self.law == "lambert":
            return self._lambert(sun, observer, True)
        A, B, D, G = (form[..., None] for form in self._forms(sun, observer))
        cs, ce, half = self.C * sun, self.C * observer, 0.5 * np.pi * self.size
        if self.law == "geometric":
            a = np.sqrt(A)
            return (self.light(sun, observer), half * (ce / a - D / (A * a) * cs), half * (ce / np.sqrt(B) + cs / a))
        W = np.maximum(A + B + 2 * D, 1e-12 * (A + B))
        a, b, S = np.sqrt(A), np.sqrt(B), np.sqrt(W)
        P, Q = a * S + A + D, b * S + B + D
        L = np.log(P * Q / np.maximum(G, 1e-30 * A * B))
        N, power = a * (B + D) + b * (A + D), 1 / (W * S)

        def put(dA: Array, dB: Array, dD: Array, dG: Array) -> Array:
            dW = dA + dB + 2 * dD
            da, db, dS = dA / (2 * a), dB / (2 * b), dW / (2 * S)
            dN = da * (B + D) + a * (dB + dD) + db * (A + D) + b * (dA + dD)
            dP, dQ = da * S + a * dS + dA + dD, db * S + b * dS + dB + dD
            out: Array = half * (dN / W - N * dW / W**2 - power * (
                dG * (L - 1) - 1.5 * G * L * dW / W + G * (dP / P + dQ / Q)))
            return out

        zero = np.zeros_like(cs)
        light = half * (N / W - G * L * power)
        by_sun = put(2 * cs, zero, ce, 2 * (B * cs - D * ce))
        return light[..., 0], by_sun, put(zero, 2 * ce, cs, 2 * (A * ce - D * cs))

    def _lambert(self, sun: Array, observer: Array, wanted: bool) -> tuple[Array, Array, Array]:
        """Integrate over the lune of the sphere that is lit and seen; its edges add nothing to the derivatives."""
        shape = sun.shape[:-1]
        s, e = (np.broadcast_to(v, (*shape, 3)).reshape(-1, 3) for v in (sun, observer))
        out = np.empty(len(s)), np.empty((len(s), 3)), np.empty((len(s), 3))
        step = max(AT_ONCE // (3 * self.nodes**2), 1)
        for first in range(0, len(s), step):
            here = slice(first, first + step)
            for whole, part in zip(out, self._lune(s[here], e[here], wanted), strict=False):
                whole[here] = part
        return out[0].reshape(shape), out[1], out[2]

    def _lune(self, s: Array, e: Array, wanted: bool) -> tuple[Array, ...]:
        root = np.sqrt(self.C)
        s, e = root * s, root * e
        a, b = np.linalg.norm(s, axis=1), np.linalg.norm(e, axis=1)
        first = s / a[:, None]
        across = np.cross(s, e)
        sine = np.linalg.norm(across, axis=1)
        angle = np.arctan2(sine, (s * e).sum(1))
        other = np.cross(first, np.eye(3)[np.abs(first).argmin(axis=1)])
        other /= np.linalg.norm(other, axis=1, keepdims=True)
        third = np.where((sine > 1e-9 * a * b)[:, None], across / np.maximum(sine, 1e-300)[:, None], other)
        second = np.cross(third, first)
        x, weight = np.polynomial.legendre.leggauss(self.nodes)
        phi = 0.5 * angle[:, None] + 0.5 * (np.pi - angle[:, None]) * x          # (n, nodes)
        cosine = np.cos(0.5 * np.pi * x)                                         # of the latitude
        flat = np.cos(phi)[..., None] * first[:, None] + np.sin(phi)[..., None] * second[:, None]
        n = cosine[:, None] * flat[:, :, None] + np.sin(0.5 * np.pi * x)[:, None] * third[:, None, None]
        area = (0.5 * (np.pi - angle))[:, None, None] * weight[:, None] * (0.5 * np.pi * weight * cosine)
        area = self.size * area / np.sqrt((n * n) @ self.C)
        lit = (a[:, None] * np.cos(phi))[..., None] * cosine
        seen = (b[:, None] * np.cos(phi - angle[:, None]))[..., None] * cosine
        light = (area * lit * seen).sum((1, 2))
        if not wanted:
            return (light,)
        return light, root * np.einsum("nij,nijk->nk", area * seen, n), root * np.einsum("nij,nijk->nk", area * lit, n)


class Facets:
    """A convex body of triangles."""

    def __init__(self, vertices: Any, faces: Any, law: str) -> None:
        points, corners = to_numbers(vertices, "body"), to_numbers(faces, "body")
        if points.ndim != 2 or points.shape[1] != 3 or corners.ndim != 2 or corners.shape[1] != 3 or len(corners) < 4:
            raise InvalidInput(f"body: must be vertices (n, 3) and faces (m, 3), got {points.shape}, {corners.shape}")
        index = corners.astype(int)
        if not np.isfinite(points).all() or (index != corners).any() or index.min() < 0 or index.max() >= len(points):
            raise InvalidInput(f"body: must have finite vertices, and faces that name them from 0 to {len(points) - 1}")
        p, q, r = points[index[:, 0]], points[index[:, 1]], points[index[:, 2]]
        normal = 0.5 * np.cross(q - p, r - p)
        self.area: Array = np.linalg.norm(normal, axis=1)
        size = float(np.ptp(points, axis=0).max())
        kept = self.area > 1e-14 * size**2
        edges = {(int(k[i]), int(k[(i + 1) % 3])) for k in index for i in range(3)}
        if len(edges) != 3 * len(index) or any((j, i) not in edges for i, j in edges):
            raise InvalidInput("body: must be a closed surface whose faces are all counterclockwise from outside")
        self.area, self.normal = self.area[kept], normal[kept] / self.area[kept, None]
        used = points[np.unique(index)]
        above = max(float((used @ n - p0 @ n).max()) for n, p0 in zip(self.normal, p[kept], strict=True))
        if above > FLAT * size:
            raise InvalidInput("body: must be convex with faces counterclockwise from outside; a vertex is "
                               f"{above:.3g} beyond a face")
        self.law = law

    def _cosines(self, sun: Array, observer: Array) -> tuple[Array, Array]:
        return np.maximum(sun @ self.normal.T, 0), np.maximum(observer @ self.normal.T, 0)

    def light(self, sun: Array, observer: Array) -> Array:
        """Return the light (...,) for directions (..., 3)."""
        lit, seen = self._cosines(sun, observer)
        if self.law == "geometric":
            return np.asarray(((lit > 0) * seen) @ self.area)
        if self.law == "lambert":
            return np.asarray((lit * seen) @ self.area)
        return np.asarray((lit * seen / np.maximum(lit + seen, 1e-300)) @ self.area)

    def gradients(self, sun: Array, observer: Array) -> tuple[Array, Array, Array]:
        """Return the light and its derivatives; faces that the light begins to graze are left out of these."""
        lit, seen = self._cosines(sun, observer)
        light = self.light(sun, observer)
        both = (lit > 0) & (seen > 0)
        weighted = self.area[:, None] * self.normal
        if self.law == "geometric":
            return light, np.zeros((len(lit), 3)), both @ weighted
        if self.law == "lambert":
            return light, (both * seen) @ weighted, (both * lit) @ weighted
        total = np.maximum(lit + seen, 1e-150) ** 2
        return light, (both * seen**2 / total) @ weighted, (both * lit**2 / total) @ weighted
