"""Solids with a given mass and tensor: the inverse of the shapes."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .._core import InertiaTensor, InvalidInput

Array = npt.NDArray[np.float64]


def equivalent_box(mass: float, inertia: InertiaTensor | npt.ArrayLike) -> tuple[Array, Array]:
    """Return the block of uniform density that has a mass and a tensor.

    Parameters
    ----------
    mass : float
        Positive [kg].
    inertia : InertiaTensor or array_like, shape (3, 3)
        About the centre of mass [kg m^2].

    Returns
    -------
    half_sides : ndarray, shape (3,)
        Along the principal axes, in the order of ascending moments [m]; as :func:`polhode.shapes.box` takes them. A
        flat body has a side of 0.
    axes : ndarray, shape (3, 3)
        R_BP: the columns are the principal axes in the given axes.

    Raises
    ------
    InvalidInput
        A mass that is not positive, and a tensor that no body can have.
    """
    return _sizes(mass, inertia, 3.0)


def equivalent_ellipsoid(mass: float, inertia: InertiaTensor | npt.ArrayLike) -> tuple[Array, Array]:
    """Return the solid ellipsoid of uniform density that has a mass and a tensor.

    Parameters
    ----------
    mass, inertia
        As in :func:`equivalent_box`.

    Returns
    -------
    semi_axes : ndarray, shape (3,)
        Along the principal axes, in the order of ascending moments [m]; as :func:`polhode.shapes.ellipsoid` takes them.
    axes : ndarray, shape (3, 3)
        R_BP: the columns are the principal axes in the given axes.

    Raises
    ------
    InvalidInput
        As in :func:`equivalent_box`.
    """
    return _sizes(mass, inertia, 5.0)


def _sizes(mass: float, inertia: Any, factor: float) -> tuple[Array, Array]:
    """Return the sizes: the integral of x^2 dm is m a^2 / factor, and half of the other two moments less its own."""
    if not 0 < mass < np.inf:
        raise InvalidInput(f"mass: must be positive and finite, got {mass}")
    tensor = inertia if isinstance(inertia, InertiaTensor) else InertiaTensor(inertia)
    if not tensor.physical:
        tensor = InertiaTensor(tensor.matrix)   # refuses what no body can have
    a, b, c = tensor.moments
    second = np.array([(c - a) + b, (c - b) + a, (a - c) + b]) / 2
    # What remains of a flat body is rounding of the largest moment.
    second[second <= 2e-15 * c] = 0.0
    return np.sqrt(factor * second / mass), tensor.axes
