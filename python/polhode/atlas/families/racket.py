"""(b) The racket: a block thrown about its intermediate axis turns over, and over, and the times are hard to know."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ..._harness.truth import Truth, attitude_errors
from ..._solve.motion import Motion
from .. import scenes
from ..case import Case, stored, turn_of
from ..entrants import PER_TURN, Entrant
from ..family import WRONG, Family, Point, Verdict, judge_no_answer, measure_cases, to_short, tried_points
from ..run import Failed, Refused, run


def find_flip(motion: Motion, flip: float, slope: float) -> float:
    """The error of the zero of omega_y that lies near `flip` [s]; NaN when there is none within half a second.

    Samples are 0.01 s apart, `flip` in the middle: there a small error is read off without interpolation.
    """
    assert motion.omega is not None
    t, y = motion.t, motion.omega[:, 1]
    middle = t.size // 2
    direct = y[middle] / slope
    if abs(direct) < 1e-5:
        return float(-direct)
    crossings = np.flatnonzero(np.signbit(y[1:]) != np.signbit(y[:-1]))
    if crossings.size == 0:
        return math.nan
    k = int(np.clip(crossings[np.argmin(np.abs(t[crossings] - flip))], 1, t.size - 3))
    times, rates = t[k - 1:k + 3] - flip, y[k - 1:k + 3]
    roots = np.roots(np.polyfit(times, rates, 3))
    real = roots[np.abs(roots.imag) < 1e-9].real
    return float(real[np.argmin(np.abs(real - 0.5 * (times[1] + times[2])))]) if real.size else math.nan


def measure(entrant: Entrant, quick: bool, limit: float) -> Iterator[Point]:
    """The attitude over 200 s, when it is lost, and the first flip."""
    for index, closeness in enumerate(scenes.RACKET):
        if quick and index % 2:
            continue
        case = scenes.racket(closeness)

        def lost(motion: Motion, truth: Truth, case: Case = case) -> dict[str, float]:
            assert motion.attitude is not None
            off = np.flatnonzero(attitude_errors(motion.attitude, truth) > WRONG)
            return {"lost": float(motion.t[off[0]])} if off.size else {}

        (point,) = measure_cases("racket", [case], entrant, limit, more=lost)
        if point.status == "answered":
            flip, slope = stored("racket/flips")[index]
            near = scenes.racket(closeness, flip + np.arange(-50, 51) * 0.01)
            setting = entrant.setting(step=turn_of(case.scene) / PER_TURN)
            try:
                point.values["flip"] = find_flip(run(entrant, near.scene, setting, limit), flip, slope)
            except (Failed, Refused) as why:
                point.values["flip_why"] = str(why)
        yield point


def judge(points: list[Point]) -> Verdict:
    """By the attitude for every closeness, then by the first flip."""
    if (none := judge_no_answer(points)) is not None:
        return none
    tried = tried_points(points)
    worst = max(p.get("error") for p in tried)
    if worst <= 1e-9:
        return Verdict("holds", to_short(worst), worst)
    flips = [abs(p.get("flip")) for p in tried]
    flip = math.inf if any(math.isnan(f) for f in flips) else max(flips)
    times = [float(p.values.get("lost", 0.0 if p.status == "failed" else math.inf)) for p in tried]
    lost = min(times)
    text = f"lost {lost:.0f} s" if math.isfinite(lost) and lost > 0 else ("burst" if lost == 0 else to_short(worst))
    if flip <= 1e-3:
        return Verdict("degrades", text, lost, f"first flip off by {to_short(flip)} s")
    return Verdict("fails", text, lost, f"first flip off by {to_short(flip)} s")


FAMILY = Family(
    name="racket", title="The racket: a throw about the intermediate axis", summary="racket",
    sweeps="how closely the intermediate axis is hit: omega = (e, 5, e) rad/s, e = 1e-1 to 1e-12, 200 s",
    truth="closed form with 110 digits; first flip to 1e-15",
    holds="attitude within 1e-9 rad for every e", degrades="the first flip within 1e-3 s for every e",
    number="largest error, or when the attitude is first lost",
    about="A body thrown about its intermediate axis flips again and again. Each flip loses information on how "
          "close the throw was. Explicit steps of high order find the first flip. The later flips depend on "
          "digits of the small rates that rounding removes. Methods that carry separatrix variables keep those "
          "digits, and a closed form needs none.",
    measure=measure, judge=judge, x_label="distance from the axis e [rad/s]", x_inverted=True,
    y="error", y_label="largest error over 200 s [rad]",
    also=(("flip", "first flip off by [s]", (1e-16, 10.0)),), lines=((1e-9, "holds"), (WRONG, "lost")),
    y_limits=(1e-16, 10.0),
)
