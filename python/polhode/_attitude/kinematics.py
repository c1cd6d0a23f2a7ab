"""Conversion between angular velocity and the rates of Euler angles."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import attitude as _kernels

FloatArray = NDArray[np.float64]


def body_rates(sequence: str, angles: ArrayLike, angle_rates: ArrayLike) -> FloatArray:
    """Return the angular velocity in body axes from Euler angles and their rates.

    Parameters
    ----------
    sequence : str
        Three axes, as in `Rotation.from_euler`; any of the 24.
    angles, angle_rates : array_like, shape (..., 3)
        [rad] and [rad/s], both in the order of the letters; their leading dimensions broadcast.

    Returns
    -------
    omega : ndarray, shape (..., 3)
        w_B [rad/s].

    Raises
    ------
    InvalidInput
        Unknown sequence, NaN, inf, or shapes that do not fit.
    """
    return _kernels.body_rates(sequence, angles, angle_rates)


def euler_rates(sequence: str, angles: ArrayLike, omega: ArrayLike) -> FloatArray:
    """Return the rates of Euler angles from an angular velocity in body axes, the inverse of `body_rates`.

    Parameters
    ----------
    sequence : str
        Three axes, as in `Rotation.from_euler`; any of the 24.
    angles, omega : array_like, shape (..., 3)
        [rad] in the order of the letters, and w_B [rad/s]; their leading dimensions broadcast.

    Returns
    -------
    angle_rates : ndarray, shape (..., 3)
        [rad/s], in the order of the letters. They grow as one over the distance to the pole.

    Raises
    ------
    InvalidInput
        At gimbal lock, that is where the middle angle is the double nearest to a pole: no rates of the angles give a
        general omega there. Also unknown sequence, NaN, inf, or shapes that do not fit.
    """
    return _kernels.euler_rates(sequence, angles, omega)
