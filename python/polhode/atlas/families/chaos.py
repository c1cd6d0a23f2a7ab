"""(g) Chaos: how far ahead the motion can be known, and whether methods report it."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator

import numpy as np

from ..._harness.truth import Truth, attitude_errors
from .. import scenes
from ..case import stored
from ..entrants import Entrant
from ..family import WRONG, Family, Point, Verdict, judge_no_answer, to_short, too_long, tried_points
from ..run import run

TOLERANCES = tuple(10.0**-k for k in range(4, 17))
STEPS = tuple(10.0**-k for k in (1, 1.5, 2, 2.5, 3, 3.5, 4))


def measure(entrant: Entrant, quick: bool, limit: float) -> Iterator[Point]:
    """The time until the attitude is lost, for each tolerance or step."""
    rows, scene = stored("chaos"), scenes.chaos()
    truth = Truth(rows[:, :3], rows[:, 3:], "stored", "", 0.0, None)
    series = "step" if entrant.fixed else "tolerance"
    values = STEPS if entrant.fixed else TOLERANCES
    if entrant.kind == "solve":
        values = (1e-3, 1e-6, 1e-9)
    clock: list[tuple[float, float]] = []
    for value in [v for v in values if v >= 1e-3 or not entrant.fixed][::2] if quick else values:
        point = Point(value, series)
        if entrant.fixed and (why := too_long(clock, 1 / value, limit)):
            point.status, point.why = "left out", why
            yield point
            return
        begin = time.thread_time()
        with point.trying():
            motion = run(entrant, scene, entrant.setting(step=value, rtol=value, accuracy=value), limit, True)
            n = motion.t.size
            assert motion.attitude is not None
            known = Truth(truth.omega[:n], truth.attitude[:n], "stored", "", 0.0, None)
            off = np.flatnonzero(attitude_errors(motion.attitude, known) > WRONG)
            point.values = {"horizon": float(motion.t[off[0]] if off.size else motion.t[-1]),
                            "steps": motion.stats["steps"]}
            if math.isfinite(motion.error):
                point.values |= {"stated": motion.error, "claims": float(motion.success), "lost": float(off.size > 0)}
        clock.append((1 / value, time.thread_time() - begin))
        yield point
        if point.status in ("refused", "left out"):   # a finer one would take longer
            return


def judge(points: list[Point]) -> Verdict:
    """By the longest horizon any setting reaches."""
    if (none := judge_no_answer(points)) is not None:
        return none
    horizons = [p.get("horizon") for p in points if p.status == "answered"]
    if not horizons:
        return Verdict("fails", "burst", 0.0, tried_points(points)[0].why)
    best = max(horizons)
    for p in points:
        if p.values.get("lost") and p.values["claims"] and p.values["stated"] <= WRONG:
            said = f"says {to_short(p.values['stated'])} rad to the end, lost at {p.get('horizon'):.0f} s"
            return Verdict("fails", "overclaims", p.get("horizon"), said)
    level = "holds" if best >= 180 else "degrades" if best >= 60 else "fails"
    return Verdict(level, f"{best:.0f} s", best)


FAMILY = Family(
    name="chaos", title="Chaos: how long the answer can be known", summary="chaos",
    sweeps="tolerances 1e-4 to 1e-16, or steps 0.1 to 1e-4 s, on scene S5c carried on to 400 s",
    truth="113-bit Taylor series",
    holds="attitude within 0.1 rad for 180 s or longer at the best setting",
    degrades="for 60 s",
    number="until the attitude is lost, at the best setting",
    about="Neighbouring motions diverge in bursts. Each digit of the tolerance buys a few more seconds. Past "
          "the horizon of float64 no answer is reliable, whatever it costs.",
    measure=measure, judge=judge, cost=18, x_label="tolerance, or step [s]", x_inverted=True, y="horizon",
    y_label="time until the attitude is lost [s]", y_log=False, y_limits=(0.0, 300.0),
    x_labels=(("tolerance", "tolerance (of solve: accuracy)"), ("step", "step [s]")),
    series=(("tolerance", "against the tolerance"), ("step", "against the step")), failed_below=True,
    lines=((180.0, "holds"), (60.0, "degrades")),
    takes=lambda entrant: "no closed form" if entrant.kind in ("exact", "witness") else "",
)
