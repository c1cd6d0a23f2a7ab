"""numbalsoda: LSODA and DOP853 in compiled code, on a right-hand side compiled by Numba."""

from __future__ import annotations

import numpy as np

from ..._scene.scene import Scene
from ..candidate import Answer, Candidate, Failure, Run, tolerances
from ..equations import for_numba, refuses
from .found import version

NAME, INSTALL = "numbalsoda", "pip install numba numbalsoda (built on the spot: apt install g++ gfortran)"


def found() -> str:
    """The version, or ""."""
    return version("numba") and version("numbalsoda")


def _start(scene: Scene, method: str) -> Run:
    import numba
    import numbalsoda as nb  # type: ignore[import-not-found,import-untyped,unused-ignore]

    pointer = numba.cfunc(nb.lsoda_sig)(for_numba(scene, "t, u, f, p")).address
    start = np.concatenate([scene.omega, scene.attitude])
    times = np.array(scene.times) if scene.times[0] == scene.t0 else np.concatenate([[scene.t0], scene.times])
    solve = getattr(nb, method)

    def run(rtol: float, limit: float | None) -> Answer:
        size = float(np.linalg.norm(scene.omega)) or 1.0
        # Without mxstep, dop853 ends after 10000 steps and says so only in its flag.
        y, success = solve(pointer, start, times, rtol=rtol, atol=rtol * min(size, 1.0), mxstep=10_000_000)
        if not success:
            raise Failure("numbalsoda says success=False")
        y = y[-scene.times.size:]
        return Answer(y[:, :3].copy(), y[:, 3:].copy(), {})

    return run


def candidates() -> list[Candidate]:
    """Both of its solvers; lsoda refuses tolerances below 1e-13."""
    def make(method: str) -> Candidate:
        return Candidate(f"numbalsoda {method}", "peer", f"numbalsoda.{method}", tolerances(3, 13, 2),
                         lambda scene: _start(scene, method), refuses, right_hand_side="compiled by Numba")

    return [make("lsoda"), make("dop853")]
