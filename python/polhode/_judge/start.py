"""The start of a scene as a claim: does the motion along the data begin there?"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from .._core import IntegrationFailure, InvalidInput
from .._scene.scene import Scene
from .._solve.solve import solve
from .findings import Finding
from .name import GAIN
from .score import Numbers, likelihood
from .shooting import Data, Track
from .states import State, difference

ACCURACY, SURE = 1e-12, 1e-11


def check_start(
    track: Track, scene: Scene, floor: Numbers, sigma: Numbers | None, from_scene: bool = True
) -> Finding | None:
    """Return a finding if the fitted start of the whole motion is not the scene's.

    `from_scene` stands for a motion without a cause, which is compared with the scene's own; another at first order.
    """
    data, law = track.data, track.law
    here = np.array([scene.t0])
    given = law.flow(here, data.t[:1] - here, (scene.omega[None], np.asarray(scene.attitude, float)[None]))
    offset = difference((track.omega[0, :1], track.attitude[0, :1]), given)[0]
    if not data.has_attitude:
        offset[3:] = 0.0
    rows = 3 * len(data.t)

    def squares(residual: Any) -> Numbers:
        return tuple(float(np.sum((residual[:, part] / scale) ** 2)) / rows for part, scale in data.channels)

    after, before = squares(track.residual[0]), squares(track.residual[0] - track.carried[0] @ offset)
    own, error = _own(scene, data)
    if from_scene and own is not None:  # exact, where the motion amplifies rounding
        before = squares(difference(own, data.state))
    elif max(np.max(np.abs(offset[part])) / size for part, size in data.channels) < 10 * max(floor):
        return None
    gain = likelihood(after, floor, rows, 6, sigma) - likelihood(before, floor, rows, 0, sigma)
    effect = math.sqrt(3 * max(before))
    if gain < GAIN or effect < max(3 * max(floor), error):
        return None
    d_omega, d_attitude = -offset[:3], -offset[3:]
    slope = law.field(data.t[:1], *given)[0][0]
    size = float(np.linalg.norm(d_omega))
    words = f"rates differ by {size:.3g} rad/s and the attitude by {np.linalg.norm(d_attitude):.3g} rad"
    evidence: dict[str, Any] = {"attitude": tuple(map(float, d_attitude)), "gain": gain}
    if np.any(slope) and size > 0:
        time = float(d_omega @ slope / (slope @ slope))
        if np.linalg.norm(d_omega - time * slope) < 0.1 * size:
            evidence["time"] = time
            words += f", the motion's own change in {time:.3g} s"
    return Finding(
        "start",
        words,
        size=tuple(map(float, d_omega)),
        effect=effect,
        margin=gain,
        evidence=evidence,
        explained=1 - max(after) / max(before),
        cure="check what the simulator starts from, and when it prints",
    )


def _own(scene: Scene, data: Data) -> tuple[State | None, float]:
    """Return the scene's motion at the samples, None where it is not sure, and the error that it states."""
    try:
        motion = solve(scene.replace(times=data.t, want=("omega", "attitude")), ACCURACY)
    except (InvalidInput, IntegrationFailure):
        return None, 0.0
    error = float(motion.error or 0.0)     # stated, too, where the accuracy is not reached
    if not motion.success or error > SURE or motion.omega is None or motion.attitude is None:
        return None, error
    return (motion.omega, motion.attitude), error
