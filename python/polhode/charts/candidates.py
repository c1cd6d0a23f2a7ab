"""Who takes part: every adaptive method, the closed forms that apply, and other programs where they are installed.

A candidate is a record with a function that answers a scene at one setting; the charts go through `candidates()`. A
method joins by the compiled list, a closed form or another program by a line in `_exact` or `candidates`.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

import polhode

from ..motion import Floats
from ..scene import Scene
from ..solver import methods, solve
from . import scipy_peer
from .right_hand_sides import in_floats, in_numpy


COUNTS = ("steps", "rejected", "derivatives")


class Answer(NamedTuple):
    """What a candidate returns: the states at the scene's times, and what they cost."""

    omega: Floats
    attitude: Floats
    stats: dict[str, int]


class Failure(Exception):
    """A run that ended without an answer; the text says why."""


class Candidate(NamedTuple):
    """One way to answer a scene.

    `settings`: what is swept, from loose to tight, as (label, value). `run(scene, value, limit)` answers the scene, or
    raises `Failure`; it ends after `limit` seconds when that is given, and otherwise looks at no clock, so that timed
    runs pay for none. `refuses(scene)`: why it does not take part, or "".
    """

    name: str
    family: str          # "method" | "exact" | "peer"
    source: str
    settings: tuple[tuple[str, float], ...]
    run: Callable[[Scene, float, float | None], Answer]
    refuses: Callable[[Scene], str]


def tolerances(first: int, last: int, step: int = 1) -> tuple[tuple[str, float], ...]:
    """Powers of ten from 10^-first to 10^-last."""
    return tuple((f"1e-{k:02d}", 10.0**-k) for k in range(first, last + 1, step))


def _adaptive(record: dict[str, Any]) -> Candidate:
    def run(scene: Scene, rtol: float, limit: float | None) -> Answer:
        watch = None
        if limit is not None:
            end = time.thread_time() + limit

            def watch(reached: float, last: float) -> bool:
                return time.thread_time() < end

        motion = solve(scene, method=record["name"], rtol=rtol, progress=watch)
        if motion.status == "stopped":
            raise Failure(f"not done within {limit:.2g} s")
        if motion.status != "finished":
            raise Failure(motion.message)
        if motion.omega is None or motion.attitude is None:
            raise Failure("the scene does not want both omega and attitude")
        return Answer(motion.omega, motion.attitude, {key: int(motion.stats[key]) for key in COUNTS})

    return Candidate(record["name"], "method", record["source"], tolerances(3, 14), run, lambda scene: "")


def _closed_form(name: str, source: str, make: Callable[[Scene], Any], refuses: Callable[[Scene], str]) -> Candidate:
    def run(scene: Scene, value: float, limit: float | None) -> Answer:
        omega, attitude = make(scene).at(scene.times - scene.t0)
        return Answer(omega, attitude, {})

    return Candidate(name, "exact", source, (("closed form", 0.0),), run, refuses)


def _free(scene: Scene) -> str:
    return "the body is not free" if scene.torques else ""


def _top(scene: Scene) -> str:
    """Why the scene is not Lagrange's top about body z."""
    if len(scene.torques) != 1 or not isinstance(scene.torques[0], polhode.torques.Gravity):
        return "not a body under gravity alone"
    matrix = scene.inertia.matrix
    if (matrix != np.diag(np.diag(matrix))).any() or matrix[0, 0] != matrix[1, 1] or scene.torques[0].arm[:2].any():
        return "not symmetric about an axis through the pivot and the centre of mass"
    return ""


def _make_top(scene: Scene) -> Any:
    gravity = scene.torques[0]
    return polhode.HeavyTop(scene.inertia, gravity.weight * gravity.arm[2], scene.omega, scene.attitude)


def _exact() -> list[Candidate]:
    return [
        _closed_form("FreeMotion", "Jacobi 1850, in Cayley-Klein form",
                     lambda s: polhode.FreeMotion(s.inertia, s.omega, s.attitude), _free),
        _closed_form("HeavyTop", "Klein and Sommerfeld 1897", _make_top, _top),
    ]


def _scipy(name: str, method: str, make: Callable[[Scene], Any], last: int) -> Candidate:
    def run(scene: Scene, rtol: float, limit: float | None) -> Answer:
        try:
            return Answer(*scipy_peer.run(scene, make, method, rtol, limit))
        except (scipy_peer.Stopped, FloatingPointError) as error:
            raise Failure(str(error)) from None

    # A run takes up to seconds, so every third decade is what there is time for.
    return Candidate(name, "peer", f"scipy.integrate.solve_ivp, right-hand side {make.__name__.replace('_', ' ')}",
                     tolerances(3, last, 3), run, scipy_peer.refuses)


def candidates(with_peers: bool = True) -> list[Candidate]:
    """Return everyone who takes part, polhode's own first."""
    own = [_adaptive(record) for record in methods() if record["adaptive"]]
    peers = [_scipy("SciPy RK45", "RK45", in_floats, 12), _scipy("SciPy DOP853", "DOP853", in_floats, 12),
             _scipy("SciPy RK45, NumPy", "RK45", in_numpy, 9)]
    return [*own, *_exact(), *(peers if with_peers else [])]
