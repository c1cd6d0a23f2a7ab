"""Errors sample by sample, where the largest alone does not do."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ..charts.truth import Truth, compute_errors
from ..motion import Motion


def attitude_errors(motion: Motion, truth: Any) -> npt.NDArray[np.float64]:
    """Return the angle between the attitudes at every sample [rad]."""
    assert motion.omega is not None and motion.attitude is not None
    angles = np.empty(motion.t.size)
    for i in range(motion.t.size):
        one = Truth(truth.omega[i:i + 1], truth.attitude[i:i + 1], "", "", 0.0, None)
        angles[i] = compute_errors(motion.omega[i:i + 1], motion.attitude[i:i + 1], one).attitude
    return angles
