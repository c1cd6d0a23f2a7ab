"""Inertia tensors, their principal axes, and the mass properties of bodies.

`InertiaTensor` and `MassProperties` check what they are given once, at the door: a tensor that no body can have is
refused with the axis, the deficit in per cent and the likely cause. `polhode.shapes` makes the simple bodies.
"""

from __future__ import annotations

import warnings

import numpy as np
import numpy.typing as npt

from .. import _core
from .._core import InertiaTensor, MassProperties, PrincipalAxes
from .checks import Flaw, check
from .diagnosis import diagnose
from .findings import Diagnosis, Finding

__all__ = ["Diagnosis", "Finding", "Flaw", "InertiaTensor", "MassProperties", "PrincipalAxes", "check", "diagnose",
           "principal_axes"]


def principal_axes(matrices: npt.ArrayLike) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Principal moments and axes of many tensors at once, bit for bit those of `InertiaTensor`.

    The moments ascend, which leaves the signs of the axes to choose. The axes of the smallest and of the largest moment
    point towards the given axis they lie nearest to, the middle one completes the right-handed frame; so a frame turned
    by less than 45 degrees from the given axes is found as such, and no axis flips within 45 degrees of a given axis.
    Of two equal moments (closer than 16 units of rounding of the largest), the axes are the given ones carried along by
    the smallest turn onto the axis that stands apart; of three, the given axes themselves.

    Parameters
    ----------
    matrices : array_like, shape (..., 3, 3)
        Symmetric, in the given axes [kg m^2]. Entries across the diagonal may differ by 1e-12 of the largest one, and
        their mean is taken. Whether a body can have such a tensor is not asked.

    Returns
    -------
    moments : ndarray, shape (..., 3)
        Ascending [kg m^2].
    axes : ndarray, shape (..., 3, 3)
        R_BP: the columns are the principal axes in the given axes.

    Raises
    ------
    InvalidInput
        Wrong shape, or a matrix that is not symmetric. One that is not finite gives NaN and a RuntimeWarning.
    """
    moments, axes, not_finite = _core.principal_axes(matrices)
    if not_finite:
        warnings.warn(f"matrices: {not_finite} not finite, answered with NaN", RuntimeWarning, stacklevel=2)
    return moments, axes
