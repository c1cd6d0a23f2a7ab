"""The error of a motion against what is known."""

import numpy as np


def compute_error(motion, known):
    """The larger of the errors of omega and of the attitude's angle, of what was wanted.

    Omega's is relative to the largest rate of the start and the samples. A sample that is missing or not finite is an
    infinite error.
    """
    if len(motion.t) < len(known.omega):
        return np.inf
    found = [0.0]
    if motion.omega is not None:
        apart = np.sqrt(((motion.omega - known.omega) ** 2).sum(axis=1)).max()
        found.append(0.0 if apart == 0 else apart / known.omega_scale if known.omega_scale else np.inf)
    if motion.attitude is not None:
        apart = np.minimum(*(((motion.attitude + sign * known.attitude) ** 2).sum(axis=1) for sign in (-1, 1)))
        found.append(4 * np.arcsin(np.minimum(1, np.sqrt(apart.max()) / 2)))
    return float(max(found)) if np.isfinite(found).all() else np.inf
