"""Errors sample by sample, where the largest alone does not do."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ..charts.truth import Truth
from ..motion import Motion


def attitude_errors(motion: Motion, truth: Truth) -> npt.NDArray[np.float64]:
    """Return the angle between the attitudes at every sample [rad], formed as in `charts.truth.compute_errors`."""
    assert motion.attitude is not None
    q, r = motion.attitude, truth.attitude
    along = np.sum(q * r, axis=1)
    d = np.where(along < 0, -1.0, 1.0)[:, None] * q - r
    vector = r[:, 3:] * d[:, :3] - d[:, 3:] * r[:, :3] - np.cross(r[:, :3], d[:, :3])
    return np.asarray(2 * np.arctan2(np.linalg.norm(vector, axis=1), np.abs(along)))
