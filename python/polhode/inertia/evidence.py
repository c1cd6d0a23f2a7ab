"""Scores of how well mass, centre and tensor fit possible bodies, and a given geometry."""

from __future__ import annotations

import dataclasses
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .._core import MassProperties

Array = npt.NDArray[np.float64]

ROUNDED = 1e-3      # a deficit below this part of the largest moment is what rounding to three digits can do
OSMIUM = 22_590.0   # [kg/m^3]
DENSEST = 1e5       # more than four times that
THINNEST = 1e-5     # 1e-5 of air's density: nothing that is built
SIZES = (1e-2, 20.0)       # second moments over the uniform body's, beyond which uneven density is no excuse
DENSITIES = (2.0, 40_000.0)  # over the volume of a geometry that may leave parts out, or fill what is hollow


class Bodies(NamedTuple):
    """A stack of candidates: mass (n,), com (n, 3), matrix (n, 3, 3); NaN for a mass or com that was not given."""

    mass: Array
    com: Array
    matrix: Array


def _array(x: npt.ArrayLike) -> Array:
    return np.asarray(x, dtype=float)


def single(mass: float | None, com: Array | None, matrix: Array) -> Bodies:
    """Stack a single body."""
    return Bodies(np.array([np.nan if mass is None else mass]),
                  np.full((1, 3), np.nan) if com is None else np.array([com], dtype=float),
                  np.array([matrix], dtype=float))


def stack(bodies: list[Bodies]) -> Bodies:
    """Put stacks one after the other."""
    return Bodies(*(np.concatenate(parts) for parts in zip(*bodies)))


def point_term(d: Array) -> Array:
    """The tensor of a unit mass at d, (..., 3) -> (..., 3, 3): the parallel-axis term."""
    return _array((d**2).sum(-1)[..., None, None] * np.eye(3) - d[..., :, None] * d[..., None, :])


def spread(matrix: Array) -> Array:
    """Return the second moments of mass, integral of x x^T dm = trace(I)/2 - I, of tensors (..., 3, 3)."""
    return _array(np.trace(matrix, axis1=-2, axis2=-1)[..., None, None] / 2 * np.eye(3) - matrix)


def from_spread(second: Array) -> Array:
    """Return the tensors with these second moments."""
    return _array(np.trace(second, axis1=-2, axis2=-1)[..., None, None] * np.eye(3) - second)


def _inverse_root(matrix: Array) -> Array:
    """The inverse square root, of directions without extent as if they had a hundredth of the largest."""
    values, vectors = np.linalg.eigh(matrix)
    values = np.maximum(values, max(1e-2 * values[-1], np.finfo(float).tiny))
    return _array(vectors / np.sqrt(values) @ vectors.T)


class Reference(NamedTuple):
    """A uniform body of unit mass."""

    com: Array
    matrix: Array
    whiten: Array       # of tensors
    whiten_com: Array   # of lengths


def reference(body: MassProperties) -> Reference:
    """Take the mass out of a body."""
    unit = np.asarray(body.inertia.matrix) / body.mass
    return Reference(np.asarray(body.com), unit, _inverse_root(unit), _inverse_root(spread(unit)))


@dataclasses.dataclass(frozen=True, eq=False)
class Geometry:
    """What is known of a body's form: uniform bodies, a box (2, 3) that holds all of it, and its volume."""

    references: tuple[Reference, ...] = ()
    box: Array | None = None
    volume: float | None = None
    slack: float = 0.1   # of the box's sides: a simplified geometry may be a little too small

    @property
    def known(self) -> bool:
        return bool(self.references) or self.box is not None or self.volume is not None

    def scaled(self, factor: float) -> Geometry:
        """The same form with all its lengths multiplied."""
        return Geometry(tuple(Reference(r.com * factor, r.matrix * factor**2, r.whiten / factor, r.whiten_com / factor)
                              for r in self.references),
                        None if self.box is None else self.box * factor,
                        None if self.volume is None else self.volume * factor**3, self.slack)


class Evidence(NamedTuple):
    """Of n candidates; each breach is 0 where there is none, else by how many times the limit is passed."""

    score: Array      # in nats, less is better
    margin: Array     # to the triangle inequality, a part of the largest moment
    extent: Array     # moments
    outside: Array    # com, as a part of the box
    dense: Array      # log of the factor beyond the limit, signed
    size: Array       # log of the ratio to the uniform body, signed
    misfit: Array     # departure from the nearest reference; NaN without one

    def sound(self) -> npt.NDArray[np.bool_]:
        """True if no condition is violated."""
        out = (self.extent > 0) | (self.outside > 0)
        broken = (self.margin < -ROUNDED) | out | (self.dense != 0) | (self.size != 0)
        return np.asarray(~broken, dtype=bool)


def weigh(bodies: Bodies, geometry: Geometry) -> Evidence:
    """Score candidates; the first is what was given."""
    mass, com, matrix = bodies
    n = len(mass)
    with np.errstate(all="ignore"):
        known = np.where(np.isfinite(mass) & (np.abs(mass) > 1e-100), mass, 1.0)
        moments = np.linalg.eigvalsh(matrix)
        largest = np.abs(moments).max(-1)
        margin = np.where(largest > 0, (moments[:, 0] + moments[:, 1] - moments[:, 2]) / largest, 0.0)
        second = spread(matrix) / known[:, None, None]
        spreads = _array(np.linalg.eigvalsh(second))
        top = np.maximum(spreads[:, 2], np.finfo(float).tiny)
        thin = np.clip(spreads[:, 0] / top, 1e-4, 1)
        score = np.where(margin < -ROUNDED, 60.0, 0.0) + np.where(known <= 0, 60.0, 0.0)
        extent, outside = _beyond_box(com, second, geometry, np.isfinite(mass))
        dense, rarity = _beyond_matter(mass, spreads, geometry)
        size, misfit, dof = np.zeros(n), np.full(n, np.nan), _informative(matrix, mass, geometry)
        if geometry.references:
            fits = [_departure(bodies, r) for r in geometry.references]
            nearest = np.argmin([d for d, _ in fits], axis=0)
            misfit = np.choose(nearest, [d for d, _ in fits])
            ratio = np.choose(nearest, [t for _, t in fits])
            beyond = np.isfinite(mass) & ((ratio < SIZES[0]) | ((ratio > SIZES[1]) & (geometry.box is None)))
            size = np.where(beyond, np.log(np.maximum(ratio, 1e-300)), 0.0)
            score += dof * np.log(np.maximum(misfit, 1e-4))
        else:
            score -= np.log(thin)
    score += 40.0 * ((extent > 0) | (outside > 0)) + 40.0 * (dense != 0) + 40.0 * (size != 0) + rarity
    return Evidence(np.where(np.isfinite(score), score, 1e6), margin, extent, outside, dense, size, misfit)


def _beyond_box(com: Array, second: Array, geometry: Geometry, massive: npt.NDArray[np.bool_]) -> tuple[Array, Array]:
    """Mass between lo and hi, centred on c, has a second moment of at most (hi - c)(c - lo) (BhatiaDavis2000)."""
    n = len(com)
    if geometry.box is None:
        return np.zeros(n), np.zeros(n)
    lo, hi = geometry.box
    side = np.maximum(hi - lo, 1e-2 * (hi - lo).max())
    side = side * (1 + geometry.slack)
    lo, hi = (lo + hi - side) / 2, (lo + hi + side) / 2
    centre = np.where(np.isfinite(com), com, (lo + hi) / 2)
    out = np.maximum(np.maximum(lo - centre, centre - hi) / side, 0.0).max(-1)
    limit = np.where((centre > lo) & (centre < hi), (hi - centre) * (centre - lo), (hi - lo) ** 2)
    factor = (np.einsum("nii->ni", second) / limit).max(-1)
    return np.where(massive & (factor > 1), factor, 0.0), out


def _beyond_matter(mass: Array, spreads: Array, geometry: Geometry) -> tuple[Array, Array]:
    """Of all bodies with these second moments the uniform ellipsoid is the largest: no body is thinner than it."""
    lengths = np.sqrt(5 * np.maximum(spreads, 0.0))
    solid = np.isfinite(mass) & (mass > 0) & (spreads[:, 0] > 1e-9 * spreads[:, 2])
    density = np.where(solid, mass / (4 / 3 * np.pi * lengths.prod(-1)), 1000.0)
    dense = np.where(density > DENSEST, np.log(density / DENSEST), 0.0)
    dense = np.where(density < THINNEST, np.log(density / THINNEST), dense)
    if geometry.volume is not None:
        density = np.where(np.isfinite(mass) & (mass > 0), mass / geometry.volume, 1000.0)
        for limit, beyond in zip(DENSITIES, (density < DENSITIES[0], density > DENSITIES[1])):
            dense = np.where(beyond & (dense == 0), np.log(density / limit), dense)
    return dense, np.minimum(0.1 * np.log(density / 1000) ** 2, 6.0)


def _departure(bodies: Bodies, r: Reference) -> tuple[Array, Array]:
    """Of whitened tensors and centres: shape, size (when there is a mass) and place; and the ratio of the sizes."""
    mass, com, matrix = bodies
    massive = np.isfinite(mass)
    e = r.whiten @ (matrix / np.where(massive, mass, 1.0)[:, None, None]) @ r.whiten
    ratio = np.trace(e, axis1=1, axis2=2) / 3
    sound = ratio > 0
    form = ((e / np.where(sound, ratio, 1.0)[:, None, None] - np.eye(3)) ** 2).sum((1, 2))
    size = np.where(massive & sound, np.log(np.where(sound, ratio, 1.0)) ** 2, 0.0)
    shift = np.where(np.isfinite(com).all(-1), ((np.nan_to_num(com - r.com) @ r.whiten_com) ** 2).sum(-1), 0.0)
    return np.where(sound, np.sqrt(form + size + shift), 30.0), np.where(massive, ratio, 1.0)


def apart(body: Bodies, geometry: Geometry) -> float:
    """The largest difference of a body from the nearest reference, as a part of the largest moment or length."""
    nearest = np.inf
    for r in geometry.references:
        top = np.abs(r.matrix).max()
        trace = np.trace(body.matrix[0])
        scale = 1 / body.mass[0] if np.isfinite(body.mass[0]) else np.trace(r.matrix) / trace if trace > 0 else 0.0
        unit = body.matrix[0] * scale
        shift = np.abs(np.nan_to_num(body.com[0] - r.com)).max() / np.sqrt(top)
        nearest = min(nearest, max(float(np.abs(unit - r.matrix).max() / top), float(shift)))
    return nearest


def _informative(matrix: Array, mass: Array, geometry: Geometry) -> float:
    """How many of six numbers say something: products that vanish in data and geometry alike agree for nothing."""
    count = 3.0 - (not np.isfinite(mass[0]))
    rows, columns = np.triu_indices(3, 1)
    off_axis = np.zeros(3, dtype=bool)
    for m in [matrix[0], *(r.matrix for r in geometry.references)]:
        scale = np.sqrt(np.abs(m[rows, rows] * m[columns, columns]))
        off_axis |= np.abs(m[rows, columns]) > 1e-3 * scale
    return count + float(off_axis.sum())
