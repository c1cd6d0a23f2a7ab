"""Style of the atlas: a colour, a marker and a place for each entrant, readable without colour."""

from __future__ import annotations

from typing import Any

from .._plot import style
from .entrants import Entrant

# (face, text, symbol): blue, yellow, red differ for every kind of colour vision and in print; the symbols say it again.
LEVELS = {
    "holds": ("#2f6fb0", "#ffffff", "●"),
    "degrades": ("#f4d58d", style.INK, "◐"),
    "fails": ("#b3392f", "#ffffff", "✕"),
    "unknown": ("#d5dade", style.INK, "?"),
    "none": (style.PAPER, style.FLOOR, "·"),
}
WORDS = {"holds": "holds", "degrades": "degrades", "fails": "fails", "unknown": "not known: too slow here",
         "none": "does not apply"}

_BLUES = ["#0072b2", "#009e73", "#cc79a7", "#56b4e9", "#004e6e", "#8c6bb1", "#5b7f1d", "#332288"]
_EARTHS = ["#a6761d", "#e69f00", "#7a8794", "#b3a08c", "#8a5a44", "#c2a83e"]
_MARKS = ["o", "s", "^", "v", "P", "X", "D", "<", ">", "h", "p", "d"]


def line(entrant: Entrant, place: int) -> dict[str, Any]:
    """Return how an entrant's curve is drawn; `place` counts within its group."""
    if entrant.kind == "solve":
        return {"color": style.INK, "marker": "*", "markersize": 10, "linewidth": 1.2, "zorder": 7}
    if entrant.kind == "exact":
        return {"color": "#d55e00", "marker": "D", "markersize": 5.5, "linewidth": 2.4, "zorder": 6}
    if entrant.kind == "method":
        return {"color": _BLUES[place % len(_BLUES)], "marker": _MARKS[place % len(_MARKS)], "markersize": 5,
                "linewidth": 1.9, "zorder": 5}
    if entrant.kind == "cheap":
        return {"color": _EARTHS[place % len(_EARTHS)], "marker": _MARKS[place % len(_MARKS)], "markersize": 4,
                "linewidth": 1.0, "linestyle": (0, (4, 1.5)), "zorder": 4}
    if entrant.kind == "formula":
        return {"color": "#8a1c5b", "marker": "p", "markersize": 5.5, "linewidth": 1.6, "linestyle": "--", "zorder": 6}
    return {"color": style.QUIET, "marker": "x", "markersize": 5, "linewidth": 1.2, "linestyle": ":", "zorder": 4}


def line_styles(everyone: list[Entrant]) -> dict[str, dict[str, Any]]:
    """Return the line of each entrant, the same on every picture."""
    places: dict[str, int] = {}
    found = {}
    for entrant in everyone:
        found[entrant.name] = line(entrant, places.get(entrant.kind, 0)) | {
            "markeredgecolor": style.PAPER, "markeredgewidth": 0.6, "solid_capstyle": "round"}
        places[entrant.kind] = places.get(entrant.kind, 0) + 1
    return found
