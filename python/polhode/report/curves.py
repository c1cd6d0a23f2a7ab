"""A measured scene as curves for Plotly, as plain dictionaries."""

from __future__ import annotations

import math
from typing import Any

from .._plot import style
from .._plot.text import to_error, to_time

GROUPS = {"exact": "closed forms", "plan": "the plan", "method": "methods", "cheap": "engines' steps",
          "formula": "torques as formulas", "peer": "other programs"}
LOST = 4.0   # an attitude is never further off than pi
SYMBOLS = {"o": "circle", "D": "diamond", "*": "star", "s": "square", "^": "triangle-up", "v": "triangle-down",
           "P": "cross", "X": "x", "h": "hexagon", "d": "diamond-tall", ".": "circle"}


def _hover(point: dict[str, Any]) -> str:
    text = f"{point['setting']}: error {to_error(point['error'])}, {to_time(point['seconds'])}"
    if point["repeats"] > 1:
        text += f" ({to_time(point['fastest'])} to {to_time(point['slowest'])}, {point['repeats']} repeats)"
    counts = ", ".join(f"{value:,} {name}" for name, value in point["counts"].items() if value)
    return f"{text}<br>{counts}" if counts else text


def traces(scene: dict[str, Any]) -> list[dict[str, Any]]:
    """Return one trace a candidate, those that others beat everywhere in grey, in the order of `GROUPS`."""
    found: dict[str, list[dict[str, Any]]] = {}
    for point in scene["points"]:
        if point["status"] == "answered" and (point["error"] < LOST or not point["swept"]):
            found.setdefault(point["candidate"], []).append(point)
    result = []
    for name, points in sorted(found.items(), key=lambda item: list(GROUPS).index(item[1][0]["family"])):
        family, pale = points[0]["family"], name in scene["dominated"]
        look = style.line(name, family, pale)
        ink = look["color"]
        result.append({
            "name": name, "group": GROUPS[family], "pale": pale, "ink": ink,
            "type": "scatter", "mode": "markers" if family in ("plan", "exact") else "lines+markers",
            "x": [max(p["error"], 1e-17) for p in points], "y": [p["seconds"] for p in points],
            "error_y": {"type": "data", "symmetric": False, "array": [p["slowest"] - p["seconds"] for p in points],
                        "arrayminus": [p["seconds"] - p["fastest"] for p in points], "thickness": 1, "width": 0,
                        "color": ink},
            "text": [_hover(p) for p in points], "hovertemplate": f"<b>{name}</b> %{{text}}<extra></extra>",
            "line": {"color": ink, "width": 1 if pale else 2, "dash": "dash" if family == "peer" else "solid"},
            "marker": {"color": ink, "size": {"exact": 11, "plan": 15}.get(family, 5 if pale else 7),
                       "symbol": SYMBOLS[look["marker"]], "line": {"color": style.PAPER, "width": 0.7}},
        })
    return result


def _ticks(values: list[float], words: Any, every: int = 1) -> dict[str, Any]:
    low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
    powers = [10.0**k for k in range(low, high + 1) if k % every == 0]
    return {"tickvals": powers, "ticktext": [words(p) for p in powers]}


def layout(scene: dict[str, Any], drawn: list[dict[str, Any]]) -> dict[str, Any]:
    """Return the axes, accuracy growing to the right, and the line no float64 program can be asked to pass."""
    x = [v for trace in drawn for v in trace["x"]] or [1.0, 1e-15]
    y = [v for trace in drawn for v in trace["y"]] or [1e-6, 1.0]
    floor = scene["reference"]["floor"] or scene["reference"]["uncertainty"]
    word = "input rounding" if scene["reference"]["floor"] else "the reference's own uncertainty"
    quiet = {"size": 11, "color": style.QUIET}
    axis = {"type": "log", "gridcolor": style.GRID, "zeroline": False, "linecolor": style.FLOOR, "tickfont": quiet}
    shapes, notes = [], []
    if floor:
        shapes = [{"type": "line", "xref": "x", "yref": "paper", "x0": floor, "x1": floor, "y0": 0, "y1": 1,
                   "line": {"color": style.FLOOR, "dash": "dot", "width": 1.5}}]
        notes = [{"x": math.log10(floor), "y": 0, "xref": "x", "yref": "paper", "text": f"{word} {to_error(floor)}",
                  "textangle": -90, "showarrow": False, "xanchor": "right", "yanchor": "bottom", "font": quiet}]
    least = min([*x, floor or 1.0])
    low = math.floor(math.log10(least)) - 0.4
    words = {"x": "largest error, more accurate to the right", "y": "time for all samples"}
    return {
        "xaxis": axis | {"range": [math.log10(LOST * 2), low], "title": {"text": words["x"], "font": quiet},
                         **_ticks([LOST, least], lambda v: "1" if v == 1 else f"1e{round(math.log10(v))}", 3)},
        "yaxis": axis | {"range": [math.log10(min(y)) - 0.4, math.log10(max(y)) + 0.4],
                         "title": {"text": words["y"], "font": quiet}, **_ticks([min(y) / 2, 2 * max(y)], to_time)},
        "shapes": shapes, "annotations": notes, "showlegend": False, "hovermode": "closest", "height": 460,
        "margin": {"l": 70, "r": 16, "t": 10, "b": 52}, "paper_bgcolor": style.PAPER, "plot_bgcolor": style.PAPER,
        "hoverlabel": {"align": "left"},
    }


def figure(scene: dict[str, Any]) -> dict[str, Any]:
    """Return what the page's script draws for one scene of results.json."""
    drawn = traces(scene)
    return {"data": drawn, "layout": layout(scene, drawn)}
