"""(c) Gimbal lock: the axis comes near the vertical, where the textbook's angles end."""

from __future__ import annotations

from collections.abc import Iterator

from .. import scenes
from ..entrants import Entrant
from ..family import WRONG, Family, Point, Verdict, judge_no_answer, measure_cases, to_short, tried_points

STEP = 1e-3    # s, a 1500th of a turn: what is left is the angles' doing
NOISE = 1e-10  # rad: below this a ratio says nothing


def measure(entrant: Entrant, quick: bool, limit: float) -> Iterator[Point]:
    """The error over 20 s for each least tilt."""
    tilts = scenes.GIMBAL[::2] + scenes.GIMBAL[-1:] if quick else scenes.GIMBAL
    cases = [scenes.gimbal(kind, tilt) for kind in ("free", "top") for tilt in tilts]
    yield from measure_cases("gimbal", cases, entrant, limit, lambda case: entrant.setting(step=STEP))


def judge(points: list[Point]) -> Verdict:
    """By how much worse it gets towards the vertical."""
    if (none := judge_no_answer(points)) is not None:
        return none
    worst, error = 0.0, 0.0
    for series in {p.series for p in tried_points(points)}:
        sweep = [p for p in tried_points(points) if p.series == series]
        far = max(sweep, key=lambda p: p.x).get("error")
        near = max(p.get("error") for p in sweep)
        error = max(error, near)
        worst = max(worst, near / max(far, NOISE))
    if error > WRONG:   # lost at any theta, or burst
        return Verdict("fails", "burst" if error > 1e3 else "lost", error, f"largest error {to_short(error)} rad")
    level = "holds" if worst <= 2 else "degrades"
    text = "blind" if worst <= 2 else f"x {to_short(worst)}"
    return Verdict(level, text, worst, f"largest error {to_short(error)} rad")


FAMILY = Family(
    name="gimbal", title="Gimbal lock: the axis passes near the vertical", summary="gimbal\nlock",
    sweeps="the least angle to the vertical, theta = 0.5 to 1e-3: a free disk and a heavy top, 20 s, "
           "fixed steps 1e-3 s",
    truth="113-bit Taylor series",
    holds="the error at every theta within twice that at 0.5 (or below 1e-10)",
    degrades="not lost (0.1 rad) at any theta",
    number="blind to the tilt, or how many times the error at 0.5 rad",
    about="The textbook's three angles are undefined where the body's axis is vertical. Lagrange's equations "
          "divide by the sine of its tilt. Methods that carry a quaternion hardly notice. Methods that carry "
          "angles need shorter steps, or cross the barrier and burst.",
    measure=measure, judge=judge, x_label="least angle to the vertical [rad]", x_inverted=True,
    y="error", y_label="largest error over 20 s [rad]", series=(("free", "a free disk"), ("top", "a heavy top")),
    y_limits=(1e-16, 10.0),
)
