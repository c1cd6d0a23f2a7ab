"""Violated conditions of inertia data, in words and per cent."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .checks import Flaw
from .evidence import DENSEST, OSMIUM, THINNEST, Bodies, Evidence, Geometry

Array = npt.NDArray[np.float64]


class Breach(NamedTuple):
    """A violated condition; see Finding."""

    what: str
    per_cent: float
    text: str


def breaches(given: Bodies, found: Evidence, flaws: Flaw, margin: float, geometry: Geometry) -> list[Breach]:
    """Return the conditions that no body can violate, or else those that are unlikely for this body."""
    mass, matrix = given.mass[0], given.matrix[0]
    broken = []
    values, axes = np.linalg.eigh(matrix)
    largest = np.abs(values).max()
    if mass <= 1e-100:
        broken.append(Breach("mass", 100.0, f"the mass is {mass:.6g} kg"))
    if largest == 0 and np.isfinite(mass):
        broken.append(Breach("positive", 100.0, "all moments are zero"))
    if Flaw.NOT_POSITIVE in flaws:
        part = -100 * values[0] / largest
        broken.append(Breach("positive", part, f"a negative moment, {values[0]:.4g} about {_axis(axes[:, 0])}, "
                             f"{part:.3g} % of the largest"))
    elif Flaw.TRIANGLE in flaws:
        broken.append(Breach("triangle", -100 * margin, f"the moment {values[2]:.4g} about {_axis(axes[:, 2])} is "
                             f"above the sum of the two others, {values[0] + values[1]:.4g}, by {-100 * margin:.3g} % "
                             "of it"))
    return broken or _unlikely(found, geometry)


def _axis(vector: Array) -> str:
    nearest = int(np.argmax(np.abs(vector)))
    if abs(vector[nearest]) > 1 - 1e-9:
        return "xyz"[nearest]
    vector = vector * np.sign(vector[nearest])
    return "the axis (" + ", ".join(f"{x + 0.0:.3g}" for x in vector.round(12)) + ")"


def _unlikely(found: Evidence, geometry: Geometry) -> list[Breach]:
    broken = []
    extent, outside, dense, size = (float(x[0]) for x in (found.extent, found.outside, found.dense, found.size))
    if outside > 0:
        broken.append(Breach("extent", 100 * outside, "the centre of mass lies outside the geometry by "
                             f"{100 * outside:.3g} % of its size"))
    if extent > 0:
        broken.append(Breach("extent", 100 * (extent - 1), f"moments {extent:.3g} times as large as any mass within "
                             "the geometry can have"))
    if size != 0 and not extent:
        ratio = np.exp(size)
        text = f"{ratio:.3g} times as large as" if size > 0 else f"{1 / ratio:.3g} times smaller than"
        broken.append(Breach("size", 100 * abs(ratio - 1), f"moments {text} a uniform body's of its geometry"))
    if dense != 0 and not broken:
        factor = np.exp(abs(dense))
        if geometry.volume is not None:
            text = f"a density {factor:.3g} times {'above' if dense > 0 else 'below'} what any such part has"
        elif dense > 0:
            text = f"moments so small for the mass that it is {factor * DENSEST / OSMIUM:.3g} times denser than osmium"
        else:
            text = f"moments so large for the mass that it is {factor / THINNEST:.3g} times thinner than air"
        broken.append(Breach("density", 100 * (factor - 1), text))
    return broken
