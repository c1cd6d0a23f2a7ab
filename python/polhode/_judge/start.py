"""The start of a scene as a claim: does the motion along the data begin there?"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from .._scene.scene import Scene
from .findings import Finding
from .name import GAIN
from .score import Numbers, likelihood
from .shooting import Track
from .states import difference


def check_start(track: Track, scene: Scene, floor: Numbers, sigma: Numbers | None) -> Finding | None:
    """Return a finding if the fitted start of the whole motion is not the scene's."""
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
    gain = likelihood(after, floor, rows, 6, sigma) - likelihood(before, floor, rows, 0, sigma)
    effect = math.sqrt(3 * max(before))
    if gain < GAIN or effect < 3 * max(floor):
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
