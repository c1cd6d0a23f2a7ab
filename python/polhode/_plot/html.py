"""What a notebook shows of a plan, a motion, a tensor, a closed form and a diagnosis: tables in its own colours."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from .text import to_error, to_time

if TYPE_CHECKING:
    from .._solve.motion import Motion
    from .._solve.plan import Plan

# Lines and quiet words are see-through, so that they fit a light notebook as well as a dark one.
_LINE = "border-bottom:1px solid rgba(128,128,128,.3)"
_CELL = f"padding:.15em .9em .15em 0;text-align:left;vertical-align:top;{_LINE}"
_QUIET = "opacity:.65"
# Of each closed form, beside inertia and start: attribute and unit.
_FACTS = (("kind", ""), ("period", "s"), ("nutation_period", "s"), ("precession_rate", "rad/s"), ("frequency", "rad/s"),
          ("tilt_bounds", "rad"), ("energy", "J"), ("angular_momentum", "kg m²/s"), ("momentum", "kg m²/s"),
          ("damping", "1/s"), ("weight_arm", "N m"), ("rotor", "kg m²/s"), ("weight", "N"), ("arm", "m"),
          ("axis", ""), ("total_angle", "rad"))


def _number(value: Any) -> str:
    if isinstance(value, str):
        return escape(value.replace("_", " "))
    if np.ndim(value):
        return "(" + ", ".join(_number(part) for part in value) + ")"
    return "∞" if value == math.inf else f"{float(value):.6g}"


def _table(rows: Iterable[Sequence[str]], head: Sequence[str] = (), strong: int = -1) -> str:
    """Return a table of cells that are HTML already."""
    text = "<table style='border-collapse:collapse;font-variant-numeric:tabular-nums'>"
    if head:
        text += "<tr>" + "".join(f"<th style='{_CELL};{_QUIET}'>{name}</th>" for name in head) + "</tr>"
    for index, row in enumerate(rows):
        weight = ";font-weight:bold" if index == strong else ""
        text += "<tr>" + "".join(f"<td style='{_CELL}{weight}'>{cell}</td>" for cell in row) + "</tr>"
    return text + "</table>"


def _frame(title: str, under: str, *parts: str) -> str:
    below = f" <span style='{_QUIET}'>{escape(under)}</span>" if under else ""
    return f"<div><div><b>{escape(title)}</b>{below}</div>{''.join(parts)}</div>"


def _list(texts: Iterable[str]) -> str:
    found = "".join(f"<li>{escape(text)}</li>" for text in texts)
    return f"<ul style='margin:.3em 0 0 1.2em;padding:0'>{found}</ul>" if found else ""


def of_plan(plan: Plan) -> str:
    """Return a plan's choice, candidates, pieces and reasons."""
    asked = "tolerances given" if math.isnan(plan.accuracy) else f"accuracy {plan.accuracy:g}"
    chosen = plan.model if plan.method == "exact" else plan.method
    parts = []
    if plan.pieces:
        parts.append(_table(([f"{p.begin:.6g}", f"{p.end:.6g}", escape(", ".join(p.torques) or "none"), escape(p.model),
                              escape(p.method)] for p in plan.pieces[:20]),
                            ("from", "to [s]", "torques", "model", "method")))
    candidates = plan.candidates
    rows = [[escape(c.name), "" if c.why_not else to_error(c.predicted_error),
             "" if c.why_not else to_time(c.predicted_seconds), escape(c.why_not)] for c in candidates]
    strong = next((k for k, c in enumerate(candidates) if c.name == chosen and not c.why_not), -1)
    if rows:
        table = _table(rows, ("candidate", "error", "time", ""), strong)
        parts.append(f"<details><summary>{len(rows)} candidates</summary>{table}</details>")
    return _frame(f"Plan: {plan.model} by {plan.method}", f"{plan.scene.name or 'scene'}, {asked}",
                  _list(plan.reasons), *parts)


def of_motion(motion: Motion[Any, Any]) -> str:
    """Return what is known of a motion, with its first and last sample."""
    rows = [["result", escape(motion.message)]]
    if not math.isnan(motion.error):
        rows.append(["error", f"{to_error(motion.error)} ({escape(motion.error_kind)}), asked {motion.asked:g}"])
    if motion.drift:
        rows.append(["drift", escape(", ".join(f"{name.replace('_', ' ')} {to_error(value)}"
                                               for name, value in motion.drift.items()))])
    cost = f"{motion.stats['steps']:,} steps, " if motion.stats["steps"] else ""
    rows.append(["cost", f"{cost}{to_time(motion.stats['seconds'])}"])
    parts = [_table(rows)]
    if len(motion):
        ends = sorted({0, len(motion) - 1})
        known = [(name, getattr(motion, name)) for name in ("omega", "attitude") if getattr(motion, name) is not None]
        parts.append(_table(([f"{motion.t[k]:.6g}", *(_number(array[k]) for _, array in known)] for k in ends),
                            ("t [s]", *({"omega": "ω [rad/s]", "attitude": "attitude (x, y, z, w)"}[name]
                                        for name, _ in known))))
    state = "✓" if motion.success else "✗"
    return _frame(f"{state} Motion", f"{motion.scene.name or 'unnamed'}: {len(motion)} samples by {motion.plan.method}",
                  *parts)


def of_tensor(tensor: Any) -> str:
    """Return the matrix of an InertiaTensor with its moments and axes."""
    matrix = _table([[_number(value) for value in row] for row in tensor.matrix])
    axes = _table(([f"{tensor.moments[k]:.6g}", _number(tensor.axes[:, k])] for k in range(3)),
                  ("moment [kg m²]", "axis in the body"))
    checked = tensor.symmetry if tensor.physical else f"{tensor.symmetry}, triangle inequality not checked"
    return _frame("InertiaTensor", f"{checked} [kg m²]", matrix, axes)


def of_closed_form(form: Any) -> str:
    """Return the start and the properties of a closed form."""
    rows = [["moments [kg m²]", _number(form.inertia.moments)], ["ω at 0 [rad/s]", _number(form.omega)],
            ["attitude at 0", _number(form.attitude)]]
    for name, unit in _FACTS:
        if (value := getattr(form, name, None)) is not None and not isinstance(value, bool):
            rows.append([f"{name.replace('_', ' ')}{f' [{unit}]' if unit else ''}", _number(value)])
    return _frame(type(form).__name__, "closed form", _table(rows))


def of_diagnosis(diagnosis: Any) -> str:
    """Return the findings of a diagnosis."""
    if diagnosis.fine:
        return _frame("✓ Diagnosis", diagnosis.verdict)
    rows = [[escape(f.code), escape(f.level), escape(f.text), escape(f.advice)] for f in diagnosis.findings]
    count = f"{len(rows)} finding{'s' * (len(rows) > 1)}"
    return _frame("✗ Diagnosis", count, _table(rows, ("code", "level", "what", "likely cause, and the correction")))
