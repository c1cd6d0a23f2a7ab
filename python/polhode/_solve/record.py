"""What a file keeps of a motion, and the words about what a motion misses."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .._scene.plain import to_plain
from .ticks import list_arrays

if TYPE_CHECKING:
    from .motion import Motion


def list_samples(motion: Motion[Any, Any]) -> dict[str, npt.NDArray[np.float64]]:
    """Return the samples and their bounds by name."""
    names = ("omega", "attitude", "omega_lower", "omega_upper", "attitude_lower", "attitude_upper")
    arrays = {name: array for name in names if (array := getattr(motion, name)) is not None}
    for part in ("states", "states_lower", "states_upper"):
        arrays |= {f"{part}.{name}": array for name, array in (getattr(motion, part) or {}).items()}
    return arrays


def describe(motion: Motion[Any, Any]) -> dict[str, Any]:
    """Return everything but the arrays, for JSON."""
    plan = {key: value for key, value in vars(motion.plan).items() if key not in ("scene", "_report", "_made")}
    plan["pieces"] = [piece._asdict() for piece in motion.plan.pieces]
    hits = [[hit.event, hit.t, list(hit.omega), list(hit.attitude),
             *([{name: np.asarray(value).tolist() for name, value in hit.states.items()}] if hit.states else [])]
            for hit in motion.events]
    # The drift of the energy needs the potential of an own torque, which no file holds.
    return {"kind": "motion", "scene": to_plain(motion.scene), "drift": motion.drift, "options": motion.options,
            "plan": plan, "status": motion.status, "message": motion.message, "stats": motion.stats,
            "error": motion.error, "error_kind": motion.error_kind, "asked": motion.asked,
            "proved_span": motion.proved_span, "events": hits}


def record(motion: Motion[Any, Any]) -> tuple[dict[str, Any], dict[str, npt.NDArray[np.float64]]]:
    """Return all that a file keeps: what goes into JSON, and the arrays."""
    return describe(motion), {"t": motion.t, **list_samples(motion), **list_arrays(motion.ticks)}


def same_record(mine: tuple[dict[str, Any], dict[str, Any]], theirs: tuple[dict[str, Any], dict[str, Any]]) -> bool:
    """Return whether two records differ in nothing but the seconds that they took."""
    def words(about: dict[str, Any]) -> str:
        stats = {key: value for key, value in about.get("stats", {}).items() if key != "seconds"}
        return json.dumps({**about, "stats": stats}, sort_keys=True)

    (one, arrays), (other, others) = mine, theirs
    return (arrays.keys() == others.keys() and words(one) == words(other)
            and all(np.array_equal(arrays[name], others[name], equal_nan=arrays[name].dtype.kind == "f")
                    for name in arrays))


def describe_drift(motion: Motion[Any, Any]) -> str:
    """Return which invariant drifted by more than was asked; empty where none did."""
    drifted = {name: value for name, value in motion.drift.items() if not value <= motion.asked}
    if not drifted:
        return ""
    name = max(drifted, key=lambda key: drifted[key])
    return f"{name} drifted by {drifted[name]:.2g} (relative), more than the requested {motion.asked:.2g}"


def describe_columns(motion: Motion[Any, Any]) -> str:
    """Return the columns of `sensitivity` whose error is above the accuracy of the call; empty where there are none."""
    error = None if motion.sensitivity is None else motion.sensitivity.error
    if motion.sensitivity is None or error is None or not len(error) or math.isnan(motion.asked):
        return ""
    missed = int(np.sum(~(error <= motion.asked)))
    if not missed:
        return ""
    if motion.sensitivity.uncertain:
        return f"the sensitivity is not certain: {motion.sensitivity.uncertain}"
    worst = int(np.argmax(np.nan_to_num(error, nan=np.inf)))
    return (f"the sensitivity misses the accuracy of {motion.asked:.3g} in {missed} of {len(error)} columns; the "
            f"largest error is {error[worst]:.2g}, of {motion.sensitivity.columns[worst]}")
