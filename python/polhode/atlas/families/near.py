"""(h) Near-spheres and near-symmetric bodies: formulas divide by differences of moments."""

from __future__ import annotations

from collections.abc import Iterator

from .. import scenes
from ..entrants import Entrant
from ..family import WRONG, Family, Point, Verdict, judge_no_answer, measure_cases, to_short, tried_points


def measure(entrant: Entrant, quick: bool, limit: float) -> Iterator[Point]:
    """The error after 1000 turns for each difference of moments."""
    gaps = scenes.NEAR[::3] if quick else scenes.NEAR
    cases = [scenes.near(kind, gap) for kind in ("sphere", "symmetric") for gap in gaps]
    yield from measure_cases("near", cases, entrant, limit)


def judge(points: list[Point]) -> Verdict:
    """By the largest error over all differences."""
    if (none := judge_no_answer(points)) is not None:
        return none
    worst = max(p.get("error") for p in tried_points(points))
    level = "holds" if worst <= 1e-9 else "degrades" if worst <= WRONG else "fails"
    return Verdict(level, to_short(worst) if worst <= WRONG else "lost", worst)


FAMILY = Family(
    name="near", title="Nearly spherical and nearly symmetric bodies", summary="near\nsymmetry",
    sweeps="the relative difference d of two moments, 1e-2 to 1e-15 and 0; 1000 turns, fixed steps 40 a turn",
    truth="closed form with 110 digits",
    holds="error within 1e-9 for every d", degrades="within 0.1",
    number="largest error",
    about="Closed forms divide by differences of moments, and steppers do not. Their formulas may break for a "
          "body that is almost a sphere or almost symmetric. The error must stay small as the difference goes "
          "to zero, and at zero itself.",
    measure=measure, judge=judge, cost=4, x_label="difference of moments d", x_inverted=True, x_scale="list",
    y="error", y_label="error after 1000 turns [rad]",
    series=(("sphere", "moments 1, 1 + d, 1 + 2d"), ("symmetric", "moments 1, 1 + d, 0.5")),
    lines=((1e-9, "holds"), (WRONG, "lost")), y_limits=(1e-16, 10.0),
)
