"""heyoka: Taylor's series by a just-in-time compiler, in float64, samples from its dense output."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from ..._scene.scene import Scene
from ..candidate import Answer, Candidate, Failure, Run, Settings, euler, separatrix
from ..equations import Separatrix, derivatives, refuses
from .found import version

NAME, INSTALL = "heyoka", "pip install heyoka"


def found() -> str:
    """The version, or ""."""
    return version("heyoka")


def _settings(scene: Scene) -> Settings:
    return (*((f"1e-{k:02d}", 10.0**-k) for k in range(3, 16, 2)), ("2e-16", 2.3e-16))


def _start(scene: Scene, in_u_v: bool = False, high_accuracy: bool = False) -> Run:
    import heyoka as hy  # type: ignore[import-not-found,import-untyped,unused-ignore]

    names = hy.make_vars("a", "b", "c", "x", "y", "z", "s")
    form = Separatrix(scene) if in_u_v else None
    found = (form.derivatives if form else derivatives)(scene, hy.time, names, hy.cos, hy.sin)
    system = [(name, value if isinstance(value, hy.expression) else hy.expression(float(value)))
              for name, value in zip(names, found)]
    start = form.start(scene) if form else np.concatenate([scene.omega, scene.attitude])
    compiled: dict[float, object] = {}   # the order, and with it the code, depends on the tolerance
    times = np.concatenate([[scene.t0], scene.times]) if scene.times[0] != scene.t0 else scene.times

    def run(tolerance: float, limit: float | None) -> Answer:
        if tolerance not in compiled:
            compiled[tolerance] = hy.taylor_adaptive(system, start, time=scene.t0, tol=tolerance,
                                                     high_accuracy=high_accuracy)
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
        return Answer(form.rates(y) if form else y[:, :3].copy(), y[:, 3:].copy(), {"steps": int(result[3])})

    return run


def candidates() -> list[Candidate]:
    """Its adaptive Taylor integrator, also with compensated sums, and in the variables of polhode's taylor.

    The compilation of each order is the first run's, and not timed after.
    """
    def make(name: str, source: str, in_u_v: bool, high_accuracy: bool) -> Candidate:
        return Candidate(name, "peer", f"heyoka.taylor_adaptive{source}, propagate_grid", _settings,
                         lambda scene: _start(scene, in_u_v, high_accuracy), Separatrix.refuses if in_u_v else refuses,
                         variables=separatrix if in_u_v else euler, right_hand_side="compiled by heyoka")

    return [make("heyoka", "", False, False), make("heyoka high_accuracy", "(high_accuracy=True)", False, True),
            make("heyoka u v", " on u, omega_2, v", True, False)]
