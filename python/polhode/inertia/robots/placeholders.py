"""Numbers that were not computed."""

from __future__ import annotations

import numpy as np

from .geometry import Array

UNIT_SHAPES = {"cylinder": (7 / 48, 7 / 48, 1 / 8), "capsule": (0.07418, 0.07418, 0.018769),
               "ellipsoid": (0.068, 0.058, 0.026)}   # box and sphere have one number three times
NEGLIGIBLE = 1e-12   # [m^2]: moments over the mass, of a radius of gyration of a micrometre


def is_negligible(matrix: Array, mass: float) -> bool:
    """Return whether a tensor is zero but for rounding."""
    largest = float(np.abs(matrix).max())
    return largest == 0 or largest < 1e-15 and (mass == 0 or largest < NEGLIGIBLE * abs(mass))


def is_placeholder(matrix: Array, mass: float, copies: int) -> str:
    """Return why the numbers look like a placeholder, or "". `copies`: how many links of other form have them too."""
    diagonal = matrix.diagonal()
    products = matrix[np.triu_indices(3, 1)]
    largest = float(np.abs(diagonal).max())
    if largest > 0 and np.ptp(diagonal) <= 1e-3 * largest:
        if np.abs(products).max() <= 1e-6 * largest:
            return "one number three times: a placeholder that was never filled in?"
        if np.ptp(products) <= 1e-9 * largest and abs(products[0] - largest) <= 1e-9 * largest:
            return "one number six times: a placeholder that was never filled in?"
    for name, unit in UNIT_SHAPES.items():
        if np.abs(products).max() <= 1e-6 and np.abs(diagonal - unit).max() <= 1e-3:
            return f"the moments of a {name} of 1 kg and 1 m, as in the tutorials: a placeholder?"
    if copies >= 3:
        return f"{copies} links of other form have the same numbers: copied, and never computed?"
    if not products.any() and all(_digits(x) <= 1 for x in diagonal) and _digits(mass) <= 2:
        return "round numbers: a placeholder that was never filled in?"
    return ""


def _digits(x: float) -> int:
    """Count the significant digits of a number."""
    if x == 0:
        return 0
    if not np.isfinite(x) or abs(x) < 1e-100:
        return 17
    return len(repr(float(f"{x:.17g}")).lower().partition("e")[0].replace(".", "").strip("-0"))
