"""(i) Scales: the same motion of a grain of dust and of a planet, in any units."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ..._harness.truth import Truth, compute_errors
from ..._scene.scene import Scene
from ..._solve.motion import Motion
from ...torques import Gravity
from ..case import turn_of
from ..entrants import PER_TURN, Entrant
from ..family import Family, Point, Verdict, judge_no_answer, to_short, tried_points
from ..run import Failed, Refused, run

POWERS = (-150, -120, -100, -60, -30, -12, 12, 30, 60, 100, 120, 150)
QUICK = (-150, -60, -12, 12, 60, 150)
TURNS = 10
PROBLEMS = [(name, what) for name in ("S1", "S4") for what in ("inertia", "rates")]


def scaled(name: str, what: str, power: int) -> Scene:
    """S1 or S4 through ten turns, with inertia (and torque), or rates and 1/time (and torque), times about 10^power.

    A power of two, so that the scaled numbers are the same numbers.
    """
    factor = 2.0 ** round(power / math.log10(2.0))
    base = Scene.load(name)
    inertia = np.diag(base.inertia.matrix)
    heavier, faster = (factor, 1.0) if what == "inertia" else (1.0, factor)
    # Weight, and not the arm, takes the scale; above 1e308 there is no such number, so it is split between the two.
    torques = [Gravity(t.weight * heavier * faster, tuple(a * faster for a in t.arm)) for t in base.torques]
    times = np.linspace(0, TURNS * turn_of(base), 11) / faster
    return Scene(inertia=inertia * heavier, omega=base.omega * faster, attitude=base.attitude,
                 torques=torques, times=times)


def _run(entrant: Entrant, scene: Scene, limit: float) -> Motion:
    return run(entrant, scene, entrant.setting(step=turn_of(scene) / PER_TURN, rtol=1e-12), limit)


def measure(entrant: Entrant, quick: bool, limit: float) -> Iterator[Point]:
    """How far the scaled answers are from the plain ones: the worst of two scenes and two scalings."""
    plain, refusal = {}, ""
    for name, what in PROBLEMS:
        try:
            plain[name, what] = _run(entrant, scaled(name, what, 0), limit)
        except (Refused, Failed) as why:
            refusal = str(why)
    if not plain:
        yield Point(0.0, status="refused", why=refusal)
        return
    for power in QUICK if quick else POWERS:
        point = Point(float(power), values={"error": 0.0})
        for (name, what), motion in plain.items():
            try:
                error = _difference(entrant, name, what, power, motion, limit)
                point.values["error"] = max(point.values["error"], error)
            except (Refused, Failed, ValueError) as why:   # ValueError: no such scene can be made
                named = 0.0 if "NaN" in str(why) else 1.0
                point.values["named"] = min(named, point.values.get("named", 1.0))
                point.status, point.why = "failed", f"{name}, {what}: {why}"
        yield point


def _difference(entrant: Entrant, name: str, what: str, power: int, plain: Motion, limit: float) -> float:
    scene = scaled(name, what, power)
    motion = _run(entrant, scene, limit)
    assert plain.omega is not None and plain.attitude is not None
    assert motion.omega is not None and motion.attitude is not None
    slower = float(scene.times[-1] / plain.t[-1])
    truth = Truth(plain.omega, plain.attitude, "", "", 0.0, None)
    return compute_errors(motion.omega * slower, motion.attitude, truth).largest


def judge(points: list[Point]) -> Verdict:
    """By the largest difference; a refusal with a reason is not a wrong answer, but not one that holds."""
    if (none := judge_no_answer(points)) is not None:
        return none
    tried = tried_points(points)
    wrong = max((p.get("error") for p in tried if p.status == "answered"), default=math.inf)
    refused = [p for p in tried if p.status == "failed"]
    silent = [p for p in refused if not p.values.get("named")]
    if wrong > 1e-12 or silent:
        return Verdict("fails", to_short(wrong) if wrong > 1e-12 else "NaN", wrong, silent[0].why if silent else "")
    if refused:
        least = min(abs(p.x) for p in refused)
        return Verdict("degrades", f"not 1e{least:.0f}", least, refused[0].why)
    return Verdict("holds", to_short(wrong) if wrong else "same bits", wrong)


FAMILY = Family(
    name="scales", title="Scales: the same motion in any units", summary="scales",
    sweeps="inertia, or rates and 1/time, times 1e-150 to 1e150, on ten turns of scenes S1 and S4",
    truth="the same method's answer without the factor (a power of two)",
    holds="the same answer to 1e-12 at every scale", degrades="or, at some scales, an error that says why",
    number="largest difference",
    about="The same motion in other units must be the same motion: grams or tonnes, seconds or years. The "
          "factors are powers of two. A method that scales its work returns exactly the same bits.",
    measure=measure, judge=judge, x_label="power of ten of the factor", x_scale="linear",
    y="error", y_label="difference from the plain answer", y_limits=(1e-17, 10.0),
    lines=((1e-12, "holds"),),
)
