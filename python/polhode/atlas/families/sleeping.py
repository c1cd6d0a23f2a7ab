"""(k) The sleeping top: spun just fast enough to stand, or just not."""

from __future__ import annotations

import math
from collections.abc import Iterator

from .. import scenes
from ..case import stored, turn_of
from ..entrants import PER_TURN, Entrant
from ..family import Family, Point, Verdict, answered, nobody, to_short
from ..run import Failed, Refused, run


def measure(entrant: Entrant, quick: bool, limit: float) -> Iterator[Point]:
    """The greatest tilt within 200 s on both sides of the critical rate."""
    true = stored("sleeping")
    for index, excess in enumerate(scenes.SLEEPING):
        if quick and index % 2:
            continue
        case = scenes.sleeping(excess)
        point = Point(excess)
        try:
            motion = run(entrant, case.scene, entrant.setting(step=turn_of(case.scene) / PER_TURN), limit)
            assert motion.attitude is not None
            point.values["tilt"] = float(scenes.tilt(motion.attitude).max())
            point.values["true"] = float(true[index])
            point.values["off"] = abs(point.values["tilt"] / true[index] - 1)
        except Refused as why:
            point.status, point.why = "refused", str(why)
            yield point
            return
        except Failed as why:
            point.status, point.why = ("left out" if why.late else "failed"), str(why)
        yield point


def judge(points: list[Point]) -> Verdict:
    """By the greatest tilt against the true one, and by the side of the critical rate."""
    if (none := nobody(points)) is not None:
        return none
    tried = answered(points)
    off = max(p.get("off") for p in tried)
    ratio = max(math.inf if p.status == "failed" else abs(math.log(max(p.get("tilt"), 1e-300) / p.get("true")))
                for p in tried)
    if off <= 1e-3:
        return Verdict("holds", to_short(off), off)
    if ratio <= math.log(2.0):
        return Verdict("degrades", to_short(off), off)
    wrong = next(p for p in tried if p.status == "failed" or abs(math.log(max(p.get("tilt"), 1e-300) / p.get("true"))) > 0.69)
    text = "falls" if wrong.status == "failed" or wrong.get("tilt") > wrong.get("true") else "stays up"
    return Verdict("fails", text, off, wrong.why or f"at s = {wrong.x:g}: {wrong.get('tilt'):.2g} for {wrong.get('true'):.2g}")


FAMILY = Family(
    name="sleeping", title="The sleeping top: stands just above the critical rate, falls just below", summary="sleeping\ntop",
    sweeps="the rate's excess s over the critical one, 0.1 to -0.1, tilted by 1e-6 rad at the start, 200 s",
    truth="113-bit Taylor series",
    holds="the greatest tilt within a relative 1e-3 for every s", degrades="within a factor 2: it stands and falls as it should",
    measure=measure, judge=judge, x_label="excess over the critical rate", x_inverted=True, x_scale="list",
    y="tilt", y_label="greatest tilt within 200 s [rad]", y_limits=(3e-7, 10.0),
)
