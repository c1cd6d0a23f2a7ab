"""The physical checks of many tensors at once."""

from __future__ import annotations

import enum

import numpy as np
import numpy.typing as npt

from .. import _core


class Flaw(enum.IntFlag):
    """Flaws that no tensor of a body can have; 0 means none."""

    NOT_FINITE = 1
    NOT_SYMMETRIC = 2
    NOT_POSITIVE = 4
    TRIANGLE = 8


def check(matrices: npt.ArrayLike) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.uint8]]:
    """Check many tensors by the rules of `InertiaTensor`, without refusing any.

    Parameters
    ----------
    matrices : array_like, shape (..., 3, 3)
        About any point, in any axes [kg m^2].

    Returns
    -------
    margins : ndarray, shape (...)
        The margin of the triangle inequality, (a + b - c) / c for the principal moments a <= b <= c. It is 1 for a
        sphere, 0 for a flat body and for zeros, and negative for an impossible body. It is NaN if not finite.
    flaws : ndarray of uint8, shape (...)
        Bits of `Flaw`: `flaws == 0` are fine, `flaws & Flaw.TRIANGLE` those with a moment above the sum of the others.

    Raises
    ------
    InvalidInput
        Wrong shape, or not numbers.
    """
    return _core.check_inertia(matrices)
