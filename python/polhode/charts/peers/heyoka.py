"""heyoka: Taylor's series by a just-in-time compiler, in float64, samples from its dense output."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from ..._scene.scene import Scene
from ..candidate import Answer, Candidate, Failure, Run, Settings
from ..equations import derivatives, refuses
from .found import version

NAME, INSTALL = "heyoka", "pip install heyoka"


def found() -> str:
    """The version, or ""."""
    return version("heyoka")


def _settings(scene: Scene) -> Settings:
    return (*((f"1e-{k:02d}", 10.0**-k) for k in range(3, 16, 2)), ("2e-16", 2.3e-16))


def _start(scene: Scene) -> Run:
    import heyoka as hy  # type: ignore[import-not-found,import-untyped,unused-ignore]

    names = hy.make_vars("a", "b", "c", "x", "y", "z", "s")
    found = derivatives(scene, hy.time, names, hy.cos, hy.sin)
    system = [(name, value if isinstance(value, hy.expression) else hy.expression(float(value)))
              for name, value in zip(names, found)]
    start = np.concatenate([scene.omega, scene.attitude])
    compiled: dict[float, object] = {}   # the order, and with it the code, depends on the tolerance
    times = np.concatenate([[scene.t0], scene.times]) if scene.times[0] != scene.t0 else scene.times

    def run(tolerance: float, limit: float | None) -> Answer:
        if tolerance not in compiled:
            compiled[tolerance] = hy.taylor_adaptive(system, start, time=scene.t0, tol=tolerance)
        solver: Any = compiled[tolerance]
        solver.time, solver.state[:] = scene.t0, start
        if limit is None:
            result = solver.propagate_grid(times)
        else:
            end = time.perf_counter() + limit
            result = solver.propagate_grid(times, callback=lambda s: time.perf_counter() < end)
        if result[0] == hy.taylor_outcome.cb_stop:
            raise Failure(f"not done within {limit:.2g} s")
        if result[0] != hy.taylor_outcome.time_limit:
            raise Failure(f"ended with {result[0]}")
        y = result[-1][-scene.times.size:]
        return Answer(y[:, :3].copy(), y[:, 3:].copy(), {"steps": int(result[3])})

    return run


def candidates() -> list[Candidate]:
    """Its adaptive Taylor integrator; the compilation of each order is the first run's, and not timed after."""
    return [Candidate("heyoka", "peer", "heyoka.taylor_adaptive, propagate_grid", _settings, _start,
                      refuses)]
