"""The candidates: every method, the plan's choice, the closed forms that apply, and other programs.

A method joins by the compiled list, another program by its file and a name in `peers`, a closed form by a line here.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from .. import _core, torques
from .._scene.scene import Scene
from .._solve.motion import Motion
from .._solve.solve import methods, solve
from . import peers as peer_list
from .candidate import Answer, Candidate, Failure, Run, Settings, fixed, steps, tolerances

COUNTS = ("steps", "rejected", "derivatives")


def _answer(motion: Motion, limit: float | None) -> Answer:
    if motion.status == "stopped":
        raise Failure(f"not done within {limit:.2g} s")
    if motion.status != "finished":
        raise Failure(motion.message)
    if motion.omega is None or motion.attitude is None:
        raise Failure("the scene does not want both omega and attitude")
    return Answer(motion.omega, motion.attitude, {key: int(motion.stats[key]) for key in COUNTS if key in motion.stats})


def _solving(scene: Scene, option: str, **others: Any) -> Run:
    """Return a run that solves the scene with the value swept as this option."""
    def run(value: float, limit: float | None) -> Answer:
        watch = None
        if limit is not None:
            end = time.perf_counter() + limit

            def watch(reached: float, last: float) -> bool:
                return time.perf_counter() < end

        options: dict[str, Any] = {option: value, **others}
        return _answer(solve(scene, progress=watch, **options), limit)

    return run


def _method(record: dict[str, Any]) -> Candidate:
    name, adaptive = record["name"], record["adaptive"]
    settings: Callable[[Scene], Settings] = tolerances(3, 14) if adaptive else steps

    def refuses(scene: Scene) -> str:
        refusal = str(_core.method_refusal(name, scene))
        return f"needs {record['needs']}" if refusal and record["needs"] else refusal

    return Candidate(name, "cheap" if record["cheap"] else "method", record["source"], settings,
                     lambda scene: _solving(scene, "rtol" if adaptive else "step", method=name), refuses,
                     "rtol" if adaptive else "step")


def _plan() -> Candidate:
    """Return the candidate of `solve` with an accuracy, including its certificate."""
    return Candidate("plan", "plan", "polhode.solve(accuracy=), with its certificate", tolerances(3, 12, 3),
                     lambda scene: _solving(scene, "accuracy"), lambda scene: "", "accuracy")


def _closed_form(name: str, source: str, make: Callable[[Scene], Any], refuses: Callable[[Scene], str]) -> Candidate:
    def start(scene: Scene) -> Run:
        def run(value: float, limit: float | None) -> Answer:
            omega, attitude = make(scene).at(scene.times - scene.t0)
            return Answer(omega, attitude, {})

        return run

    return Candidate(name, "exact", source, fixed("closed form"), start, refuses, "")


def _free(scene: Scene) -> str:
    return "the body is not free" if scene.torques or scene.rotors else ""


def _rotors(scene: Scene) -> str:
    if scene.torques:
        return "the body is not free"
    windows = any(rotor.during is not None for rotor in scene.rotors)
    return "" if scene.rotor_momentum.any() and not windows else "no rotors that always turn"


def _top(scene: Scene) -> str:
    """Why the scene is not Lagrange's top about body z."""
    if scene.rotors or len(scene.torques) != 1 or not isinstance(scene.torques[0], torques.Gravity):
        return "not a body under gravity alone"
    matrix = scene.inertia.matrix
    if (matrix != np.diag(np.diag(matrix))).any() or matrix[0, 0] != matrix[1, 1] or scene.torques[0].arm[:2].any():
        return "not symmetric about an axis through the pivot and the centre of mass"
    return ""


def _make_top(scene: Scene) -> Any:
    gravity = scene.torques[0]
    return _core.HeavyTop(scene.inertia, gravity.weight * gravity.arm[2], scene.omega, scene.attitude)


def _exact() -> list[Candidate]:
    return [
        _closed_form("FreeMotion", "Jacobi 1850, in Cayley-Klein form",
                     lambda s: _core.FreeMotion(s.inertia, s.omega, s.attitude), _free),
        _closed_form("Gyrostat", "Volterra 1899, as one theta series",
                     lambda s: _core.Gyrostat(s.carrier_inertia, momentum=s.rotor_momentum, omega=s.omega,
                                              attitude=s.attitude), _rotors),
        _closed_form("HeavyTop", "Klein and Sommerfeld 1897", _make_top, _top),
    ]


def candidates(with_peers: bool = True) -> list[Candidate]:
    """Return all candidates, those of polhode first."""
    own = [_method(record) for record in methods()]
    return [*_exact(), *own, _plan(), *(peer_list.candidates() if with_peers else [])]
