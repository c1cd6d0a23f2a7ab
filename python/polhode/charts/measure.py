"""Measurement of one scene: every candidate at every setting once, then repeats, within a time limit."""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import numpy as np

from .. import _core
from .._harness.truth import Truth, compute_errors, find_truth
from .._scene.scene import Scene
from .candidate import Answer, Candidate, Failure
from .runners import InProcess, Runner

ROUNDS = 5
SHORTEST = 2e-3   # seconds of calls behind one reading of the clock
SWEEPS = 0.75     # of the budget: when the sweeps must have ended; then come repeats
LEAST = 0.1       # of the budget, for the repeats
CROWDED = 0.01    # of the budget: what a candidate gets when all the time is gone
WEIGHTS = {"cheap": 0.25, "peer": 1.5}   # of a candidate in the sweeps, by its family; 1 for the others

ENDS = ("not done within", "hung", "ended its process", "InvalidInput")   # failures that tighter settings share

Report = Callable[[str], object]


@dataclass
class Point:
    """One candidate at one setting. `why` is empty if it gave a result."""

    candidate: str
    family: str
    setting: str
    value: float
    swept: str = "rtol"         # what the value is: "rtol", "accuracy", "step" or "" for a closed form
    why: str = ""
    left_out: bool = False      # not run at all
    error: float = math.nan     # the larger of the two below
    error_omega: float = math.nan
    error_attitude: float = math.nan
    seconds: float = math.nan   # median of `repeats`, CPU time of the thread
    fastest: float = math.nan
    slowest: float = math.nan
    repeats: int = 0
    stats: dict[str, int] = field(default_factory=dict)
    drift: dict[str, float] = field(default_factory=dict)

    @property
    def answered(self) -> bool:
        """Whether there is an error and a time to show."""
        return not self.why


@dataclass
class SceneResult:
    """All points of a scene, and the truth they were compared with."""

    scene: Scene
    title: str
    truth: Truth
    points: list[Point]
    notes: list[str]
    seconds: float = 0.0
    startups: dict[str, float] = field(default_factory=dict)   # seconds before the first answer, beside that answer's
    about: dict[str, tuple[str, str]] = field(default_factory=dict)   # variables and right-hand side, by candidate
    per_turn: dict[str, float] = field(default_factory=dict)   # error per turn at 1/60 s [rad], by fixed-step method

    def of(self, candidate: str) -> list[Point]:
        """The points of one candidate that answered, from loose to tight."""
        return [p for p in self.points if p.candidate == candidate and p.answered]

    def names(self, *families: str) -> list[str]:
        """The candidates of these families that answered at least once."""
        return list(dict.fromkeys(p.candidate for p in self.points if p.answered and p.family in families))


def compute_drift(scene: Scene, answer: Answer) -> dict[str, float]:
    """Return the drift of each invariant, computed alike for all candidates from normalised quaternions."""
    attitude = answer.attitude / np.linalg.norm(answer.attitude, axis=1, keepdims=True)
    return dict(_core.drift(scene, scene.times, answer.omega, attitude))


def _first(point: Point, runner: Runner, scene: Scene, truth: Truth, limit: float) -> float:
    """Run once; a crash, a NaN and a run past its limit are answers too. Returns the seconds of warm-up."""
    try:
        answer, point.seconds, warm_up = runner.run(point.candidate, point.value, limit)
        if not (np.isfinite(answer.omega).all() and np.isfinite(answer.attitude).all()):
            raise Failure("returned NaN or infinity")
    except Failure as failure:
        point.why = str(failure)
        return 0.0
    point.fastest, point.slowest, point.repeats = point.seconds, point.seconds, 1
    errors = compute_errors(answer.omega, answer.attitude, truth)
    point.error, point.error_omega, point.error_attitude = errors.largest, errors.omega, errors.attitude
    point.stats, point.drift = answer.stats, compute_drift(scene, answer)
    return warm_up


def _prediction(done: list[Point], value: float) -> float:
    """Seconds a run at a tighter value will take, from the runs before: a power law through the last two."""
    if not done:
        return 0.0
    last = done[-1]
    slope = 0.2
    if len(done) > 1 and done[-2].seconds > 0:
        slope = max(0.0, math.log(last.seconds / done[-2].seconds) / math.log(done[-2].value / last.value))
    return float(last.seconds * (last.value / value) ** slope)


def _sweep(
    candidate: Candidate, runner: Runner, scene: Scene, truth: Truth, share: float,
    startups: dict[str, float]
) -> Iterable[Point]:
    """Run a candidate from its loosest setting to its tightest within a share of time; what would not end is left out,
    and says so. The first setting always has its try."""
    done: list[Point] = []
    late, tried = "", False
    try:
        startups[candidate.name] = runner.start(candidate.name)
    except Failure as failure:
        late = f"does not start: {failure}"
    deadline = time.perf_counter() + share
    for setting, value in candidate.settings(scene):
        point = Point(candidate.name, candidate.family, setting, value, candidate.swept)
        left = deadline - time.perf_counter()
        prediction = _prediction(done, value)
        if late:
            point.why, point.left_out = late, not late.startswith("does not start")
        elif tried and (prediction > left or left <= 0):
            late = point.why = f"would take about {prediction:.2g} s, and {max(left, 0):.2g} s were left"
            point.left_out = True
        else:
            tried = True
            warm_up = _first(point, runner, scene, truth, max(left, 0.05))
            if point.answered:
                if not done:
                    startups[candidate.name] += warm_up
                done.append(point)
            elif point.why.startswith(ENDS):
                late = "a looser setting was not done in time" if point.why.startswith("not done") else point.why
        yield point


def _repeat(points: list[Point], runner: Runner, deadline: float) -> None:
    """Time all points again, in turn, so that a slow minute of the machine hits all of them alike."""
    readings: dict[int, list[float]] = {}
    plans = []
    for index, point in enumerate(points):
        calls = max(1, min(1000, int(SHORTEST / max(point.seconds, 1e-7))))
        plans.append((index, point, calls))
    plans.sort(key=lambda plan: plan[1].seconds)   # where time is short, the many quick ones are served
    for _ in range(ROUNDS):
        for index, point, calls in plans:
            if time.perf_counter() + point.seconds * calls > deadline:
                continue
            try:
                readings.setdefault(index, []).append(runner.clock(point.candidate, point.value, calls))
            except Failure:   # it answered before: that answer and its time stand
                continue
    for index, point in enumerate(points):
        if readings.get(index):
            found = readings[index]
            point.seconds, point.repeats = statistics.median(found), len(found)
            point.fastest, point.slowest = min(found), max(found)


def measure(
    scene: Scene, title: str, candidates: list[Candidate], budget: float, report: Report,
    runner: Runner | None = None
) -> SceneResult:
    """Measure a scene within about `budget` seconds.

    Parameters
    ----------
    scene : Scene
        With omega and attitude wanted.
    title : str
    candidates : list of Candidate
    budget : float
        Of wall time [s]. The candidates share three quarters of it, what one leaves going to those after it; the rest
        is for repeats.
    report : callable
        Called with the present task in a few words.
    runner : InProcess, Subprocess or Both, optional
        Where the candidates run; this process without it.
    """
    start = time.perf_counter()
    report("reference")
    truth = find_truth(scene)
    notes = [] if truth.kind == "stored" else [f"reference: {truth.source}, {truth.uncertainty:.1e}"]
    runner = runner or InProcess(candidates)
    runner.enter(scene)
    taking_part = []
    for candidate in candidates:
        reason = candidate.refuses(scene)
        if not reason:
            taking_part.append(candidate)
        elif candidate.family != "exact":
            notes.append(f"{candidate.name}: {reason}")
    points: list[Point] = []
    startups: dict[str, float] = {}
    weights = [WEIGHTS.get(candidate.family, 1.0) for candidate in taking_part]
    for index, candidate in enumerate(taking_part):
        report(candidate.name)
        share = (start + SWEEPS * budget - time.perf_counter()) * weights[index] / sum(weights[index:])
        found = list(_sweep(candidate, runner, scene, truth, max(share, CROWDED * budget), startups))
        if found[0].why.startswith("InvalidInput"):   # not for this scene, which only the run itself can tell
            notes.append(f"{candidate.name}: {found[0].why.partition(': ')[2]}")
        else:
            points += found
    report("repeats")
    deadline = max(start + budget, time.perf_counter() + LEAST * budget)
    _repeat([p for p in points if p.answered], runner, deadline)
    about = {candidate.name: (candidate.variables(scene), candidate.right_hand_side) for candidate in taking_part}
    return SceneResult(scene, title, truth, points, notes, time.perf_counter() - start, startups, about)
