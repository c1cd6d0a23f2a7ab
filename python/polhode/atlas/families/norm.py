"""(j) The quaternion's norm: errors of quaternions that are not normalised."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ..._scene.scene import Scene
from ..case import S1_MOMENTS
from ..entrants import Entrant
from ..family import Family, Point, Verdict, judge_no_answer, to_short, tried_points
from ..run import run

SPAN = 100.0
STEPS = (0.1, 0.03, 0.01, 0.003)
TOLERANCES = (1e-3, 1e-6, 1e-9, 1e-12)


def rk4_without_normalising(step: float, span: float = SPAN) -> float:
    """| |q| - 1 | of the classical Runge-Kutta method on S1's block, when nothing is done about it."""
    I1, I2, I3 = S1_MOMENTS
    gain = ((I2 - I3) / I1, (I3 - I1) / I2, (I1 - I2) / I3)

    def rate(y: tuple[float, ...]) -> tuple[float, ...]:
        p, q, r, x, u, v, w = y
        return (gain[0] * q * r, gain[1] * r * p, gain[2] * p * q, 0.5 * (w * p + u * r - v * q),
                0.5 * (w * q + v * p - x * r), 0.5 * (w * r + x * q - u * p), -0.5 * (x * p + u * q + v * r))

    def plus(y: tuple[float, ...], f: tuple[float, ...], h: float) -> tuple[float, ...]:
        return tuple(a + h * b for a, b in zip(y, f))

    y: tuple[float, ...] = (1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0)
    for _ in range(round(span / step)):
        a = rate(y)
        b = rate(plus(y, a, step / 2))
        c = rate(plus(y, b, step / 2))
        d = rate(plus(y, c, step))
        y = tuple(s + step / 6 * (f + 2 * g + 2 * h + k) for s, f, g, h, k in zip(y, a, b, c, d))
    return abs(math.sqrt(sum(c * c for c in y[3:])) - 1)


def measure(entrant: Entrant, quick: bool, limit: float) -> Iterator[Point]:
    """The worst of 501 samples, most of them between steps."""
    if entrant.kind == "witness":
        for step in STEPS[:3] if quick else STEPS:
            yield Point(step, "", {"norm": rk4_without_normalising(step), "steps": round(SPAN / step)})
        return
    scene = Scene(inertia=S1_MOMENTS, omega=(1.0, 2.0, 3.0), times=np.linspace(0, SPAN, 501))
    for step, rtol in zip(STEPS, TOLERANCES):
        point = Point(step, "")
        with point.trying("left out"):   # no quaternion, no norm
            motion = run(entrant, scene, entrant.setting(step=step, rtol=rtol, accuracy=rtol), limit)
            assert motion.attitude is not None
            point.values["norm"] = float(np.abs(np.linalg.norm(motion.attitude, axis=1) - 1).max())
            if not entrant.fixed and motion.stats["steps"]:
                point.x = SPAN / motion.stats["steps"]
        yield point


def judge(points: list[Point]) -> Verdict:
    """By the largest distance from 1 of what was returned."""
    if (none := judge_no_answer(points)) is not None:
        return none
    tried = [p for p in tried_points(points) if p.status == "answered"]
    worst = max((p.get("norm") for p in tried), default=math.inf)
    level = "holds" if worst <= 1e-15 else "degrades" if worst <= 1e-6 else "fails"
    return Verdict(level, to_short(worst), worst)


FAMILY = Family(
    name="norm", title="The quaternion's norm: normalised, and not", summary="norm of\nattitude",
    sweeps="the length of a step (of methods that choose theirs: the mean), S1's block, 100 s",
    truth="1",
    holds="every quaternion returned is unit within 1e-15", degrades="within 1e-6",
    number="largest difference of the norm from 1",
    about="A Runge-Kutta step leaves the unit sphere by its own error. The norm of a quaternion that is never "
          "normalised therefore shows the error of the attitude. Normalising hides the symptom and does not "
          "reduce that error.",
    measure=measure, judge=judge, x_label="step [s]", x_inverted=True, y="norm", y_label="largest | |q| - 1 |",
    y_limits=(3e-17, 1.0), lines=((1e-15, "holds"),), takes=lambda entrant: "",
)
