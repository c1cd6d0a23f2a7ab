"""One entrant on one scene: a result, or the reason why there is none."""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np

from .._core import IntegrationFailure, InvalidInput
from .._harness.formulas import to_formulas, why_no_formulas
from .._harness.truth import Truth, compute_errors
from .._scene.scene import Scene
from .._solve.motion import Motion
from .._solve.solve import solve
from .entrants import Entrant


class Refused(Exception):
    """The entrant says before it starts that the scene is not for it."""


class Failed(Exception):
    """The run broke off; `motion` is what there is."""

    def __init__(self, why: str, late: bool = False) -> None:
        super().__init__(why)
        self.late = late   # out of time: nothing is said about the method


def run(entrant: Entrant, scene: Scene, setting: dict[str, float], limit: float, partial: bool = False) -> Motion:
    """Solve, within `limit` seconds of the thread's time; `partial`: the first samples will do.

    Raises
    ------
    Refused
        Where `solve` refuses the scene for this method.
    Failed
        When the end was not reached, or what came back is not finite.
    """
    if entrant.kind == "formula":
        if why := why_no_formulas(scene):
            raise Refused(why)
        scene = to_formulas(scene)
    end = time.thread_time() + limit

    def in_time(reached: float, last: float) -> bool:
        return time.thread_time() < end

    try:
        options: dict[str, Any] = {**entrant.options, **setting}
        motion = solve(scene, max_steps=2**62, progress=in_time, **options)
    except InvalidInput as error:
        raise Refused(str(error)) from None
    except IntegrationFailure as error:
        raise Failed(str(error)) from None
    if motion.status == "stopped":
        raise Failed(f"not done within {limit:g} s", late=True)
    if motion.status not in ("finished", "event"):
        raise Failed(motion.message.split(";")[0])
    if not partial and motion.t.size < scene.times.size:
        raise Failed(f"ended at t = {motion.t[-1] if motion.t.size else scene.t0:.3g} s: {motion.message}")
    for array in (motion.omega, motion.attitude):
        if array is None or not np.isfinite(array).all():
            raise Failed("returned NaN")
    return motion


def values_of(motion: Motion, truth: Truth | None) -> dict[str, Any]:
    """What is written down of a run: errors against the truth and as stated, drift, steps."""
    values: dict[str, Any] = {"steps": motion.stats["steps"]}
    if truth is not None:
        assert motion.omega is not None and motion.attitude is not None
        errors = compute_errors(motion.omega, motion.attitude, truth)
        values |= {"error": errors.largest, "omega": errors.omega, "attitude": errors.attitude}
    values |= motion.drift
    if math.isfinite(motion.error):
        values["stated"] = motion.error
        values["claims"] = float(motion.success)
    return values
