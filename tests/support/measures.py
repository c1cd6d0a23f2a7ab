"""The error measure of the scenes, and their stored truth."""

import pathlib

import numpy as np

ROOT = pathlib.Path(__file__).parents[2]


def attitude_error(attitude, reference):
    """The largest rotation angle between two series of unit quaternions [rad], exact for small angles."""
    near = np.linalg.norm(attitude - reference, axis=-1)
    far = np.linalg.norm(attitude + reference, axis=-1)
    return float(np.max(4 * np.arcsin(np.minimum(1.0, np.minimum(near, far) / 2))))


def rates_error(omega, reference, start=(0.0, 0.0, 0.0)):
    """The largest error of omega, relative to the largest rate of the start and the samples."""
    scale = max(np.linalg.norm(start), np.linalg.norm(reference, axis=-1).max())
    return float(np.linalg.norm(omega - reference, axis=-1).max() / scale)


def error(omega, attitude, reference, start=(0.0, 0.0, 0.0)):
    """The error of a trajectory as docs/conventions.md defines it: the larger of the two."""
    return max(rates_error(omega, reference["omega"], start), attitude_error(attitude, reference["attitude"]))


def truth(name):
    """The stored truth of a scene: t, omega, attitude."""
    with np.load(ROOT / f"scenes/reference/{name}.npz") as data:
        return {key: data[key] for key in ("t", "omega", "attitude")}
