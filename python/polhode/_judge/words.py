"""What a verdict says in words and numbers: findings of scores."""

from __future__ import annotations

from typing import Any

import numpy as np

from .codes import BY_CAUSE, LEVELS
from .findings import Finding
from .name import Verdict
from .score import Score
from .shooting import Data
from .states import Array

CURES = {
    "inertia": "check the moments and axes that the simulator uses",
    "damping": "look for damping that is on by default",
    "torque": "look for a torque that was not meant",
    "integrator": "take a shorter step, or a method of higher order",
    "clock": "check the time base, and which step the clock counts",
    "lag": "log rates and attitudes at the same instant of a step",
    "turning frame": "say which frame turns: subtract or add the Earth's rate",
    "misaligned": "turn the rates into the axes of the attitude",
    "bias": "subtract the bias",
    "kinematics": "integrate the attitude from the rates with a step of higher order",
    "units of rates": "check the factor on the rates",
    "rates": "check how the rates are derived",
    "interpolated": "keep the true samples alone",
    "outlier": "leave the samples out",
    "unknown": "compare the terms of the equations one by one",
}


def size_of(score: Score, data: Data) -> tuple[Any, Any, dict[str, Any]]:
    """Return the size of a cause with its error, and what an integrator's finding has beside them."""
    assert score.cause is not None
    cause, more = score.cause, {}
    dt = float(np.median(np.diff(data.t)))
    if cause.substeps:
        held = score.held or cause.substeps / score.c[0] ** (1 / cause.order)
        more = {"order": cause.order, "step": dt / held, "method": cause.variant}
        return None, None, more
    if cause.name == "interpolated":
        return int(cause.variant) * dt, None, more
    if cause.name == "outlier":
        return 1, None, more
    if cause.count == 1:
        return float(score.c[0]), float(score.sigma[0]), more
    return tuple(map(float, score.c)), tuple(map(float, score.sigma)), more


def _shown(size: Any, unit: str) -> str:
    if isinstance(size, tuple):
        return "(" + ", ".join(f"{x:.3g}" for x in size) + f") {unit}".rstrip()
    return f"{size:.4g} {unit}".rstrip()


def describe(score: Score, data: Data) -> str:
    """Return one cause in words, with its size."""
    assert score.cause is not None
    name, variant = score.cause.name, score.cause.variant
    size, _, more = size_of(score, data)
    if more:
        what = "like" if name == "integrator" else "the attitude follows the"
        return f"order {more['order']} with steps of {more['step']:.3g} s, {what} {variant}"
    unit = BY_CAUSE[name].unit
    if name == "clock":
        part = abs(size)
        amount = f"{1e6 * part:.3g} ppm" if part < 1e-3 else f"{100 * part:.3g} %"
        return f"{amount} {'slow' if size > 0 else 'fast'}"
    if name == "lag":
        return f"the rates are {abs(size):.3g} s {'ahead of' if size > 0 else 'behind'} the attitudes"
    if name == "inertia":
        return f"{variant} differ by {_shown(size, '')} (logarithms of moments, then rotation of axes)"
    if name == "interpolated":
        return f"attitudes are interpolated between samples {size:.3g} s apart"
    if name in ("kinematics", "units of rates"):
        return f"the {'attitude follows the rates' if name == 'kinematics' else 'rates are those'} times {1 + size:.6g}"
    return f"{variant + ': ' if variant else ''}{_shown(size, unit)}"


def tell(verdict: Verdict, data: Data, evidence: dict[str, Any]) -> Finding:
    """Return the finding of a verdict that something is wrong."""
    effect, explained = max(verdict.before, verdict.whole), max(0.0, verdict.explained)
    channel = "rad" if data.has_attitude else "of the rates"
    common: dict[str, Any] = {
        "effect": effect,
        "explained": explained,
        "margin": verdict.margin,
        "evidence": evidence | {"gain": verdict.best.gain if verdict.best else 0.0},
    }
    tail = f"; explains {_part(explained)} of {verdict.before:.2g} {channel}"
    assert verdict.best is not None and verdict.best.cause is not None
    name = verdict.best.cause.name
    size, sigma, more = size_of(verdict.best, data)
    if verdict.kind == "cannot tell":
        rivals = (name, *verdict.rivals)
        worst = max((BY_CAUSE[r].level for r in rivals), key=LEVELS.index)
        return Finding(
            "cannot tell",
            f"{' or '.join(rivals)}: the data do not tell which{tail}",
            rivals=rivals,
            level="warning" if worst == "error" else worst,
            size=size,
            sigma=sigma,
            **common,
        )
    if more and name == "kinematics":
        size = _rate_off(verdict, data)
    elif more:
        size = effect
    text = describe(verdict.best, data) + tail
    return Finding(
        name, text, size=size, sigma=sigma, rivals=verdict.rivals, cure=CURES.get(name, ""), **common, **more
    )


def _part(explained: float) -> str:
    return "all" if explained > 0.99995 else f"{100 * explained:.4g} %"


def _rate_off(verdict: Verdict, data: Data) -> float:
    """Return by which mean rate the attitude departs from the rates [rad/s]."""
    return verdict.before / float(data.t[-1] - data.t[0])


def unexplained(verdict: Verdict, data: Data, evidence: dict[str, Any]) -> Finding:
    """Return the finding of a deviation that no cause explains: the kinematics, the rates alone, or unknown."""
    index, names = verdict.track.index, ("rates",) * data.has_omega + ("attitude",) * data.has_attitude
    left = dict(zip(names, verdict.alone, strict=True))
    w, q = left.get("rates", 0.0), left.get("attitude", 0.0)
    span = float(data.t[index[0, -1]] - data.t[index[0, 0]])
    cause, lead = "unknown", "attitude" if q >= w else "rates"
    size = left[lead]
    if data.has_omega and data.has_attitude:
        if q > 5 * w * data.scale * span:
            cause, lead, size = "kinematics", "attitude", q / span
        elif w > 5 * q:
            cause, lead, size = "rates", "rates", w * data.scale
    effect, place = left[lead], names.index(lead)
    ranked = list(dict.fromkeys(s.cause.name for s in verdict.ranking[:3] if s.cause))
    nearest = min(verdict.ranking, key=lambda s: s.rest[place], default=None)
    best = ""
    if nearest and nearest.cause and effect:
        part = (3 * nearest.rest[place]) ** 0.5 / effect
        best = f"; the nearest cause is {nearest.cause.name}, which leaves {100 * part:.0f} %"
    words = {
        "kinematics": "the rates are those of such a body, but the attitude is not their integral",
        "rates": "the attitude is that of such a body, but the rates are not its derivative",
        "unknown": "no such body moves like this",
    }[cause]
    return Finding(
        cause,
        f"{words}: off by {effect:.2g}{best}",
        size=size,
        effect=effect,
        explained=0.0,
        margin=0.0,
        rivals=tuple(ranked),
        evidence=evidence,
        cure=CURES[cause],
    )


def invariants(data: Data, matrix: Array) -> dict[str, float]:
    """Return by how much energy and angular momentum vary, relative to their means; they decide nothing."""
    momentum = data.omega @ matrix
    energy, size = 0.5 * np.sum(momentum * data.omega, axis=1), np.linalg.norm(momentum, axis=1)
    out = {}
    for name, values in (("energy", energy), ("angular momentum", size)):
        mean = float(np.mean(values))
        out[name] = float(np.ptp(values)) / abs(mean) if mean else 0.0
    return out
