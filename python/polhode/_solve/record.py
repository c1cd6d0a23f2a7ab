"""What a file keeps of a motion."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .._scene.plain import to_plain

if TYPE_CHECKING:
    from .motion import Motion


def list_samples(motion: Motion) -> dict[str, npt.NDArray[np.float64]]:
    """Return the samples and their bounds by name."""
    names = ("omega", "attitude", "omega_lower", "omega_upper", "attitude_lower", "attitude_upper")
    arrays = {name: array for name in names if (array := getattr(motion, name)) is not None}
    for part in ("states", "states_lower", "states_upper"):
        arrays |= {f"{part}.{name}": array for name, array in (getattr(motion, part) or {}).items()}
    return arrays


def describe(motion: Motion) -> dict[str, Any]:
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
