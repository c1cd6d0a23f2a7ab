"""One scene, measured: every candidate at every setting once, then repeats of all of them in turn, within a budget."""

from __future__ import annotations

import math
import statistics
import time
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .. import _core
from ..scene import Scene
from .candidates import Answer, Candidate, Failure
from .truth import Truth, compute_errors, find_truth

ROUNDS = 5
SHORTEST = 2e-3   # seconds of calls behind one reading of the clock
SHARES = {"method": 0.8, "exact": 0.8, "peer": 0.7}   # of the budget: when a family must have ended; then come repeats
LEAST = 0.1   # of the budget, for a candidate whose family has used its time up, and for the repeats

Report = Callable[[str], object]


@dataclass
class Point:
    """One candidate at one setting. `why` is empty when it answered."""

    candidate: str
    family: str
    setting: str
    value: float
    why: str = ""
    left_out: bool = False      # not run at all
    error: float = math.nan     # the larger of the two below
    error_omega: float = math.nan
    error_attitude: float = math.nan
    seconds: float = math.nan   # median of `repeats`, CPU time of the thread
    repeats: int = 0
    stats: dict[str, int] = field(default_factory=dict)
    drift: dict[str, float] = field(default_factory=dict)

    @property
    def answered(self) -> bool:
        """Whether there is an error and a time to show."""
        return not self.why


@dataclass
class SceneResult:
    """All points of a scene, and the truth they were held against."""

    scene: Scene
    title: str
    truth: Truth
    points: list[Point]
    notes: list[str]
    seconds: float = 0.0

    def of(self, candidate: str) -> list[Point]:
        """The points of one candidate that answered, from loose to tight."""
        return [p for p in self.points if p.candidate == candidate and p.answered]

    def names(self, *families: str) -> list[str]:
        """The candidates of these families that answered at least once."""
        return list(dict.fromkeys(p.candidate for p in self.points if p.answered and p.family in families))


def compute_drift(scene: Scene, answer: Answer) -> dict[str, float]:
    """Return how far each invariant moved, the same way for everyone; quaternions count by their direction."""
    attitude = answer.attitude / np.linalg.norm(answer.attitude, axis=1, keepdims=True)
    return dict(_core.drift(scene, scene.times, answer.omega, attitude))


def _clock(run: Callable[[], Any], times: int = 1) -> float:
    start = time.thread_time()
    for _ in range(times):
        run()
    return (time.thread_time() - start) / times


def _first(point: Point, candidate: Candidate, scene: Scene, truth: Truth, limit: float) -> None:
    """Run once; a crash, a NaN and a run past its limit are answers too."""
    start = time.thread_time()
    try:
        answer = candidate.run(scene, point.value, limit)
        point.seconds, point.repeats = time.thread_time() - start, 1
        if not (np.isfinite(answer.omega).all() and np.isfinite(answer.attitude).all()):
            raise Failure("returned NaN or infinity")
    except Failure as failure:
        point.why = str(failure)
        return
    except Exception as error:   # a candidate may raise anything, and the others go on
        point.why = f"{type(error).__name__}: {error}".splitlines()[0]
        return
    errors = compute_errors(answer.omega, answer.attitude, truth)
    point.error, point.error_omega, point.error_attitude = errors.largest, errors.omega, errors.attitude
    point.stats, point.drift = answer.stats, compute_drift(scene, answer)


def _prediction(done: list[Point], value: float) -> float:
    """Seconds a run at a tighter value will take, from the runs before: a power law through the last two."""
    if not done:
        return 0.0
    last = done[-1]
    slope = 0.2
    if len(done) > 1 and done[-2].seconds > 0:
        slope = max(0.0, math.log(last.seconds / done[-2].seconds) / math.log(done[-2].value / last.value))
    return float(last.seconds * (last.value / value) ** slope)


def _sweep(candidate: Candidate, scene: Scene, truth: Truth, deadline: float) -> Iterable[Point]:
    """Run a candidate from its loosest setting to its tightest; what would not end in time is left out, and says so."""
    done: list[Point] = []
    late = ""
    for setting, value in candidate.settings:
        point = Point(candidate.name, candidate.family, setting, value)
        left = deadline - time.perf_counter()
        prediction = _prediction(done, value)
        if late:
            point.why, point.left_out = late, True
        elif prediction > left or left <= 0:
            late = point.why = f"would take about {prediction:.2g} s, and {max(left, 0):.2g} s were left"
            point.left_out = True
        else:
            _first(point, candidate, scene, truth, max(left, 0.05))
            if point.answered:
                done.append(point)
            elif point.why.startswith("not done within"):
                late = "a looser setting was not done in time"
        yield point


def _repeat(points: list[tuple[Point, Candidate]], scene: Scene, deadline: float) -> None:
    """Time all points again, in turn, so that a slow minute of the machine hits all of them alike."""
    readings: dict[int, list[float]] = {}
    plans = []
    for index, (point, candidate) in enumerate(points):
        calls = max(1, min(1000, int(SHORTEST / max(point.seconds, 1e-7))))
        plans.append((index, point, candidate, calls))
    plans.sort(key=lambda plan: plan[1].seconds)   # where time is short, the many quick ones are served
    for _ in range(ROUNDS):
        for index, point, candidate, calls in plans:
            if time.perf_counter() + point.seconds * calls > deadline:
                continue
            readings.setdefault(index, []).append(_clock(lambda: candidate.run(scene, point.value, None), calls))
    for index, (point, _) in enumerate(points):
        if index in readings:
            point.seconds, point.repeats = statistics.median(readings[index]), len(readings[index])


def measure(scene: Scene, title: str, candidates: list[Candidate], budget: float, report: Report) -> SceneResult:
    """Measure a scene within about `budget` seconds.

    Parameters
    ----------
    scene : Scene
        With omega and attitude wanted.
    title : str
    candidates : list of Candidate
    budget : float
        Of wall time [s], for polhode's methods, other programs, and repeats, in these `SHARES`.
    report : callable
        Is told, in a few words, what is being done.
    """
    start = time.perf_counter()
    report("reference")
    truth = find_truth(scene)
    notes = [] if truth.kind == "stored" else [f"reference: {truth.source}, {truth.uncertainty:.1e}"]
    points: list[Point] = []
    waiting = Counter(c.family for c in candidates if not c.refuses(scene))
    for candidate in candidates:
        reason = candidate.refuses(scene)
        if reason:
            if candidate.family == "peer":
                notes.append(f"{candidate.name}: {reason}")
            continue
        report(candidate.name)
        waiting[candidate.family] -= 1   # those of a family who are left share its time
        now = time.perf_counter()
        own = (start + SHARES[candidate.family] * budget - now) / (waiting[candidate.family] + 1)
        points += _sweep(candidate, scene, truth, now + max(own, LEAST * budget))
    report("repeats")
    by_name = {candidate.name: candidate for candidate in candidates}
    deadline = max(start + budget, time.perf_counter() + LEAST * budget)
    _repeat([(p, by_name[p.candidate]) for p in points if p.answered], scene, deadline)
    return SceneResult(scene, title, truth, points, notes, time.perf_counter() - start)
