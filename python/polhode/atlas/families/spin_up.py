"""(f) Spin-up: a thruster left on, whose turns grow as the square of the time."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ..._harness.truth import Truth
from ..._solve.motion import Motion
from .. import scenes
from ..case import Case, truth_of
from ..entrants import PER_TURN, Entrant
from ..family import WRONG, Family, Point, Verdict, judge_no_answer, measure_cases, to_short, tried_points

BRIEF = 1e-3   # seconds: less says nothing about a forecast


def measure(entrant: Entrant, quick: bool, limit: float) -> Iterator[Point]:
    """The error over the whole span; a fixed step is a 40th of the last, fastest turn."""
    def setting(case: Case) -> dict[str, float]:
        fastest = float(np.linalg.norm(truth_of("spin-up", case).omega, axis=1).max())
        return entrant.setting(step=2 * math.pi / fastest / PER_TURN)

    spans = scenes.SPIN_UP[:2] if quick else scenes.SPIN_UP
    yield from measure_cases("spin-up", map(scenes.spin_up, spans), entrant, limit, setting, foreseen)


def foreseen(motion: Motion, truth: Truth) -> dict[str, float]:
    """What a plan expected of the time."""
    seconds = motion.plan.predicted_seconds
    return {"foreseen": seconds} if math.isfinite(seconds) else {}


def judge(points: list[Point]) -> Verdict:
    """By the error over the longest time reached."""
    if (none := judge_no_answer(points)) is not None:
        return none
    worst = max(p.get("error") for p in tried_points(points))
    level = "holds" if worst <= 1e-6 else "degrades" if worst <= WRONG else "fails"
    longest = max(p.x for p in tried_points(points))
    why = f"up to {to_short(longest)} s" if any(p.status == "left out" for p in points) else ""
    times = [p.get("foreseen") / p.get("took") for p in tried_points(points) if p.values.get("took", 0.0) > BRIEF]
    if times and not math.isnan(min(times)):
        why = f"its plan foresaw {min(times):.1f} to {max(times):.1f} times the time it took"
    return Verdict(level, to_short(worst) if worst <= WRONG else "lost", worst, why)


FAMILY = Family(
    name="spin-up", title="Spin-up: a thruster left on", summary="spin-up",
    sweeps="the time it burns, 1e2 to 1e4 s: 50 to 460 thousand turns (quick: to 1e3 s); "
           "fixed steps 40 to the last turn",
    truth="113-bit Taylor series, the longest time in 64 bits",
    holds="error within 1e-6 over every time", degrades="within 0.1",
    number="largest error",
    about="A constant torque in body axes spins the body up. The turns grow as the square of the time, so "
          "nearly all the work is at the end. A step that was right at the start is wrong by then. Fixed steps "
          "are chosen here for the last turn.",
    measure=measure, judge=judge, cost=165, x_label="time it burns [s]", y="error", y_label="largest error [rad]",
    lines=((1e-6, "holds"), (WRONG, "lost")), y_limits=(1e-16, 10.0),
)
