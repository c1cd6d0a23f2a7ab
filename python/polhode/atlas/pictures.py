"""The pictures: one for each family, with a named line for each entrant, and the matrix."""

from __future__ import annotations

import math
import pathlib
import textwrap
from typing import Any

from .._plot import style
from .entrants import KINDS, WITNESS, entrants
from .family import Family, Point
from .results import FamilyResult, matrix
from .style import LEVELS, WORDS, line_styles

PANEL, MARGIN, LABELS = 4.6, 0.85, 1.75   # inches: a panel, what is left of it, the names at its right
LINE_GAP = 0.034                            # of the axes' height: names closer than that share a line


def draw_family(result: FamilyResult, folder: pathlib.Path) -> list[pathlib.Path]:
    """Draw the sweep: the threshold as a line, a cross where someone broke off."""
    family = result.family
    shown = [(name, title) for name, title in family.series
             if any(_points(points, name) for points in result.rows.values())]
    with style.used() as plt:
        panels = [(name, title, family.y, family.y_label, family.y_limits) for name, title in shown]
        panels += [("", "", value, label, limits) for value, label, limits in family.also]
        columns = min(2, len(panels)) or 1
        rows = max(1, math.ceil(len(panels) / columns))
        caption = _caption(result, columns)
        head = 0.95 + 0.19 * (caption.count("\n") + 1)
        width, height = columns * (PANEL + MARGIN + LABELS), head + 0.55 + 3.4 * rows + 0.75 * (rows - 1)
        figure, grid = plt.subplots(rows, columns, figsize=(width, height), squeeze=False)
        figure.subplots_adjust(left=MARGIN / width, right=1 - LABELS / width, top=1 - head / height,
                               bottom=0.55 / height, wspace=(MARGIN + LABELS) / PANEL, hspace=0.75 / 3.4)
        for axes in grid.flat[len(panels):]:
            axes.set_visible(False)
        for axes, panel in zip(grid.flat, panels):
            _panel(axes, result, *panel)
        style.heading(figure, family.title, caption, MARGIN / width)
        paths = style.save(figure, folder, family.name)
        plt.close(figure)
    return paths


def _caption(result: FamilyResult, columns: int) -> str:
    family = result.family
    text = [f"swept: {family.sweeps}", f"holds: {family.holds}; degrades: {family.degrades}"]
    if any(points[-1].late and points[0].status == "answered" for points in result.rows.values() if points):
        text.append(f"where a curve ends early, its next run takes more than {result.limit:g} s of CPU")
    return "\n".join(line for part in text for line in textwrap.wrap(part, 165 if columns > 1 else 88))


def _points(points: list[Point], series: str) -> list[Point]:
    return [p for p in points if p.series == series and p.status in ("answered", "failed") and not math.isnan(p.x)]


def _panel(axes: Any, result: FamilyResult, series: str, title: str, y: str, label: str,
           limits: tuple[float, float] | None) -> None:
    """The curves of one series, or of one more value."""
    family, styles = result.family, line_styles([*entrants(), WITNESS])
    curves = {name: _points(points, series) for name, points in result.rows.items()}
    curves = {name: sorted(points, key=lambda p: p.x) for name, points in curves.items() if points}
    values = sorted({p.x for points in curves.values() for p in points}, reverse=family.x_inverted)
    places = {x: float(i) for i, x in enumerate(values)} if family.x_scale == "list" else {x: x for x in values}
    low, high = limits or _range(family, y, curves)

    def clip(value: float) -> float:
        if not math.isfinite(value):
            return low if family.failed_below else high
        return min(max(value, low), high)

    ends: list[tuple[float, str]] = []
    if family.x_scale == "log" and len(values) > 1:
        axes.set_xscale("log")
    if family.y_log:
        axes.set_yscale("log")
    for name, points in curves.items():
        line_style = styles[name]
        xs, ys = [places[p.x] for p in points], [clip(abs(p.get(y))) for p in points]
        axes.plot(xs, ys, clip_on=False, **line_style)
        broken = [(x, y) for x, y, p in zip(xs, ys, points) if p.status == "failed"]
        if broken:
            axes.plot(*zip(*broken), linestyle="", marker="x", color=line_style["color"], markersize=7,
                      markeredgewidth=1.6, clip_on=False, zorder=8)
        last = xs.index(min(xs) if family.x_inverted and family.x_scale != "list" else max(xs))
        ends.append((ys[last], name))
    axes.set_ylim(low, high)
    if family.x_scale == "list":
        called = dict(family.tick_names)
        axes.set_xticks(list(places.values()), [called.get(x) or _tick(x) for x in places])
        axes.tick_params(axis="x", labelsize=8)
    elif family.x_inverted:
        axes.invert_xaxis()
    for value, word in family.lines if y == family.y else ():
        if low <= value <= high:
            axes.axhline(value, color=style.QUIET, linewidth=1, linestyle=(0, (1, 1.5)), zorder=2)
            axes.annotate(word, (0, value), xycoords=("axes fraction", "data"), xytext=(3, 2),
                          textcoords="offset points", fontsize=8, color=style.QUIET, bbox=style.HALO,
                          zorder=2.5)   # under points
    for axis, log in ((axes.xaxis, axes.get_xscale() == "log"), (axes.yaxis, family.y_log)):
        if log:   # plain text: powers set as formulas are slow to draw and small to read
            axis.set_major_formatter(lambda value, _: _tick(value))
            axis.set_minor_formatter(lambda value, _: "")
    axes.set_xlabel(dict(family.x_labels).get(series, family.x_label))
    axes.set_ylabel(label)
    if title:
        axes.set_title(title)
    _names(axes, ends, low, high, family.y_log, styles)


def _tick(x: float) -> str:
    return f"{x:g}" if x == 0 or 0.01 <= abs(x) < 1000 else f"{x:.0e}".replace("e-0", "e-").replace("e+0", "e")


def _range(family: Family, y: str, curves: dict[str, list[Point]]) -> tuple[float, float]:
    found = [p.get(y) for points in curves.values() for p in points]
    finite = [v for v in found if math.isfinite(v) and (v > 0 or not family.y_log)] or [1.0]
    ends = [*finite, *(value for value, _ in family.lines)]
    return (min(ends) / 2, max(ends) * 2) if family.y_log else (min(0.0, *ends), max(ends) * 1.05)


def _names(axes: Any, ends: list[tuple[float, str]], low: float, high: float, log: bool,
           styles: dict[str, dict[str, Any]]) -> None:
    """Write the names at the curves' ends; those that end together share a line, and lines keep apart."""
    def height(value: float) -> float:
        return math.log(value / low) / math.log(high / low) if log else (value - low) / (high - low)

    groups: list[tuple[float, list[str]]] = []
    for value, name in sorted(ends):
        at = height(value)
        if groups and at - groups[-1][0] < LINE_GAP:
            groups[-1][1].append(name)
        else:
            groups.append((at, [name]))
    blocks = [(at, textwrap.wrap(", ".join(names), 27), names) for at, names in groups]
    # From below: each block at its place, or above the one before it; then down again where the top is passed.
    tops, floor = [], -1.0
    for at, lines, _ in blocks:
        half = LINE_GAP * len(lines) / 2
        centre = max(at, floor + half)
        tops.append(centre)
        floor = centre + half
    ceiling = 1.06
    for i in range(len(blocks) - 1, -1, -1):
        half = LINE_GAP * len(blocks[i][1]) / 2
        tops[i] = min(tops[i], ceiling - half)
        ceiling = tops[i] - half
    for (at, lines, names), centre in zip(blocks, tops):
        colours = {styles[name]["color"] for name in names}
        colour = colours.pop() if len(colours) == 1 else style.INK
        axes.annotate("\n".join(lines), (1, at), xycoords="axes fraction", xytext=(1.05, centre),
                      textcoords="axes fraction", fontsize=7.8, va="center", ha="left", color=colour,
                      fontweight="bold" if {"solve", "exact"} >= set(names) else "normal", linespacing=1.0, zorder=9,
                      arrowprops={"arrowstyle": "-", "color": style.FLOOR, "linewidth": 0.6, "shrinkA": 0,
                                  "shrinkB": 3, "relpos": (0.0, 0.5)})   # to the text's edge, not across others


def draw_matrix(results: list[FamilyResult], folder: pathlib.Path, name: str = "matrix") -> list[pathlib.Path]:
    """Draw methods against families: what holds, what degrades, what fails, and the number behind it."""
    table = matrix(results)
    kinds = {e.name: KINDS[e.kind] for e in [*entrants(), WITNESS]}
    cell, row, head = 0.92, 0.34, 1.05
    groups = list(dict.fromkeys(kinds[n] for n in table))
    gap = 0.3
    width = 1.5 + cell * len(results) + 0.2
    body = row * len(table) + gap * len(groups)
    numbers = "; ".join(f"{' '.join(r.family.summary.split())}: {r.family.number}" for r in results)
    below = textwrap.wrap(f"What the cells say. {numbers}.", int(width * 15.5))
    height = head + body + 1.1 + 0.15 * len(below)
    with style.used() as plt:
        figure = plt.figure(figsize=(width, height))
        axes = figure.add_axes((0, 0, 1, 1))
        axes.set_axis_off()
        axes.set_xlim(0, width)
        axes.set_ylim(height, 0)
        holds = sum(v.level == "holds" for line in table.values() for v in line.values())
        tried = sum(v.level in ("holds", "degrades", "fails") for line in table.values() for v in line.values())
        axes.text(0.15, 0.18, "Where methods fail", fontsize=14, fontweight="bold", va="top")
        axes.text(0.15, 0.48, f"{len(table)} ways to turn a body against {len(results)} families of hard problems: "
                  f"{holds} of {tried} hold", fontsize=9.5, color=style.QUIET, va="top")
        y = head + 0.35
        for index, result in enumerate(results):
            axes.text(1.5 + cell * (index + 0.5), y, result.family.summary, fontsize=9,
                      fontweight="bold", ha="center", va="baseline", linespacing=1.05)
        y += 0.02
        for group in groups:
            y += gap
            axes.text(0.15, y - 0.08, group, fontsize=8.5, color=style.QUIET, va="bottom")
            for who in [n for n in table if kinds[n] == group]:
                axes.text(0.15, y + row / 2, who, fontsize=9.5, fontweight="bold", va="center")
                for index, result in enumerate(results):
                    _cell(axes, 1.5 + cell * index, y, cell, row, table[who][result.family.name])
                y += row
        x = 0.15
        for level, word in WORDS.items():
            face, text, symbol = LEVELS[level]
            axes.add_patch(plt.Rectangle((x, y + 0.2), 0.3, 0.22, facecolor=face, edgecolor=style.GRID, linewidth=0.6))
            axes.text(x + 0.15, y + 0.31, symbol, color=text, ha="center", va="center", fontsize=9)
            axes.text(x + 0.37, y + 0.31, word, va="center", fontsize=8.5, color=style.QUIET)
            x += 0.6 + 0.072 * len(word)
        axes.text(0.15, y + 0.58, "\n".join(below), fontsize=7.5, color=style.QUIET, va="top", linespacing=1.3)
        paths = style.save(figure, folder, name)
        plt.close(figure)
    return paths


def _cell(axes: Any, x: float, y: float, width: float, height: float, verdict: Any) -> None:
    from matplotlib.patches import Rectangle

    face, text, symbol = LEVELS[verdict.level]
    axes.add_patch(Rectangle((x + 0.015, y + 0.015), width - 0.03, height - 0.03, facecolor=face, edgecolor="none"))
    if verdict.level == "none":
        axes.text(x + width / 2, y + height / 2, symbol, color=text, ha="center", va="center", fontsize=10)
        return
    axes.text(x + 0.07, y + height / 2, symbol, color=text, ha="left", va="center", fontsize=9)
    axes.text(x + 0.23, y + height / 2, verdict.text, color=text, ha="left", va="center", fontsize=7.2)
