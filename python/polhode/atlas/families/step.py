"""(a) Needles and disks: the longest step with which the answer is still right."""

from __future__ import annotations

import bisect
import functools
import math
from collections.abc import Callable, Iterator

import numpy as np

from ..._core import FreeMotion
from ..._harness.truth import Truth, attitude_errors
from ..._scene.scene import Scene
from ..case import S1_MOMENTS
from ..entrants import Entrant
from ..family import WRONG, Family, Point, Verdict, fixed_only, judge_no_answer, to_short, tried_points
from ..run import Failed, run

STARTS = ((1.0, 1.0, 1.0), (1.0, 0.1, 0.1), (0.1, 1.0, 0.1), (0.1, 0.1, 1.0))
NEEDLES = (1e-1, 1e-2, 1e-3, 1e-4)
TURNS, TURNS_RIGHT = 100, 10
GOOD, FAIR = (2 * math.pi / count * (1 - 1e-9) for count in (64, 512))   # steps, as angles
PASSES = ("bounded", "kept", "right")
MODERATE = 512   # steps a turn, where the search begins


def bodies(quick: bool) -> list[tuple[float, tuple[float, float, float]]]:
    """(smallest moment over the middle one, moments), from a disk by way of S1's block to a needle."""
    needles = NEEDLES[::2] if quick else NEEDLES
    return [(1.0, (1.0, 1.001, 2.0)), (0.5, S1_MOMENTS), *((r, (r, 1.0, 1.0 + r / 2)) for r in needles)]


def steps_a_turn(quick: bool) -> list[int]:
    """From many steps to one, a factor 1.2 to 1.4 (quick: 2) apart."""
    ratio, first = (2.0, 1024) if quick else (math.sqrt(2.0), 4096)
    counts = {max(1, round(first / ratio**k)) for k in range(40)} | ({3, 5, 7, 9, 13} if not quick else set())
    return sorted(counts, reverse=True)


def passes(entrant: Entrant, scene: Scene, truth: Truth, step: float, limit: float) -> set[str]:
    """Which of the three hold with this step."""
    try:
        motion = run(entrant, scene, {"step": step}, limit)
    except Failed as why:
        if why.late:
            raise
        return set()
    assert motion.omega is not None and motion.attitude is not None
    inertia = np.diag(scene.inertia.matrix)
    energy = (motion.omega**2 @ inertia) / (scene.omega**2 @ inertia)
    size = np.sqrt((motion.omega**2 @ inertia**2) / (scene.omega**2 @ inertia**2))
    ratios = np.concatenate([energy, size])
    held = set()
    if ratios.max() <= 2 and ratios.min() >= 0.5:
        held.add("bounded")
    if np.abs(ratios - 1).max() <= 0.1:
        held.add("kept")
    if attitude_errors(motion.attitude, truth)[:TURNS_RIGHT].max() <= WRONG:
        held.add("right")
    return held


def limits(entrant: Entrant, moments: tuple[float, float, float], quick: bool, limit: float) -> dict[str, float]:
    """The longest step, as an angle h |omega|, before each of the three is first broken; the worst of four starts."""
    found = dict.fromkeys(PASSES, math.inf)
    for start in STARTS:
        omega = np.array(start) / np.linalg.norm(start)
        times = 2 * math.pi * np.arange(1, TURNS + 1)   # whole turns, which are ends of steps
        scene = Scene(inertia=moments, omega=omega, times=times)
        truth = Truth(*FreeMotion(moments, omega).at(times), "closed form", "", 0.0, None)
        best = _longest(steps_a_turn(quick), lambda count: passes(entrant, scene, truth, 2 * math.pi / count, limit))
        found = {name: min(found[name], best[name]) for name in PASSES}
    return found


def _longest(counts: list[int], held: Callable[[int], set[str]]) -> dict[str, float]:
    """The longest step before the first that fails, for each of the three; `counts` falls.

    From moderate steps on to longer ones until all fail. What fails at once is looked for among shorter steps, each
    half of those that are left: nothing fails with steps shorter than some that pass.
    """
    held = functools.cache(held)
    first = next(i for i, count in enumerate(counts) if count <= MODERATE)
    best, going = dict.fromkeys(PASSES, 0.0), set(PASSES)
    for count in counts[first:]:
        going &= held(count)
        best |= dict.fromkeys(going, 2 * math.pi / count)
        if not going:
            break
    for name in PASSES:
        if not best[name]:
            right = bisect.bisect_left(range(first), True, key=lambda i: name not in held(counts[i]))
            best[name] = 2 * math.pi / counts[right - 1] if right else 0.0
    return best


def measure(entrant: Entrant, quick: bool, limit: float) -> Iterator[Point]:
    """The longest step for every body."""
    for ratio, moments in bodies(quick):
        point = Point(ratio)
        with point.trying("left out"):
            point.values = dict(limits(entrant, moments, quick, limit))
        yield point


def judge(points: list[Point]) -> Verdict:
    """By the longest step that keeps the attitude, for the worst body."""
    if (none := judge_no_answer(points)) is not None:
        return none
    right, kept = (min(p.get(name) for p in tried_points(points)) for name in ("right", "kept"))
    level = "holds" if right >= GOOD else "degrades" if right >= FAIR else "fails"
    text = to_short(right) if right > 0 else "never"
    return Verdict(level, text, right, f"energy and |L| within 10 % to {to_short(kept)}")


FAMILY = Family(
    name="step", title="Needles and disks: the longest step that keeps the attitude", summary="longest\nstep",
    sweeps="inertia ratio, from a disk (1) by S1's block (0.5) to a needle (1e-4); "
           "steps from 4096 a turn (quick: 1024) to one",
    truth="closed form (FreeMotion)",
    holds="attitude within 0.1 rad over 10 turns for every body at 64 steps a turn", degrades="at 512 steps a turn",
    number="longest step, as an angle, for the worst body",
    about="The free equations are never stiff, since no moment differs from another by more than the third. The "
          "step is therefore limited as an angle, h times the rate. Bounded energy says little about accuracy, "
          "so the attitude decides.",
    measure=measure, judge=judge, cost=12, takes=fixed_only,
    x_label="smallest moment over the middle one", x_inverted=True,
    y="right", y_label="longest step h |omega| [rad]", failed_below=True,
    also=(("kept", "longest step with energy and |L| within 10 % [rad]", (1e-3, 10.0)),), y_limits=(1e-3, 10.0),
    lines=((GOOD, "holds"), (FAIR, "degrades")),
)
