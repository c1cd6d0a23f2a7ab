"""Which method for which scene, and how fast: the fastest of polhode at each error, as a picture and as rows."""

from __future__ import annotations

import pathlib
from collections import Counter

from .._plot import style
from .._plot.text import to_error, to_time
from .measure import Point, SceneResult

LEVELS = (1e-3, 1e-6, 1e-9, 1e-12)
OWN = ("method", "cheap", "plan", "exact")
PICTURE = "which_method"


def fastest(result: SceneResult, level: float) -> Point | None:
    """Return the point of polhode's candidates that reaches an error first."""
    reaching = [p for p in result.points if p.answered and p.family in OWN and p.error <= level]
    return min(reaching, key=lambda p: p.seconds, default=None)


def _kind(point: Point) -> str:
    return "closed forms" if point.family == "exact" else "solve with its plan" if point.family == "plan" else (
        point.candidate)


def finding(results: list[SceneResult]) -> str:
    """Return in words who is fastest how often."""
    points = [fastest(result, level) for result in results for level in LEVELS]
    counts = Counter(_kind(point) for point in points if point is not None)
    words = [f"{name} in {count}" for name, count in counts.most_common(4)]
    if not words:
        return "No method reaches these errors"
    return f"Fastest of {len(points)} cases: {', '.join(words)}"


def rows(results: list[SceneResult]) -> list[list[str]]:
    """Return a row for each scene: its name, and the fastest with its time at each error."""
    found = []
    for result in results:
        points = [fastest(result, level) for level in LEVELS]
        cells = ["–" if point is None else f"{point.candidate} {to_time(point.seconds)}" for point in points]
        found.append([result.scene.name, *cells])
    return found


def picture(results: list[SceneResult], folder: pathlib.Path) -> list[pathlib.Path]:
    """Draw the table of the fastest: a row a scene, a column an error, coloured by the method."""
    from matplotlib.patches import Rectangle

    count, columns = len(results), len(LEVELS)
    width, height = 10.4, 1.55 + 0.46 * count
    with style.used() as plt:
        figure = plt.figure(figsize=(width, height))
        axes = figure.add_axes((0.27, 0.12 / height, 0.715, 1 - 1.55 / height))
        axes.set_xlim(0, columns)
        axes.set_ylim(count, 0)
        axes.set_axis_off()
        for column, level in enumerate(LEVELS):
            axes.text(column + 0.5, -0.18, f"error ≤ {to_error(level)}", ha="center", va="bottom", color=style.QUIET)
        for row, result in enumerate(results):
            axes.text(-0.06, row + 0.5, f"{result.scene.name}  {result.title}".strip(), ha="right", va="center")
            for column, level in enumerate(LEVELS):
                point = fastest(result, level)
                ink = style.FLOOR if point is None else style.colour(
                    "plan" if point.family == "plan" else point.candidate)
                for across, alpha in ((0.96, 0.22), (0.022, 1.0)):
                    axes.add_patch(Rectangle((column + 0.02, row + 0.05), across, 0.9, facecolor=ink, alpha=alpha,
                                             linewidth=0))
                if point is None:
                    axes.text(column + 0.5, row + 0.5, "none reached it here", ha="center", va="center",
                              color=style.QUIET, fontsize=8.5)
                    continue
                axes.text(column + 0.09, row + 0.5, point.candidate, va="center", fontweight="bold")
                axes.text(column + 0.94, row + 0.5, to_time(point.seconds), va="center", ha="right")
        style.heading(figure, "Which method for my scene, and how fast",
                      f"{finding(results)}. Times are for all samples of a scene, on one thread.", 0.03)
        paths = style.save(figure, folder, PICTURE)
        plt.close(figure)
    return paths
