"""The truth of a scene, its uncertainty, and the errors of a result."""

from __future__ import annotations

import json
from typing import Any, NamedTuple

import numpy as np

from .. import _core
from .._core import InvalidInput
from .._scene.scene import Scene, scene_folder
from .._solve.motion import Floats
from .._solve.solve import methods, solve

ORDERS = (28, 25, 22)   # of the series, and of the two that check it
MOST_STEPS = 200_000    # of a series: half a minute


class Truth(NamedTuple):
    """The reference at the scene's times."""

    omega: Floats
    attitude: Floats
    kind: str            # "stored" | "made"
    source: str
    uncertainty: float   # the larger of both parts, as `Errors.largest`
    floor: float | None  # how far rounding the scene's inputs moves the answer; None when not known
    start_rate: float = 0.0   # of the scene [rad/s]

    @property
    def omega_scale(self) -> float:
        """The largest rate of the start and the samples [rad/s], as `Motion.omega_scale`."""
        return max(float(np.linalg.norm(self.omega, axis=1).max()), self.start_rate)


class Errors(NamedTuple):
    """Largest errors over all samples."""

    omega: float      # |omega - truth| / the largest rate of the start and the samples
    attitude: float   # angle of the rotation between the two attitudes [rad]

    @property
    def largest(self) -> float:
        """The larger one: NaN if either is."""
        return float(np.maximum(self.omega, self.attitude))


def start_rate(scene: Scene) -> float:
    """Return the size of omega at the start [rad/s]."""
    return float(np.linalg.norm(scene.omega))


def attitude_errors(attitude: Floats, truth: Truth) -> Floats:
    """Return the angle between the attitudes at every sample, without cancellation, shape (n,) [rad].

    The vector part of conj(truth) q equals that of conj(truth) d for the difference d = q - truth (q with the sign that
    brings it near), since conj(truth) truth is real; d is formed without rounding where it is small.
    """
    q, r = attitude, truth.attitude
    along = np.sum(q * r, axis=1)
    d = np.where(along < 0, -1.0, 1.0)[:, None] * q - r
    vector = r[:, 3:] * d[:, :3] - d[:, 3:] * r[:, :3] - np.cross(r[:, :3], d[:, :3])
    return np.asarray(2 * np.arctan2(np.linalg.norm(vector, axis=1), np.abs(along)))


def compute_errors(omega: Floats, attitude: Floats, truth: Truth) -> Errors:
    """Return the largest errors of an answer; omega's is relative to the largest rate of the start and the samples."""
    size = truth.omega_scale
    with np.errstate(all="ignore"):   # an answer may hold anything
        rates = np.linalg.norm(omega - truth.omega, axis=1).max() / (size if size > 0 else 1.0)
        return Errors(float(rates), float(attitude_errors(attitude, truth).max()))


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
    text = ("extrapolated midpoint steps of 32 digits, in momenta and in rates" if scene.changing
            else "113-bit extrapolated midpoint steps of momenta, confirmed by collocation of rates"
            if scene.name in ("S13", "S15") else "113-bit Taylor series, confirmed by collocation")
    return Truth(omega, attitude, "stored", text, 3e-16, floor, start_rate(scene))


def _series(scene: Scene) -> Truth | None:
    """Taylor series in long double; its uncertainty is what other orders make of it, beside rounding to float64.

    Rounding errors of two runs may be alike by chance. Of normal errors, one in 130 is more than four times as large as
    its distance from each of two others.
    """
    if np.finfo(np.longdouble).nmant < 63:
        return None   # long double is nothing more here
    try:
        fine, *others = (_core.reference(scene, order, 1e-20, MOST_STEPS) for order in ORDERS)
    except (InvalidInput, _core.IntegrationFailure):   # a user's torque, or too stiff for a series
        return None
    if not all(np.isfinite(part).all() for run in (fine, *others) for part in (run.omega, run.attitude)):
        return None
    text = f"Taylor series of order {ORDERS[0]} in long double, checked by orders {ORDERS[1]} and {ORDERS[2]}"
    truth = Truth(fine.omega, fine.attitude, "made", text, 0.0, None, start_rate(scene))
    apart = max(compute_errors(other.omega, other.attitude, truth).largest for other in others)
    return truth._replace(uncertainty=4 * max(apart, float(np.finfo(float).eps)))


def _two_methods(scene: Scene, tightest: float) -> Truth:
    """The method of the highest order at the tightest tolerance.

    Its uncertainty is how far another method, and itself at ten times that, are from it.
    """
    able = [m for m in methods() if m["adaptive"] and not _core.method_refusal(m["name"], scene)]
    records = sorted(able, key=lambda m: (-m["order"], m["name"]))
    texts: list[str] = []
    runs: list[tuple[Floats, Floats]] = []
    why = ""
    for record, rtol in [(r, tightest) for r in records] + [(r, 10 * tightest) for r in records]:
        if len(runs) == 3:
            break
        motion = solve(scene, method=record["name"], rtol=rtol, max_steps=50 * MOST_STEPS)
        if motion.status != "finished" or motion.omega is None or motion.attitude is None:
            why = motion.message
            continue
        texts.append(f"{record['name']} at {rtol:g}")
        runs.append((motion.omega, motion.attitude))
    if len(runs) < 2:
        raise InvalidInput(f"{scene.name or 'scene'}: no reference can be made: {why}")
    text = f"{texts[0]}, checked by {' and '.join(texts[1:])}"
    truth = Truth(*runs[0], "made", text, 0.0, None, start_rate(scene))
    return truth._replace(uncertainty=2 * max(compute_errors(*run, truth).largest for run in runs[1:]))


def find_truth(scene: Scene, tightest: float = 1e-14) -> Truth:
    """Return the stored truth of a scene, or one made on the fly with its uncertainty."""
    return _stored(scene) or _series(scene) or _two_methods(scene, tightest)


def to_json(truth: Truth) -> dict[str, Any]:
    """Return what the results say about the reference."""
    return {"kind": truth.kind, "source": truth.source, "uncertainty": truth.uncertainty, "floor": truth.floor}
