"""What an engine gets that steps a scene's body 60 times a second: the error of the attitude per turn."""

from __future__ import annotations

import math

import numpy as np

from .. import _core
from .._core import InvalidInput
from .._harness.truth import start_rate
from .._plot.text import to_error
from .._scene.scene import Scene
from .._solve.motion import Floats
from .._solve.solve import methods, solve
from .measure import SceneResult

STEP = 1 / 60     # s
TURNS = 10.0      # at most, within the scene's span
MOST_STEPS = 2e6
LOST = 0.5        # rad a turn
GOOD = 1e-8       # rad a turn
KNOWN = ("dmv8", "rk4", "midpoint", "split", "catto", "jolt")   # that the overview names


def _angle(p: Floats, q: Floats) -> float:
    near = min(float(np.linalg.norm(p - q)), float(np.linalg.norm(p + q)))
    return 4 * math.asin(min(1.0, near / 2))


def find_errors_per_turn(scene: Scene) -> dict[str, float]:
    """Return the attitude's error per turn [rad] of every method with a fixed step, at 1/60 s.

    The error is that after ten turns at the start's rate, or at the end of the scene's span, over the number of turns.
    NaN where a method gives no finite answer. Empty where the body starts at rest, or would take too many steps.
    """
    rate, span = start_rate(scene), float(scene.times[-1] - scene.t0)
    turns = min(TURNS, abs(span) * rate / (2 * math.pi)) if rate else 0.0
    if not turns or turns * 2 * math.pi / rate > MOST_STEPS * STEP:
        return {}
    end = scene.t0 + math.copysign(turns * 2 * math.pi / rate, span)
    short = scene.replace(times=np.array([end]), want=("attitude",))
    try:
        truth = solve(short, accuracy=1e-9, certify=False).attitude
    except (InvalidInput, _core.IntegrationFailure):
        return {}
    if truth is None:
        return {}
    found = {}
    for record in methods():
        name = record["name"]
        if record["adaptive"] or _core.method_refusal(name, short):
            continue
        motion = solve(short, method=name, step=STEP)
        if motion.status == "finished" and motion.attitude is not None and np.isfinite(motion.attitude).all():
            found[name] = _angle(motion.attitude[0], truth[0]) / turns
        else:
            found[name] = math.nan
    return found


def _error_of_long_steps(results: list[SceneResult], name: str) -> float:
    """Return the geometric mean of the errors at the longest step of each scene's sweep."""
    errors = []
    for result in results:
        points = [p for p in result.points if p.candidate == name]
        if not points or not points[0].answered:
            return math.inf
        errors.append(math.log(max(points[0].error, 1e-17)))
    return math.exp(sum(errors) / len(errors))


def engine_line(results: list[SceneResult]) -> str:
    """Return which engine's step to take at 1/60 s, and what others err: the worst errors per turn on free scenes.

    It errs by less than 1e-8 rad a turn on each, and least at the longest steps that the chart swept.
    """
    free = [result for result in results if result.per_turn and not result.scene.torques]
    names = [name for name in free[0].per_turn if all(name in some.per_turn for some in free)] if free else []
    worst = {name: max(math.inf if math.isnan(some.per_turn[name]) else some.per_turn[name] for some in free)
             for name in names}
    good = [name for name in names if worst[name] < GOOD and name in free[0].names("cheap")]
    if not good:
        return ""
    best = min(good, key=lambda name: _error_of_long_steps(free, name))
    others = [name for name in sorted(worst, key=lambda name: worst[name]) if name in KNOWN and name != best]
    words = [f"{name} {to_error(worst[name]) if worst[name] < LOST else 'lost'}" for name in (best, *others)]
    return f"For an engine at 1/60 s take {best}; error per turn on free bodies [rad]: {', '.join(words)}"
