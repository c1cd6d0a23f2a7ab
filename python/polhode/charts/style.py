"""How the charts look, in one place: colours that stay apart for every eye, labels at the curves, quiet axes."""

from __future__ import annotations

import pathlib
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INK, QUIET, GRID, PAPER = "#1d2733", "#66717d", "#e4e8ec", "#ffffff"
FLOOR = "#9aa4ae"

# Okabe and Ito's colours, distinguishable with every kind of colour vision; a candidate keeps its own on every picture.
_COLOURS = {
    "rk45": "#0072b2", "dop853": "#009e73", "taylor": "#cc79a7",
    "FreeMotion": "#d55e00", "HeavyTop": "#d55e00",
    "SciPy RK45": "#7a8794", "SciPy DOP853": "#3f4a55", "SciPy RK45, NumPy": "#b3a08c",
}
_SPARE = ["#e69f00", "#56b4e9", "#8c6bb1", "#a6761d", "#1b7837"]
_MARKERS = {"method": "o", "exact": "D", "peer": "s"}


def colour(name: str) -> str:
    """Return the colour of a candidate; one that is not in the table gets a spare one, always the same."""
    return _COLOURS.get(name) or _SPARE[sum(map(ord, name)) % len(_SPARE)]


def line(name: str, family: str) -> dict[str, Any]:
    """Return how a candidate's curve is drawn."""
    peer = family == "peer"
    return {"color": colour(name), "marker": _MARKERS.get(family, "o"), "markersize": 7 if family == "exact" else 4.2,
            "linewidth": 1.3 if peer else 2.0, "linestyle": (0, (4, 2)) if peer else "-", "markeredgecolor": PAPER,
            "markeredgewidth": 0.7, "zorder": 3 if peer else 4, "solid_capstyle": "round"}


@contextmanager
def used() -> Iterator[Any]:
    """Use the style, without a display, and hand out pyplot."""
    import matplotlib

    matplotlib.use("Agg", force=False)
    import matplotlib.pyplot as plt

    settings: Any = {
        "figure.facecolor": PAPER, "figure.dpi": 100, "savefig.dpi": 160, "font.family": "DejaVu Sans",
        "font.size": 9.5,
        "text.color": INK, "axes.labelcolor": QUIET, "axes.edgecolor": FLOOR, "axes.linewidth": 0.8,
        "axes.titlesize": 10.5, "axes.titleweight": "bold", "axes.titlelocation": "left", "axes.titlepad": 8,
        "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "axes.axisbelow": True,
        "grid.color": GRID, "grid.linewidth": 0.8, "xtick.color": QUIET, "ytick.color": QUIET,
        "xtick.major.size": 3, "ytick.major.size": 3, "xtick.minor.size": 0, "ytick.minor.size": 0,
        "svg.fonttype": "none", "svg.hashsalt": "polhode",
    }
    with plt.rc_context(settings):
        yield plt


def heading(figure: Figure, title: str, under: str, left: float) -> None:
    """Write the finding on top, and below it what was measured; `left` is where the axes begin."""
    height = figure.get_figheight()
    figure.text(left, 1 - 0.2 / height, title, ha="left", va="top", fontsize=13, fontweight="bold", linespacing=1.25)
    lines = title.count("\n") + 1
    figure.text(left, 1 - (0.27 + 0.25 * lines) / height, under, ha="left", va="top", fontsize=9, color=QUIET,
                linespacing=1.35)


HALO: dict[str, Any] = {"boxstyle": "square,pad=0.08", "facecolor": PAPER, "edgecolor": "none", "alpha": 0.8}


def label(axes: Axes, x: float, y: float, text: str, colour_: str, **changes: Any) -> Any:
    """Write a curve's name beside a point of it."""
    options: dict[str, Any] = {"xytext": (7, 0), "ha": "left", "va": "center"} | changes
    return axes.annotate(text, (x, y), textcoords="offset points", color=colour_, fontsize=9, fontweight="bold",
                         zorder=6, bbox=HALO, **options)


def save(figure: Figure, folder: pathlib.Path, name: str) -> list[pathlib.Path]:
    """Write PNG and SVG, and return their paths."""
    paths = [folder / f"{name}.{suffix}" for suffix in ("png", "svg")]
    for path in paths:
        figure.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else None)
    return paths
