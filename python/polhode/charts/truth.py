"""What is true on a scene, how well that is known, and how far an answer is from it."""

from __future__ import annotations

import json
from typing import Any, NamedTuple

import numpy as np

from .._core import InvalidInput
from ..motion import Floats
from ..scene import Scene, scene_folder
from ..solver import methods, solve


class Truth(NamedTuple):
    """The reference at the scene's times."""

    omega: Floats
    attitude: Floats
    kind: str            # "stored" | "made"
    source: str
    uncertainty: float   # the larger of both parts, as `Errors.largest`
    floor: float | None  # how far rounding the scene's inputs moves the answer; None when not known


class Errors(NamedTuple):
    """Largest errors over all samples."""

    omega: float      # |omega - truth| / max |truth|
    attitude: float   # angle of the rotation between the two attitudes [rad]

    @property
    def largest(self) -> float:
        """The larger one: NaN if either is."""
        return float(np.maximum(self.omega, self.attitude))


def compute_errors(omega: Floats, attitude: Floats, truth: Truth) -> Errors:
    """Return the errors of an answer, without cancellation.

    The vector part of conj(truth) q equals that of conj(truth) d for the difference d = q - truth (q with the sign that
    brings it near), since conj(truth) truth is real; d is formed without rounding where it is small.
    """
    size = np.linalg.norm(truth.omega, axis=1).max()
    with np.errstate(all="ignore"):   # an answer may hold anything
        rates = np.linalg.norm(omega - truth.omega, axis=1).max() / (size if size > 0 else 1.0)
        q, r = attitude, truth.attitude
        along = np.sum(q * r, axis=1)
        d = np.where(along < 0, -1.0, 1.0)[:, None] * q - r
        vector = r[:, 3:] * d[:, :3] - d[:, 3:] * r[:, :3] - np.cross(r[:, :3], d[:, :3])
        angle = 2 * np.arctan2(np.linalg.norm(vector, axis=1), np.abs(along))
    return Errors(float(rates), float(angle.max()))


def _stored(scene: Scene) -> Truth | None:
    """Return the reference installed with polhode, if this is the scene it was made for."""
    folder = scene_folder() / "reference"
    file = folder / f"{scene.name}.npz"
    if not (scene.name and file.is_file()) or Scene.load(scene.name) != scene:
        return None
    with np.load(file) as table:
        omega, attitude = table["omega"], table["attitude"]
    floors = json.loads((folder / "floors.json").read_text())[scene.name]
    floor = max(floors["omega"], floors["attitude"])
    return Truth(omega, attitude, "stored", "113-bit Taylor series, confirmed by collocation", 3e-16, floor)


def _made(scene: Scene, tightest: float) -> Truth:
    """Solve at the tightest tolerance and at one ten times looser, whose difference is the uncertainty."""
    record = max((m for m in methods() if m["adaptive"]), key=lambda m: m["order"])
    fine, coarse = (solve(scene, method=record["name"], rtol=rtol) for rtol in (tightest, 10 * tightest))
    for motion in (fine, coarse):
        if motion.status != "finished" or motion.omega is None or motion.attitude is None:
            raise InvalidInput(f"{scene.name or 'scene'}: no reference can be made: {motion.message}")
    assert fine.omega is not None and fine.attitude is not None
    assert coarse.omega is not None and coarse.attitude is not None
    text = f"{record['name']} at {tightest:g}; uncertainty: its difference from {10 * tightest:g}"
    truth = Truth(fine.omega, fine.attitude, "made", text, 0.0, None)
    return truth._replace(uncertainty=compute_errors(coarse.omega, coarse.attitude, truth).largest)


def find_truth(scene: Scene, tightest: float = 1e-14) -> Truth:
    """Return the stored truth of a scene, or one made on the fly with its uncertainty."""
    return _stored(scene) or _made(scene, tightest)


def to_json(truth: Truth) -> dict[str, Any]:
    """Return what the results say about the reference."""
    return {"kind": truth.kind, "source": truth.source, "uncertainty": truth.uncertainty, "floor": truth.floor}
