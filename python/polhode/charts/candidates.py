"""The candidates: every method, torques as formulas, the plan's choice, the closed forms, and other programs.

A method and a closed form join by the compiled lists, another program by its file and a name in `peers`.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from .. import _core
from .._harness.formulas import to_formulas, why_no_formulas
from .._scene.scene import Scene
from .._solve.motion import Motion
from .._solve.plan import plan
from .._solve.solve import methods, solve
from . import peers as peer_list
from .candidate import (
    Answer,
    Candidate,
    Failure,
    Run,
    Settings,
    closed,
    euler,
    fixed,
    separatrix,
    steps,
    tolerances,
)

IN_U_V = {"taylor", "radau", "symplectic"}   # methods that step separatrix variables
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

    return Candidate(name, "cheap" if record["comparison"] else "method", record["source"], settings,
                     lambda scene: _solving(scene, "rtol" if adaptive else "step", method=name), refuses,
                     "rtol" if adaptive else "step", separatrix if name in IN_U_V else euler)


def _formula() -> Candidate:
    """Return the candidate of torques as a user would write them: formulas, by their Taylor series."""
    return Candidate("formula", "formula", "taylor; each torque is a formula of its own law, which is not recognised",
                     tolerances(3, 14), lambda scene: _solving(to_formulas(scene), "rtol", method="taylor"),
                     why_no_formulas, variables=separatrix)


def _plan() -> Candidate:
    """Return the candidate of `solve` with an accuracy, including its certificate."""
    return Candidate("plan", "plan", "polhode.solve(accuracy=), with its certificate", tolerances(3, 12, 3),
                     lambda scene: _solving(scene, "accuracy"), lambda scene: "", "accuracy", _planned)


def _planned(scene: Scene) -> str:
    """The variables of what the plan chooses at its tightest setting here."""
    chosen = plan(scene, 1e-12).method
    return closed(scene) if chosen == "exact" else separatrix(scene) if chosen in IN_U_V else euler(scene)


def _closed_form(name: str, source: str) -> Candidate:
    def start(scene: Scene) -> Run:
        def run(value: float, limit: float | None) -> Answer:
            omega, attitude = _core.find_closed_form(scene).at(scene.times - scene.t0)
            return Answer(omega, attitude, {})

        return run

    def refuses(scene: Scene) -> str:
        if any(rotor.during is not None for rotor in scene.rotors) or any(hasattr(t, "windows") for t in scene.torques):
            return "torques or rotors start or stop within the span"
        return str(_core.closed_form_refusal(scene, name))

    return Candidate(name, "exact", source, fixed("closed form"), start, refuses, "", closed)


def _exact() -> list[Candidate]:
    """Return a candidate for each class of closed forms; its source is that of its last name, the general one."""
    sources = {form["type"]: form["source"] for form in _core.closed_forms()}
    return [_closed_form(name, source) for name, source in sources.items()]


def candidates(with_peers: bool = True) -> list[Candidate]:
    """Return all candidates, those of polhode first."""
    own = [_method(record) for record in methods()]
    return [*_exact(), *own, _formula(), _plan(), *(peer_list.candidates() if with_peers else [])]
