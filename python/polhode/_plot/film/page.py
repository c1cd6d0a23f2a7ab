"""The page of a film: the motion as numbers, a script that draws them, and three.js, all in one file."""

from __future__ import annotations

import base64
import json
import re
from html import escape
from importlib import resources
from typing import TYPE_CHECKING, Any

import numpy as np

from ..._solve.motion import Floats
from .. import style
from ..poinsot import family
from .solid import SIDES

if TYPE_CHECKING:
    from .film import Film


def _text(name: str) -> str:
    return resources.files(__package__).joinpath(name).read_text(encoding="utf-8")


def _packed(values: Any) -> str:
    """Numbers as float32, little-endian, in base64."""
    return base64.b64encode(np.ascontiguousarray(values, dtype="<f4").tobytes()).decode("ascii")


def _poinsot(film: Film) -> dict[str, Any]:
    """The ellipsoid of the energy at the start, its polhodes and the path of omega, in principal axes; largest = 1."""
    inertia = film.scene.carrier_inertia
    moments = np.asarray(inertia.moments)
    w = film.omega @ np.asarray(inertia.axes)
    energy2 = float(w[0] ** 2 @ moments)
    if not energy2 > 0:
        return {}
    semi = np.sqrt(energy2 / moments)
    plain, separatrix = ([], []) if film.scene.rotors else family(moments, energy2)
    size = max(float(semi.max()), 0.9 * float(np.linalg.norm(w, axis=1).max()))
    lines = [{"points": _packed(curve / size), "strong": strong}
             for curves, strong in ((plain, False), (separatrix, True)) for curve in curves]
    return {"semi": (semi / size).tolist(), "lines": lines, "path": _packed(w / size)}


def _content(film: Film, start: float | None) -> dict[str, Any]:
    solid = film.solid
    momentum: Floats = film.track.angular_momentum[0]
    size = float(np.linalg.norm(momentum))
    return {
        "begin": float(film.t[0]), "end": float(film.t[-1]), "count": len(film.t), "seconds": film.seconds,
        "start": start, "attitude": _packed(film.attitude), "axis": film.axis.tolist(),
        "arm": None if solid.arm is None else solid.arm.tolist(),
        "momentum": (momentum / size).tolist() if size > 0 and film.keeps_momentum else None,
        "solid": {"corners": _packed(solid.corners), "normals": _packed(solid.normals),
                  "colours": _packed(np.repeat(solid.colours[:, None], 3, axis=1))},
        "poinsot": _poinsot(film), "path": {"light": style.LIGHT.path, "dark": style.DARK.path},
        "accent": {"light": style.LIGHT.accent, "dark": style.DARK.accent}, "sides": [pair[0] for pair in SIDES],
    }


def render(film: Film, start: float | None = None) -> str:
    """Return the page."""
    data = json.dumps(_content(film, start), allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
    under = f"{', '.join(type(torque).__name__ for torque in film.scene.torques) or 'no torque'}; {film.solid.name}"
    moments = ", ".join(f"{m:.4g}" for m in film.scene.inertia.moments)
    fixed = ", and L" if film.keeps_momentum else ""
    parts = {"title": escape(film.title), "under": escape(f"moments {moments} kg m²; {under}"),
             "css": _text("page.css"), "licence": _text("three.LICENSE").replace("--", "- -"), "data": data,
             "fixed": fixed, "three": _text("three.min.js"), "script": _text("page.js")}
    return re.sub(r"\{\{ (\w+) \}\}", lambda found: parts[found[1]], _text("page.html"))
