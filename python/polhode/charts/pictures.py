"""The pictures: time against error for one scene, for all scenes, and the limits of tolerances."""

from __future__ import annotations

import math
import pathlib
import re
import statistics
import textwrap
from typing import Any

import numpy as np

from .._plot import style
from .._plot.text import to_error, to_time
from .._solve.motion import Floats
from .engines import engine_line
from .findings import (
    adaptive,
    dominated,
    headline,
    held_by_stability,
    how_it_ran,
    program_ratios,
    stalls,
    to_ratio,
    under_headline,
    without_answer,
)  # fmt: skip
from .measure import SceneResult

LOST = 4.0   # an attitude is never further off than pi


def _wrap(text: str, width: int) -> str:
    """Wrap to lines of about the same length, keeping a number and its unit together."""
    text = re.sub(r"(\d) ([µm]?s)\b", "\\1\u00a0\\2", text)
    count = len(textwrap.wrap(text, width))
    least = next(w for w in range(width // 2, width + 1) if len(textwrap.wrap(text, w)) == count)
    return textwrap.fill(text, least)


def _time_ticks(axes: Any, which: str = "y") -> None:
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axis = getattr(axes, f"{which}axis")
    axis.set_major_locator(LogLocator(10, numticks=12))
    axis.set_minor_formatter(NullFormatter())
    axis.set_major_formatter(FuncFormatter(lambda value, _: to_time(value)))


def _error_ticks(axes: Any, which: str = "x", every: int = 3) -> None:
    from matplotlib.ticker import FixedLocator, FuncFormatter

    axis = getattr(axes, f"{which}axis")
    axis.set_major_locator(FixedLocator([10.0**-k for k in range(0, 19, every)]))
    axis.set_major_formatter(FuncFormatter(lambda value, _: "1" if value == 1 else f"1e{round(math.log10(value))}"))


Ends = list[tuple[float, float, str, str]]


def _curves(axes: Any, result: SceneResult, spread: bool = False) -> Ends:
    """Draw all candidates, those that others beat everywhere in grey; return where each one's name belongs: its most
    accurate end. `spread`: with a bar from the fastest to the slowest repeat."""
    ends: Ends = []
    pale = dominated(result)
    for name in result.names("method", "cheap", "formula", "peer", "exact", "plan"):
        points = [p for p in result.of(name) if p.error < LOST or p.swept == ""]
        if not points:
            continue
        family = points[0].family
        x = [min(max(p.error, 1e-17), LOST) for p in points]
        look = style.line(name, family, name in pale)
        axes.plot(x, [p.seconds for p in points], **look)
        if spread:
            axes.vlines(x, [p.fastest for p in points], [p.slowest for p in points], color=look["color"], linewidth=1.0,
                        alpha=0.6, zorder=2)
        best = min(range(len(points)), key=lambda i: x[i])
        ends.append((x[best], points[best].seconds, name, style.QUIET if name in pale else look["color"]))
    return ends


def _frame(axes: Any, results: list[SceneResult]) -> None:
    """Log-log axes, with accuracy growing to the right."""
    points = [p for r in results for p in r.points if p.answered and (p.error < LOST or p.swept == "")]
    floors = [r.truth.floor for r in results if r.truth.floor]
    least = min([p.error for p in points if p.error > 0] + floors, default=1e-15)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(LOST * 2.5, 10.0 ** (math.floor(math.log10(max(least, 1e-17))) - 0.3))
    times = [p.seconds for p in points] or [1e-6, 1.0]   # there may be no points
    low, high = math.log10(min(times)), math.log10(max(times))
    air = max(0.35, 1.0 - (high - low) / 2)   # two decades at least, or a flat line would look rough
    axes.set_ylim(10 ** (low - air), 10 ** (high + air))


def _floor(axes: Any, result: SceneResult, text: bool) -> None:
    known = result.truth.floor if result.truth.floor is not None else result.truth.uncertainty
    if known <= 0:
        return
    axes.axvline(known, color=style.FLOOR, linewidth=1.2, linestyle=(0, (1, 2)), zorder=1)
    if text:
        word = "input rounding" if result.truth.floor is not None else "reference's own uncertainty"
        axes.annotate(f"{word} {to_error(known)}", (known, 0.015), xycoords=("data", "axes fraction"), xytext=(-4, 0),
                      textcoords="offset points", rotation=90, ha="right", va="bottom", fontsize=8, color=style.QUIET,
                      zorder=6, bbox=style.HALO)


def _obstacles(axes: Any) -> Floats:
    """Points on all curves, stars and words, in pixels, four pixels apart."""
    found = [np.empty((0, 2))]
    for line in axes.get_lines():
        if line.get_zorder() < 2:   # floors and guides may be crossed
            continue
        corners = line.get_transform().transform(np.column_stack(line.get_data()))
        for start, end in zip(corners, corners[1:]):
            count = int(np.hypot(*(end - start)) / 4) + 2
            found.append(start + np.linspace(0, 1, count)[:, None] * (end - start))
        found.append(corners)
        if line.get_marker() == "*":
            found += [corners + (dx, dy) for dx in (-7, 7) for dy in (-7, 0, 7)]
    for text in axes.texts:
        box = text.get_window_extent()
        ups = np.arange(box.y0, box.y1, 4)
        found += [np.column_stack([np.full(ups.size, x), ups]) for x in (box.x0, box.x1)]
    return np.vstack(found)


def _spread(axes: Any, ends: Ends) -> None:
    """Write the names beside the ends of the curves, where they cover neither a curve nor a name; grey ones smaller."""
    taken = _obstacles(axes)
    for x, y, name, ink in sorted(ends, key=lambda end: (end[3] == style.QUIET, -end[1])):
        px, py = axes.transData.transform((x, y))
        quiet = ink == style.QUIET
        left, right = px + 7, px + 12 + (5.6 if quiet else 7.4) * len(name)
        near = taken[(taken[:, 0] > left) & (taken[:, 0] < right)][:, 1]
        shifts = sorted(range(-60, 61, 2), key=abs)
        shift = next((dy for dy in shifts if not (np.abs(near - py - dy) < (7 if quiet else 9)).any()), 0)
        changes: dict[str, Any] = {"fontsize": 7, "fontweight": "normal", "bbox": None} if quiet else {}
        if abs(shift) > 12:   # far from its end, so led back to it
            changes["arrowprops"] = {"arrowstyle": "-", "color": ink, "linewidth": 0.6, "alpha": 0.7, "shrinkA": 0,
                                     "shrinkB": 3}
        style.label(axes, x, y, name, ink, xytext=(8, shift * 72 / axes.figure.dpi), **changes)
        own = np.column_stack([np.linspace(left, right, 12), np.full(12, py + shift)])
        taken = np.vstack([taken, own + (0, 5), own, own - (0, 5)])


def work_precision(result: SceneResult, folder: pathlib.Path) -> list[pathlib.Path]:
    """One scene: time against error."""
    with style.used() as plt:
        title, under = _wrap(headline(result), 72), _wrap(under_headline(result), 125)
        foot = "\n".join(_wrap(line, 140) for line in how_it_ran(result))
        base = 0.62 + 0.155 * (foot.count("\n") + 1) if foot else 0.62
        height = 5.28 + base
        below = height - base - 0.25 * title.count("\n") - 0.18 * under.count("\n")
        figure = plt.figure(figsize=(8.6, height))
        axes = figure.add_axes((0.1, base / height, 0.73, (below - 0.9) / height))
        figure.text(0.03, 0.08 / height, foot, fontsize=7.5, color=style.QUIET, va="bottom", linespacing=1.35)
        _frame(axes, [result])
        _time_ticks(axes)
        _error_ticks(axes, every=2)
        _floor(axes, result, text=True)
        _spread(axes, _curves(axes, result, spread=True))
        axes.set_xlabel("largest error over all samples: rates relative, attitude in rad (more accurate to the right)")
        axes.set_ylabel("time for all samples")
        style.heading(figure, title, under, 0.03)
        paths = style.save(figure, folder, result.scene.name or "scene")
        plt.close(figure)
    return paths


def overview(results: list[SceneResult], folder: pathlib.Path) -> list[pathlib.Path]:
    """All scenes as small multiples on the same axes."""
    columns = min(len(results), 5 if len(results) > 8 else 4 if len(results) > 3 else 3)
    rows = -(-len(results) // columns)
    names: dict[str, str] = {}
    for result in results:
        pale = dominated(result)
        names |= {p.candidate: p.family for p in result.points if p.answered and p.candidate not in pale}
    with style.used() as plt:
        title, across = _wrap(_overview_title(results), 22 * columns), max(2, round(1.4 * columns))
        advice = _wrap(engine_line(results), 42 * columns) if engine_line(results) else ""
        below = 0.15 + 0.18 * (advice.count("\n") + 1) if advice else 0.0
        legend_rows = -(-(len(names) + 2) // across)
        top = 1.1 + 0.19 * legend_rows + 0.25 * title.count("\n")
        width, height = 1.25 + 2.35 * columns, 0.32 + top + 2.3 * rows + below
        figure, grid = plt.subplots(rows, columns, figsize=(width, height), sharex=True, sharey=True, squeeze=False)
        figure.subplots_adjust(left=0.97 / width, right=1 - 0.15 / width, bottom=(0.62 + below) / height,
                               top=1 - top / height, wspace=0.09, hspace=0.28)
        for axes in grid.flat[len(results):]:
            axes.set_visible(False)
        for axes, result in zip(grid.flat, results):
            _frame(axes, results)
            _time_ticks(axes)
            _error_ticks(axes, every=5)
            _floor(axes, result, text=False)
            _curves(axes, result)
            if silent := _silent(result):
                axes.text(0.04, 0.05, silent, transform=axes.transAxes, fontsize=7.5, color=style.QUIET,
                          linespacing=1.4)
            axes.set_title(f"{result.scene.name} {result.title}", fontsize=9)
        closed = [name for name, family in names.items() if family == "exact"]
        labels = {name: name for name in names if name not in closed[1:]}   # closed forms share one line here
        labels |= {name: f"closed form ({', '.join(closed)})" for name in closed[:1]}
        handles = [plt.Line2D([], [], label=text, **style.line(name, names[name])) for name, text in labels.items()]
        handles.append(plt.Line2D([], [], color=style.PALE, linewidth=0.9, marker="o", markersize=3,
                                  label="beaten everywhere"))
        handles.append(plt.Line2D([], [], color=style.FLOOR, linestyle=(0, (1, 2)), label="rounding of the input"))
        figure.legend(handles=handles, loc="upper left",
                      bbox_to_anchor=(0.3 / width, 1 - (0.72 + 0.25 * title.count("\n")) / height),
                      fontsize=8.5, ncols=across, frameon=False, borderaxespad=0, handlelength=2.0, columnspacing=1.4)
        figure.supxlabel("largest error over all samples (more accurate to the right)", fontsize=9.5, color=style.QUIET,
                         y=(0.1 + below) / height)
        figure.text(0.3 / width, 0.1 / height, advice, fontsize=8.5, color=style.QUIET, va="bottom")
        figure.supylabel("time for all samples", fontsize=9.5, color=style.QUIET, x=0.06 / width,
                         y=(1 - (top - 0.62) / height) / 2)
        style.heading(figure, title,
                      "one thread; lower and further right is better",
                      0.3 / width)
        paths = style.save(figure, folder, "overview")
        plt.close(figure)
    return paths


def _silent(result: SceneResult) -> str:
    """Return the candidates that failed for other reasons than the time limit."""
    names = [name for name, why in without_answer(result).items() if not why.startswith(("not done", "hung"))]
    return "\n".join(textwrap.wrap(f"no answer: {', '.join(names)}", 34)) if names else ""


def _overview_title(results: list[SceneResult]) -> str:
    exact = [p for r in results for n in r.names("exact") for p in r.of(n)]
    parts = []
    if exact:
        worst, longest = max(p.error for p in exact), max(p.seconds for p in exact)
        parts.append(f"closed forms are right to {to_error(worst)} within {to_time(longest)}")
    medians = {program: statistics.median(ratios) for program, ratios in program_ratios(results).items()}
    if medians:
        words = [f"{program} {to_ratio(ratio)}" for program, ratio in medians.items()]
        parts.append(f"times as long as the fastest stepper at equal error: {', '.join(words)}")
    text = "; ".join(parts) or "Time against error"
    return text[:1].upper() + text[1:]


def limits(results: list[SceneResult], folder: pathlib.Path) -> list[pathlib.Path]:
    """Where steppers fail: errors that no tolerance brings down, and steps that stability dictates."""
    stuck = [r for r in results if any(stalls(r, n) for n in adaptive(r))]
    stiff = [r for r in results if any(held_by_stability(r, n) for n in adaptive(r))]
    panels: list[tuple[Any, SceneResult]] = [(_stalling, r) for r in stuck[:2]] + [(_stiff, r) for r in stiff[:2]]
    if not panels:
        return []
    with style.used() as plt:
        width = 0.3 + 5.6 * len(panels)
        figure, grid = plt.subplots(1, len(panels), figsize=(width, 5.2), squeeze=False)
        figure.subplots_adjust(left=0.85 / width, right=1 - 1.25 / width, bottom=0.21, top=0.75, wspace=0.6)
        for axes, (draw, result) in zip(grid.flat, panels):
            draw(axes, result, results)
        style.heading(figure, "Where no tolerance helps",
                      "from loose tolerances on the left to tight ones on the right", 0.3 / width)
        paths = style.save(figure, folder, "limits")
        plt.close(figure)
    return paths


def _tolerance_axis(axes: Any) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.invert_xaxis()
    _error_ticks(axes)
    axes.set_xlabel("tolerance")


def _stalling(axes: Any, result: SceneResult, results: list[SceneResult]) -> None:
    """Error against tolerance, beside error = tolerance and the closed form.

    Other programs that get no further are one grey bundle, named below the axis: their curves lie on one another.
    """
    _tolerance_axis(axes)
    names = [n for n in result.names("method", "peer") if result.of(n)[0].swept == "rtol"]
    points = [p for n in names for p in result.of(n)]
    tolerances = sorted({p.value for p in points})
    axes.plot(tolerances, tolerances, color=style.FLOOR, linewidth=1.2, linestyle=(0, (4, 3)), zorder=1)
    stalled = [n for n in adaptive(result) if stalls(result, n)]
    best = min(p.error for n in stalled for p in result.of(n))
    bundle = [n for n in result.names("peer") if n in names and min(p.error for p in result.of(n)) > 0.1 * best]
    ends: Ends = []
    for name in names:
        curve = result.of(name)
        look = style.line(name, curve[0].family, name in bundle)
        axes.plot([p.value for p in curve], [p.error for p in curve], **look)
        if name not in bundle:
            ends.append((curve[-1].value, curve[-1].error, name, look["color"]))
    for name in result.names("exact"):
        exact = result.of(name)[0]
        axes.axhline(exact.error, color=style.colour(name), linewidth=2)
        text = f"closed form: {to_error(exact.error)} in {to_time(exact.seconds)}"
        style.label(axes, tolerances[-1], exact.error, text, style.colour(name), xytext=(0, 6), va="bottom")
    axes.set_ylim(min(1e-16, tolerances[0]), 2 * LOST)
    _error_ticks(axes, "y")
    axes.set_ylabel("largest error")
    axes.annotate("error = tolerance", (1e-9, 1e-9), xytext=(-6, -4), textcoords="offset points", ha="right", va="top",
                  fontsize=9, color=style.QUIET)
    if bundle:
        axes.text(0, -0.19, textwrap.fill(f"in grey: {', '.join(bundle)}", 68), transform=axes.transAxes, va="top",
                  fontsize=8, color=style.QUIET, linespacing=1.4)
    axes.set_title(f"{result.scene.name} {result.title}: rounding keeps {', '.join(stalled)}\n"
                   f"above {to_error(best)}, whatever the tolerance")
    _spread(axes, ends)


def _stiff(axes: Any, result: SceneResult, results: list[SceneResult]) -> None:
    """Steps against tolerance: flat where stability rules, beside the other scenes where accuracy does."""
    _tolerance_axis(axes)
    held = [n for n in result.names("method") if held_by_stability(result, n)]
    name, ends = held[0], []
    rest = [r.of(name) for r in results if r is not result and r.of(name) and not held_by_stability(r, name)]
    for points in rest:
        axes.plot([p.value for p in points], [p.stats["steps"] for p in points], color=style.FLOOR, linewidth=1.1)
    if rest:
        axes.text(0.98, 0.05, f"the other scenes, {name}", transform=axes.transAxes, ha="right", fontsize=9,
                  color=style.QUIET)
    for name in held:
        points = result.of(name)
        axes.plot([p.value for p in points], [p.stats["steps"] for p in points], **style.line(name, "method"))
        end = points[-1]
        ends.append((end.value, float(end.stats["steps"]), f"{result.scene.name} {name}", style.colour(name)))
    points = result.of(name)
    steps = [p.stats["steps"] for p in points]
    axes.set_ylabel("steps")
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:,.0f}")
    axes.set_title(f"{result.scene.name} {result.title}: stability asks {name} for {min(steps):,} steps\n"
                   f"({to_time(min(p.seconds for p in points))}), whatever the tolerance")
    axes.set_ylim(None, max(e[1] for e in ends) * 2.5)
    _spread(axes, ends)
