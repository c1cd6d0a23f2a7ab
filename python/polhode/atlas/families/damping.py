"""(e) Damping, from mild to very stiff: what 1e-6 costs when one rate dies at once."""

from __future__ import annotations

import time
from collections.abc import Iterator

from ..._scene.scene import Scene
from .. import scenes
from ..case import Case, truth_of
from ..entrants import Entrant
from ..family import Family, Point, Verdict, judge_no_answer, tried_points
from ..run import Failed, Refused, run, values_of

GOAL = 1e-6
FEW_STEPS = 10_000    # steps
ASKEW = 1e9       # where S7b stands among the strengths: behind them all
TOLERANCES = (1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)
STEPS = (1e3, 1e4, 1e5, 1e6, 1e7)


def _settings(entrant: Entrant, scene: Scene, quick: bool) -> list[dict[str, float]]:
    """From loose to tight."""
    if entrant.kind == "solve":
        return [{"accuracy": GOAL}]
    if entrant.fixed:
        return [{"step": float(scene.times.max()) / n} for n in (STEPS[:-1] if quick else STEPS)]
    return [{"rtol": rtol} for rtol in TOLERANCES]


def _reach(entrant: Entrant, case: Case, quick: bool, limit: float) -> Point:
    """The loosest setting that reaches the goal, and what it costs."""
    point, end = Point(case.x, case.series), time.thread_time() + limit
    truth = truth_of("damping", case)
    why = ""
    for setting in _settings(entrant, case.scene, quick):
        try:
            motion = run(entrant, case.scene, setting, max(end - time.thread_time(), 0.05))
        except Refused as refusal:
            point.status, point.why = "refused", str(refusal)
            return point
        except Failed as failure:
            why = f"{next(iter(setting))} {next(iter(setting.values())):.0e}: {failure}"
            if failure.late:
                break
            continue
        why = ""   # what broke off was longer steps
        values = values_of(motion, truth) | {"setting": next(iter(setting.values()))}
        if not point.values or values["error"] < point.values["error"]:
            point.values = values
        if values["error"] <= GOAL:
            return point
    point.status = "failed"
    if point.values:
        best = f"best error {point.values['error']:.1e}, at {next(iter(setting))} {point.values['setting']:.0e}"
        why = f"{best}; {why}" if why else best
    point.why = why
    return point


def measure(entrant: Entrant, quick: bool, limit: float) -> Iterator[Point]:
    """What 1e-6 costs for each strength, and on S7b, whose damping is not along the axes."""
    cases = [scenes.damped(c) for c in (scenes.STIFF[::2] if quick else scenes.STIFF)]
    refused = False
    for case in [*cases, Case(ASKEW, Scene.load("S7b"))]:
        if refused:
            return
        point = _reach(entrant, case, quick, limit)
        refused = point.status == "refused"
        yield point
        if point.status == "failed":   # harder ones are not easier
            return


def to_few(count: int) -> str:
    """1234567 -> '1.2M', 800000 -> '800k', 350 -> '350'."""
    for word, size in (("M", 1e6), ("k", 1e3)):
        if count >= size:
            return f"{count / size:.1f}{word}" if count < 9.95 * size else f"{count / size:.0f}{word}"
    return str(count)


def judge(points: list[Point]) -> Verdict:
    """By whether 1e-6 is reached, and by the steps it takes."""
    if (none := judge_no_answer(points)) is not None:
        return none
    tried = tried_points(points)
    failed = [p for p in tried if p.status == "failed"]
    if failed:
        first = min(failed, key=lambda p: p.x)
        reached = [p.x for p in tried if p.status == "answered" and p.x < first.x]
        text = f"to c = {max(reached):.0e}".replace("e+0", "e") if reached else "never"
        text = "not S7b" if first.x == ASKEW else text
        return Verdict("fails", text, max(reached, default=0.0), first.why)
    steps = max(int(p.values["steps"]) for p in tried)
    level = "holds" if steps <= FEW_STEPS else "degrades"
    return Verdict(level, f"{to_few(steps)} steps", steps)


FAMILY = Family(
    name="damping", title="Damping, mild to very stiff: what an error of 1e-6 costs", summary="stiff\ndamping",
    sweeps="strength c of the damping about one axis, 1e1 to 1e6 N m s, 10 s; and scene S7b, damped askew",
    truth="113-bit Gauss collocation of order 24; S7b: the scene's stored truth",
    holds="1e-6 within 10,000 steps for every c and on S7b", degrades="1e-6 reached, at any cost within the time limit",
    number="most steps that 1e-6 takes, or how far it gets",
    about="One rate decays at once and follows the others from then on. An explicit method still takes steps "
          "short enough for that rate. Its cost grows with the damping; the cost of a stiffly stable method "
          "does not. Scene S7b damps about axes that are not the body's.",
    measure=measure, judge=judge, cost=53, x_label="damping c [N m s]", y="steps", y_label="steps for an error of 1e-6",
    x_scale="list", tick_names=((ASKEW, "S7b"),), lines=((FEW_STEPS, "holds"),),
    takes=lambda entrant: "no closed form" if entrant.kind in ("exact", "witness") else "",
)
