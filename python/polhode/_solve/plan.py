"""Plans: the simplest model and the cheapest method that reach an accuracy."""

from __future__ import annotations

import functools
import math
from typing import Any, Literal, NamedTuple

from .. import _core
from .._attitude.arrays import require_bool, require_text
from .._keywords import checked
from .._scene.scene import Scene
from . import costs


class Candidate(NamedTuple):
    """An exact model or a method, with its expected error and time."""

    name: str
    exact: bool
    why_not: str                # the reason why it cannot be used; empty if it can
    predicted_error: float      # the error it would claim
    predicted_seconds: float    # including every run of the certificate
    rtol: float                 # of the run that would be returned; 0 for exact models


class Piece(NamedTuple):
    """A part of the span with a fixed set of torques, with its model and method."""

    begin: float                # [s]
    end: float                  # [s]
    torques: tuple[str, ...]    # the names of the acting torques, and "rotors"
    model: str                  # a closed form's name, or "euler" or "lagrangian"
    method: str                 # "exact", or a name of `methods()`
    turns: float                # expected revolutions
    predicted_seconds: float    # including every run of the certificate
    ran: str | None = None      # what ran in its place, where the closed form did not hold at the piece's start


class LeftOut(NamedTuple):
    """A torque that is not computed, with its part of the bound of all that are left out."""

    torque: int                 # its number among the scene's torques
    name: str                   # its class
    omega: float                # bound on the change of omega, relative to the largest rate
    attitude: float             # bound on the change of the attitude [rad]
    reason: str


class Plan:
    """The model and the method for a scene and an accuracy, with the reasons; prints as a table.

    It is decided once: ``solve(scene, plan=plan)`` runs exactly this, and `facts` and `reasons` describe it.

    Attributes
    ----------
    scene : Scene
    model : str
        The name of a closed form, such as "triaxial" or "heavy_top". "euler" or "lagrangian" if equations are
        integrated. "pieces" if torques start or stop within the span.
    method : str
        "exact", or a name of `methods()`; for pieces, the costliest method; "enclosure" for a proof.
    pieces : tuple of Piece
        The pieces of the span, in the order of time; empty if the span is not cut.
    state : str
        The integrated variables.
    accuracy : float
        The accuracy of the plan; NaN if tolerances were given, so that nothing was planned.
    certify : bool or "proof"
        True if the error will be bounded, not only expected; "proof" if the bounds will be theorems.
    rtol : float
        The tolerance of the run that is returned; 0 for closed forms.
    predicted_error, predicted_seconds : float
        The expected error, and the expected time of `solve` [s] with its plan and every run of the certificate.
    facts : dict
        The properties of the scene that determine the plan, dimensionless except "span" [s], "decay" [1/s],
        "rotor_momentum" [N m s] and "call_seconds" [s]. "rotor_momentum" is the sum h of the rotors' momenta in body
        axes at the start. "effort" is the number of revolutions that take as many steps as the motion. "call_seconds"
        is the measured time of a call of your own torques; no choice depends on it.
    candidates : tuple of Candidate
        All models and methods that were considered, exact models first.
    reasons : tuple of str
        Why this model and this method; what is not computed, and why that is safe.
    left_out : tuple of LeftOut
        The torques that are not computed: torque (its number), name, omega (bound relative to the largest rate),
        attitude (bound [rad]), reason. The body is then free. The bound is part of `motion.error`. Events see the
        motion without these torques.
    wishes : dict
        The options of the plan: "method", "formulation" and "leave_out" as they were passed to `plan` or `solve`.
    """

    model: str
    method: str
    pieces: tuple[Piece, ...]
    state: str
    accuracy: float
    certify: bool | Literal["proof"]
    rtol: float
    predicted_error: float
    predicted_seconds: float

    def __init__(self, scene: Scene, parts: dict[str, Any], options: dict[str, Any],
                 planned: _core.PlannedScene | None = None) -> None:
        self.scene = scene
        vars(self).update(parts)
        self.pieces = tuple(Piece(**{**piece, "torques": tuple(piece["torques"])}) for piece in parts["pieces"])
        self.wishes = options
        self._made = planned

    @property
    def _planned(self) -> _core.PlannedScene:
        """What was decided. It is decided again for a plan from a file or another process."""
        if self._made is None:
            options = {"rtol": 1e-9} if math.isnan(self.accuracy) else {"accuracy": self.accuracy}
            self._made = _core.PlannedScene(self.scene, {**self.wishes, **options, "certify": self.certify,
                                                         "cost_factors": costs.factors()})
        return self._made

    @functools.cached_property
    def _report(self) -> dict[str, Any]:
        return self._planned.report

    def __getstate__(self) -> dict[str, Any]:
        return {**vars(self), "_made": None, "_report": self._report}

    @property
    def facts(self) -> dict[str, Any]:
        """The properties of the scene that determine the plan."""
        return dict(self._report["facts"])

    @property
    def candidates(self) -> tuple[Candidate, ...]:
        """All models and methods that were considered, exact models first."""
        return tuple(Candidate(**candidate) for candidate in self._report["candidates"])

    @property
    def reasons(self) -> tuple[str, ...]:
        """The reasons for this model and this method, and for what is not computed."""
        return tuple(self._report["reasons"])

    @property
    def left_out(self) -> tuple[LeftOut, ...]:
        """The torques that are not computed, each with its bound."""
        return tuple(LeftOut(**record) for record in self._report["left_out"])

    def as_dict(self) -> dict[str, Any]:
        """Return the whole plan as a dict for JSON."""
        def number(value: float) -> float | None:
            return value if math.isfinite(value) else None

        return {
            "scene": self.scene.name, "accuracy": number(self.accuracy), "model": self.model, "method": self.method,
            "state": self.state, "certify": self.certify, "rtol": self.rtol,
            "predicted_error": number(self.predicted_error), "predicted_seconds": number(self.predicted_seconds),
            "pieces": [piece._asdict() for piece in self.pieces],
            "facts": self.facts, "candidates": [candidate._asdict() for candidate in self.candidates],
            "reasons": list(self.reasons), "left_out": [record._asdict() for record in self.left_out],
            "costs": costs.describe(),
        }

    def __str__(self) -> str:
        return "\n".join(_lines(self))

    def _repr_html_(self) -> str:
        from .._plot.html import of_plan

        return of_plan(self)

    def __repr__(self) -> str:
        asked = "" if math.isnan(self.accuracy) else f", accuracy={self.accuracy:g}"
        return (f"Plan({self.scene.name or 'unnamed'}: model={self.model!r}, method={self.method!r}, "
                f"state={self.state!r}{asked})")

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Plan):
            return NotImplemented
        return self.scene == other.scene and self._key() == other._key()

    def __hash__(self) -> int:
        return hash((self.scene, self._key()))

    def _key(self) -> tuple[Any, ...]:
        nan_free = -1.0 if math.isnan(self.accuracy) else self.accuracy
        return self.model, self.method, self.state, nan_free, self.certify


def _duration(seconds: float) -> str:
    units = (("s", 1.0), ("ms", 1e-3), ("us", 1e-6))
    unit, scale = next((pair for pair in units if seconds >= 0.95 * pair[1]), units[-1])
    value = seconds / scale
    return f"{value:.2g} {unit}" if value < 10 else f"{value:.0f} {unit}"


def _percent(part: float) -> str:
    return "0" if part == 0 else f"{100 * part:.2g} %" if part >= 1e-3 else f"{part:.0e}"


_KEPT = {"energy": "energy", "angular_momentum": "angular momentum", "vertical_momentum": "L_z",
         "jacobi": "energy less n L_z"}


def _describe_body(plan: Plan) -> str:
    facts, moments = plan.facts, plan.scene.inertia.moments
    text = ", ".join(f"{m:.4g}" for m in moments) + f" kg m^2: {facts['symmetry']}"
    if facts["symmetry"] == "triaxial":
        text += f" (gaps of {_percent(facts['gaps'][0])} and {_percent(facts['gaps'][1])})"
    return text


def _describe_start(plan: Plan) -> str:
    facts = plan.facts
    speed = math.hypot(*plan.scene.omega)
    if speed == 0:
        return "at rest"
    text = f"{speed:.3g} rad/s, "
    angle = math.degrees(facts["off_axis"])
    text += "about a principal axis" if angle == 0 else f"{angle:.2g} degrees off the nearest principal axis"
    return text + (f", k'^2 = {facts['separatrix']:.1e} from the separatrix" if 0 < facts["separatrix"] < 1e-3 else "")


def _name(torque: Any) -> str:
    """Return the torque's class, and its number of windows."""
    if not hasattr(torque, "windows"):
        return type(torque).__name__
    if torque.windows is None:
        return f"{type(torque.torque).__name__} in sunlight"
    count = len(torque.windows)
    return f"{type(torque.torque).__name__} during {count} window{'' if count == 1 else 's'}"


def _describe_torques(plan: Plan) -> str:
    facts = plan.facts
    gone = {record.torque for record in plan.left_out}
    parts = [_name(torque) + (" (left out)" if i in gone else "") for i, torque in enumerate(plan.scene.torques)]
    if count := len(plan.scene.rotors):
        parts.append(f"{count} rotor{'' if count == 1 else 's'}")
    names = ", ".join(parts) or "none"
    if not facts["free"]:
        seen = [name for name in ("time", "attitude", "rates") if facts[f"sees_{name}"]]
        verb = "they depend" if len(parts) > 1 or count > 1 else "it depends"
        names += f"; {verb} on {' and '.join(seen) or 'nothing'}"
    kept = [_KEPT[name] for name in facts["keeps"]]
    if not kept:
        return f"{names}; nothing is conserved"
    return f"{names}; {' and '.join(kept)} {'are' if len(kept) > 1 else 'is'} conserved"


def _table(plan: Plan) -> list[str]:
    """List every candidate; neighbours with the same reason against them share a line."""
    chosen = plan.model if plan.method == "exact" else plan.method
    rows: list[tuple[str, str, str, str]] = []
    for candidate in plan.candidates:
        if not candidate.why_not:
            note = "closed form" if candidate.exact else f"rtol {candidate.rtol:.0e}"
            seconds = _duration(candidate.predicted_seconds)
            rows.append((candidate.name, f"{candidate.predicted_error:.0e}", seconds, note))
        elif rows and rows[-1][3] == candidate.why_not:
            rows[-1] = (f"{rows[-1][0]}, {candidate.name}", *rows[-1][1:])
        else:
            rows.append((candidate.name, "-", "-", candidate.why_not))
    rows.insert(0, ("candidate", "error", "time", ""))
    a, b, c = (max(len(row[i]) for row in rows) for i in range(3))
    return [f"{'>' if name == chosen else ' '} {name:<{a}}  {error:>{b}}  {seconds:>{c}}   {note}".rstrip()
            for name, error, seconds, note in rows]


def _pieces(plan: Plan, most: int = 12) -> list[str]:
    """List the pieces; of many, the first and the last."""
    def row(piece: Piece) -> tuple[str, ...]:
        how = f"{piece.model}, closed form" if piece.method == "exact" else piece.method
        how += f" ({piece.ran} ran)" if piece.ran else ""
        return (f"{piece.begin:.6g}", f"{piece.end:.6g}", f"{piece.turns:.3g}", _duration(piece.predicted_seconds), how,
                ", ".join(piece.torques) or "none")

    heads = ("from", "to [s]", "turns", "time", "by", "torques")
    skipped = len(plan.pieces) - most
    shown = plan.pieces if skipped <= 0 else (*plan.pieces[:most // 2], *plan.pieces[-most // 2:])
    rows = [heads, *map(row, shown)]
    widths = [max(len(cells[i]) for cells in rows) for i in range(len(heads))]
    lines = ["  " + "  ".join(f"{cell:<{width}}" if i > 3 else f"{cell:>{width}}" for i, (cell, width) in
                              enumerate(zip(cells, widths))).rstrip() for cells in rows]
    return lines if skipped <= 0 else [*lines[:1 + most // 2], f"  ... {skipped} more ...", *lines[1 + most // 2:]]


def _describe_choice(plan: Plan) -> str:
    if plan.pieces:
        return "pieces, each with its own model and method"
    if plan.method == "exact":
        return plan.model
    if plan.certify == "proof":
        return "Euler's equations, enclosed"
    return f"{plan.method} on {'Euler' if plan.model == 'euler' else 'Lagrange'}'s equations"


def _lines(plan: Plan) -> list[str]:
    facts, scene = plan.facts, plan.scene
    count = scene.times.size
    what = " and ".join(scene.want)
    head = scene.name or "scene"
    lines = [f"{head}: " + ("tolerances given" if math.isnan(plan.accuracy) else f"{what} within {plan.accuracy:g}"),
             ""]
    about = "about " if not facts["free"] else ""
    rows = [
        ("body", _describe_body(plan)), ("start", _describe_start(plan)), ("torques", _describe_torques(plan)),
        ("span", f"{facts['span']:.6g} s, {about}{facts['turns']:.3g} turns; " +
                 ("the end only" if facts["only_at_end"] else f"{count} samples") +
                 (f"; decay x span = {facts['stiffness']:.1e}" if facts["stiffness"] > 1 else "")),
    ]
    lines += [f"  {name:<9}{text}" for name, text in rows]
    if plan.pieces:
        lines += ["", *_pieces(plan)]
    if plan.candidates:
        lines += ["", *_table(plan)]
    lines.append("")
    lines.append(f"  choice   {_describe_choice(plan)}, state: {plan.state}")
    lines += [f"  {'because' if i == 0 else '':<9}{text}" for i, text in enumerate(plan.reasons)]
    if not math.isnan(plan.accuracy):
        lines.append(f"  costs    {costs.describe()}")
    return lines


@checked
def plan(scene: Scene, accuracy: float | None = None, *, method: str | None = None,
         certify: bool | Literal["proof"] = True, formulation: str = "euler", leave_out: bool = True) -> Plan:
    """Choose the simplest model and the cheapest method for a scene, without running them.

    Parameters
    ----------
    scene : Scene
    accuracy : float, optional
        The largest error of any sample, as in `solve`; 1e-9 if left out.
    method : str, optional
        "exact" or a name as of `solve`, to use instead of the cheapest method.
    certify : bool or "proof"
        Bound the error; otherwise it is only expected. "proof": as in `solve`.
    formulation : {"euler", "lagrangian"}
        As in `solve`.
    leave_out : bool
        As in `solve`: whether torques may be left out that change nothing within a third of the accuracy.

    Returns
    -------
    Plan
        ``print(plan)`` shows it as a table; ``solve(scene, plan=plan)`` carries it out.

    Raises
    ------
    InvalidInput
        For an accuracy outside (0, 1], and for options that contradict each other or the scene.
    """
    if not isinstance(scene, Scene):
        raise _core.InvalidInput(f"scene: must be a polhode.Scene, got {type(scene).__name__}")
    for name, value in (("method", method), ("certify", certify), ("formulation", formulation)):
        require_text(value, name)
    asked: dict[str, Any] = {"method": method, "formulation": str(formulation)}
    if not require_bool(leave_out, "leave_out"):
        asked["leave_out"] = False
    if not isinstance(certify, str):
        certify = require_bool(certify, "certify")
    planned = _core.PlannedScene(scene, {**asked, "accuracy": accuracy, "certify": certify,
                                         "cost_factors": costs.factors()})
    return Plan(scene, planned.parts, asked, planned)
