"""results.json: machine, versions, and every point of a chart."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np

from .._core import build_info
from .._harness.machine import machine, versions
from .._harness.truth import to_json
from .._scene.scene import Scene
from . import peers as peer_list
from .findings import dominated, headline, stopped, without_answer
from .measure import Point, SceneResult

FORMAT = "polhode chart 3"
MEASURE = ("error: over all samples, the larger of |omega - truth| / max |truth| and the angle of the rotation between "
           "the attitudes [rad]; seconds: CPU time of the thread for all samples, median of the repeats, taken in turn "
           "with all others, fastest and slowest among them; startups: wall seconds before and above the first answer, "
           "such as for a compiler; variables: in which the equations are stepped; right_hand_side: where they are "
           "evaluated; stopped_at: the tightest setting that ran, where the budget of time left out tighter ones; "
           "drift: largest move of each invariant from its start, relative; error per turn at "
           "1/60 s: of the attitude of a method with a fixed step, over ten turns at the start's rate [rad]")


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _point(point: Point) -> dict[str, Any]:
    return {
        "candidate": point.candidate, "family": point.family, "setting": point.setting, "swept": point.swept,
        "value": point.value,
        "status": "left out" if point.left_out else "failed" if point.why else "answered", "why": point.why,
        "error": _number(point.error), "error_omega": _number(point.error_omega),
        "error_attitude": _number(point.error_attitude), "seconds": _number(point.seconds),
        "fastest": _number(point.fastest),
        "slowest": _number(point.slowest), "repeats": point.repeats,
        "counts": dict(point.stats), "drift": {name: _number(value) for name, value in point.drift.items()},
    }


def _scene(scene: Scene) -> dict[str, Any]:
    torques = ", ".join(re.sub(r"(?<!^)(?=[A-Z])", " ", type(torque).__name__).lower() for torque in scene.torques)
    if scene.rotors:
        torques = ", ".join(filter(None, [torques, "rotors"]))
    return {"moments": [float(v) for v in scene.inertia.moments], "omega": [float(v) for v in scene.omega],
            "torques": torques}


def document(results: list[SceneResult], seconds: float, files: list[str], with_peers: bool = True) -> dict[str, Any]:
    """Return the content of results.json; numbers that are not finite are null."""
    return {
        "format": FORMAT, "measure": MEASURE, "seconds": seconds, "polhode": build_info(), "machine": machine(),
        "versions": versions() | peer_list.here(), "missing": peer_list.missing() if with_peers else {}, "files": files,
        "scenes": [
            {"name": r.scene.name, "title": r.title, "samples": int(r.scene.times.size),
             "span": float(np.ptp(np.append(r.scene.times, r.scene.t0))), "scene": _scene(r.scene),
             "reference": to_json(r.truth), "finding": headline(r),
             "candidates": {name: {"variables": variables, "right_hand_side": where, "stopped_at": stopped(r, name)}
                            for name, (variables, where) in r.about.items()
                            if any(p.candidate == name for p in r.points)},
             "error_per_turn_at_60_hz": {name: _number(value) for name, value in r.per_turn.items()},
             "dominated": sorted(dominated(r)), "without_answer": without_answer(r), "startups": r.startups,
             "notes": r.notes, "seconds": r.seconds, "points": [_point(p) for p in r.points]}
            for r in results
        ],
    }
