"""(d) Long times: what grows with the number of turns, and how fast."""

from __future__ import annotations

from collections.abc import Iterator

from .. import scenes
from ..entrants import Entrant
from ..family import WRONG, Family, Point, Verdict, judge_no_answer, measure_cases, to_short, tried_points

SMALL_DRIFT = 1e-3   # relative


def measure(entrant: Entrant, quick: bool, limit: float) -> Iterator[Point]:
    """Energy, angular momentum and attitude after 1e2 to 1e6 turns."""
    turns = scenes.LONG[:3] if quick else scenes.LONG
    yield from measure_cases("long", map(scenes.long, turns), entrant, limit)


def judge(points: list[Point]) -> Verdict:
    """By the attitude after as many turns as were reached, then by what is conserved."""
    if (none := judge_no_answer(points)) is not None:
        return none
    last = max(tried_points(points), key=lambda p: p.x)
    error = last.get("error")
    drift = max(last.get("energy"), last.get("angular_momentum"))
    turns = f"after {to_short(last.x)} turns"
    why = f"{turns}: energy moved by {to_short(last.get('energy'))}, L by {to_short(last.get('angular_momentum'))}"
    if last.status == "failed":
        return Verdict("fails", "burst", error, f"{turns}: {last.why}")
    if error <= 1e-7:
        return Verdict("holds", to_short(error), error, why)
    if error <= WRONG or drift <= SMALL_DRIFT:
        return Verdict("degrades", to_short(error) if error <= WRONG else "phase lost", error, why)
    return Verdict("fails", "lost", error, why)


FAMILY = Family(
    name="long", title="Long times: a free block after up to a million turns", summary="long\ntimes",
    sweeps="turns, 1e2 to 1e6 (quick: to 1e4); fixed steps 40 a turn, tolerances 1e-14",
    truth="closed form with 110 digits",
    holds="attitude within 1e-7 rad after the longest time reached",
    degrades="attitude not lost (0.1 rad), or energy and angular momentum within 1e-3",
    number="error of the attitude after the longest time reached",
    about="A method can conserve energy and angular momentum to rounding for ever while its phase drifts. "
          "Conservation is not accuracy. The slope in this picture shows whether an error grows as the square "
          "of the time, as the time, or not at all.",
    measure=measure, judge=judge, cost=120, x_label="turns", y="error", y_label="error of the attitude [rad]",
    also=(("energy", "energy moved by, relative", (1e-16, 10.0)),
          ("angular_momentum", "angular momentum in space moved by, relative", (1e-16, 10.0))),
    lines=((1e-7, "holds"), (WRONG, "lost")), y_limits=(1e-16, 10.0),
)
