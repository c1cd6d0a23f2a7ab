"""Inertia tensors, their principal axes, and the mass properties of bodies.

`InertiaTensor` and `MassProperties` check their arguments. A tensor that no body can have is refused, with the axis,
the deficit in per cent and the likely cause. `polhode.shapes` makes simple bodies. `robots` checks URDF, SDF and MJCF.
"""

from __future__ import annotations

import warnings
from types import ModuleType

import numpy as np
import numpy.typing as npt

from .. import _core, _wings
from .._core import InertiaTensor, MassProperties, PrincipalAxes
from .checks import Flaw, check
from .diagnosis import diagnose
from .equivalent import equivalent_box, equivalent_ellipsoid
from .findings import Diagnosis, Finding
from .swings import SwingMoment, from_bifilar, from_pendulum

__all__ = ["Diagnosis", "Finding", "Flaw", "InertiaTensor", "MassProperties", "PrincipalAxes", "SwingMoment", "check",
           "diagnose", "equivalent_box", "equivalent_ellipsoid", "from_bifilar", "from_pendulum", "principal_axes"]
if _wings.is_there("robots"):
    __all__ += ["robots"]


def __getattr__(name: str) -> ModuleType:
    """Load the readers of robot descriptions when they are first used."""
    if name == "robots":
        robots: ModuleType = _wings.load("inertia.robots")
        return robots
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


def principal_axes(matrices: npt.ArrayLike) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Return the principal moments and axes of many tensors, with the same bits as `InertiaTensor`.

    The moments ascend. The signs of the axes follow a rule. The axes of the smallest and of the largest moment point
    towards the nearest given axis, and the middle axis completes the right-handed frame. So no axis flips within 45
    degrees of a given axis. Moments are equal if they differ by less than 16 units of rounding of the largest. For two
    equal moments the smallest rotation that aligns the third axis is applied to the given axes. For three equal moments
    the axes are the given axes.

    Parameters
    ----------
    matrices : array_like, shape (..., 3, 3)
        Symmetric, in the given axes [kg m^2]. Entries across the diagonal may differ by 1e-12 of the largest entry, and
        their mean is taken. The triangle inequality is not checked.

    Returns
    -------
    moments : ndarray, shape (..., 3)
        Ascending [kg m^2].
    axes : ndarray, shape (..., 3, 3)
        R_BP: the columns are the principal axes in the given axes.

    Raises
    ------
    InvalidInput
        For a wrong shape, or a matrix that is not symmetric. A matrix that is not finite gives NaN and a
        RuntimeWarning.
    """
    moments, axes, not_finite = _core.principal_axes(matrices)
    if not_finite:
        warnings.warn(f"matrices: {not_finite} not finite, results are NaN", RuntimeWarning, stacklevel=2)
    return moments, axes
