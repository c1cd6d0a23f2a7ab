"""SUNDIALS' CVODE by scikit-sundae; the right-hand side is compiled by Numba where that is there."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..._scene.scene import Scene
from ..candidate import Answer, Candidate, Failure, Run, tolerances
from ..equations import for_numba, in_floats, refuses
from .found import version
from .scipy import sizes, watched

NAME, INSTALL = "SUNDIALS", "pip install scikit-sundae numba"


def found() -> str:
    """The version, or ""."""
    return version("scikit-sundae", "sksundae")


def _compile(scene: Scene) -> Any:
    import numba

    return numba.njit("void(float64, float64[:], float64[:])")(for_numba(scene, "t, u, f"))


def _watched_filling(function: Any, limit: float) -> Any:
    """The same function, which ends the run after `limit` seconds of the clock."""
    look = watched(lambda t, y: None, limit)

    def watching(t: float, y: Any, yp: Any) -> None:
        look(t, y)
        function(t, y, yp)

    return watching


def _start(scene: Scene, method: str) -> Run:
    from sksundae.cvode import CVODE  # type: ignore[import-not-found,import-untyped,unused-ignore]

    size = sizes(scene)
    f = None if version("numba") else in_floats(scene)
    compiled = _compile(scene) if f is None else None
    start = np.concatenate([scene.omega, scene.attitude])
    times = np.concatenate([[scene.t0], scene.times]) if scene.times[0] != scene.t0 else np.array(scene.times)

    def run(rtol: float, limit: float | None) -> Answer:
        right_hand_side: Any
        if f is not None:
            function = watched(f, limit)

            def fill(t: float, y: Any, yp: Any) -> None:
                yp[:] = function(t, y)

            right_hand_side = fill
        else:
            right_hand_side = compiled if limit is None else _watched_filling(compiled, limit)

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
                         lambda scene: _start(scene, method), lambda scene: refuses(scene, method == "BDF"),
                         right_hand_side="compiled by Numba, called from Python" if version("numba") else "in Python")

    return [make("Adams"), make("BDF")]
