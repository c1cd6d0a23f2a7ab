"""SUNDIALS' CVODE by scikit-sundae; the right-hand side is called in Python, since that is what its users have."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..._scene.scene import Scene
from ..candidate import Answer, Candidate, Failure, Run, tolerances
from ..equations import in_floats, refuses
from .found import version
from .scipy import sizes, watched

NAME, INSTALL = "SUNDIALS", "pip install scikit-sundae"


def found() -> str:
    """The version, or ""."""
    return version("scikit-sundae", "sksundae")


def _start(scene: Scene, method: str) -> Run:
    from sksundae.cvode import CVODE  # type: ignore[import-not-found,import-untyped,unused-ignore]

    f, size = in_floats(scene), sizes(scene)
    start = np.concatenate([scene.omega, scene.attitude])
    times = np.concatenate([[scene.t0], scene.times]) if scene.times[0] != scene.t0 else np.array(scene.times)

    def run(rtol: float, limit: float | None) -> Answer:
        function = watched(f, limit)

        def right_hand_side(t: float, y: Any, yp: Any) -> None:
            yp[:] = function(t, y)

        result = CVODE(right_hand_side, method=method, rtol=rtol, atol=rtol * size,
                       max_num_steps=10_000_000).solve(times, start)
        if not result.success:
            raise Failure(str(result.message))
        y = result.y[-scene.times.size:]
        return Answer(y[:, :3].copy(), y[:, 3:].copy(), {"derivatives": int(result.nfev)})

    return run


def candidates() -> list[Candidate]:
    """Adams for what is not stiff, BDF for what is."""
    def make(method: str) -> Candidate:
        return Candidate(f"SUNDIALS {method}", "peer", f"sksundae.cvode.CVODE(method={method!r})", tolerances(3, 12, 3),
                         lambda scene: _start(scene, method), lambda scene: refuses(scene, method == "BDF"))

    return [make("Adams"), make("BDF")]
