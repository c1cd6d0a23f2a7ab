"""Style of all charts: colours that colour-blind readers can distinguish, labels at the curves, quiet axes."""

from __future__ import annotations

import pathlib
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, NamedTuple

from .. import _files
from .._core import InvalidInput

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INK, QUIET, GRID, PAPER = "#1d2733", "#66717d", "#e4e8ec", "#ffffff"
FLOOR = "#9aa4ae"


class Palette(NamedTuple):
    """The colours of a picture of a motion."""

    ink: str
    quiet: str
    grid: str
    paper: str
    floor: str                # outlines, and curves in the background
    solid: str                # what ellipsoids and spheres are filled with
    accent: str               # the curve of a picture that has one
    path: str                 # that of a path in space
    lines: tuple[str, ...]    # of x, y, z and w


LIGHT = Palette(INK, QUIET, GRID, PAPER, FLOOR, "#f3f6f9", "#d55e00", "#0072b2",
                ("#0072b2", "#d55e00", "#009e73", "#cc79a7"))
DARK = Palette("#e3e8ed", "#9aa7b4", "#2c343d", "#131416", "#5d6975", "#1d2329", "#f08a3c", "#56b4e9",
               ("#56b4e9", "#f08a3c", "#2ec99b", "#e29dc4"))

# Okabe and Ito's colours and a few more, apart with every kind of colour vision; a candidate keeps its own everywhere.
_COLOURS = {
    "rk45": "#0072b2", "dop853": "#009e73", "taylor": "#cc79a7", "radau": "#e69f00", "symplectic": "#56b4e9",
    "midpoint": "#8c6bb1", "rk4": "#a6761d", "plan": "#f0c000", "FreeMotion": "#d55e00", "HeavyTop": "#d55e00",
    "Gyrostat": "#d55e00", "formula": "#8a1c5b",
}
_PEERS = {   # by the first word: quieter than polhode's own, each program with a mark of its own
    "SciPy": ("#3f4a55", "s"), "heyoka": ("#6a3d9a", "^"), "Odeint": ("#5b7a3a", "v"), "numbalsoda": ("#2c7f86", "P"),
    "SUNDIALS": ("#8a6d3b", "X"), "MuJoCo": ("#8c3b3b", "h"), "Orekit": ("#1f3b73", "d"),
}
_SPARE = ["#1b7837", "#b3006b", "#00798c", "#7a5195", "#ef5675", "#5f7d00", "#bc5090", "#003f5c"]
_MARKERS = {"method": "o", "cheap": ".", "exact": "D", "plan": "*", "formula": "p"}
_SIZES = {"exact": 7.0, "plan": 15.0}
PALE = "#c3cad1"


def colour(name: str) -> str:
    """Return the colour of a candidate; one that is not in the table gets a spare one, always the same."""
    peer = _PEERS.get(name.split()[0])
    return _COLOURS.get(name) or (peer[0] if peer else _SPARE[sum(map(ord, name)) % len(_SPARE)])


def line(name: str, family: str, pale: bool = False) -> dict[str, Any]:
    """Return how a candidate's curve is drawn; a pale one stays in the background."""
    peer = family == "peer"
    marker = _PEERS.get(name.split()[0], ("", "s"))[1] if peer else _MARKERS.get(family, "o")
    edge = {"markeredgecolor": INK if family == "plan" else PAPER, "markeredgewidth": 0.7}
    return {"color": PALE if pale else colour(name), "marker": marker,
            "markersize": _SIZES.get(family, 3.2 if pale else 4.4),
            "linewidth": 0 if family == "plan" else 0.9 if pale else 1.3 if peer else 2.0,
            "linestyle": (0, (4, 2)) if peer else "-", "solid_capstyle": "round",
            "zorder": 5 if family == "plan" else 2.5 if pale else 3 if peer else 4} | edge


def need_matplotlib(what: str) -> None:
    """Refuse without matplotlib."""
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        raise InvalidInput(f"{what}: needs matplotlib: pip install 'polhode[plot]'") from None


def make_picture(**options: Any) -> Figure:
    """Return an empty figure that a notebook shows."""
    from .picture import Picture

    return Picture(**options)


@contextmanager
def settings(look: Palette = LIGHT) -> Iterator[None]:
    """Use the style."""
    import matplotlib

    chosen: Any = {
        "figure.facecolor": look.paper, "axes.facecolor": look.paper,
        "figure.dpi": 100, "savefig.dpi": 160, "font.family": "DejaVu Sans", "font.size": 9.5,
        "text.color": look.ink, "axes.labelcolor": look.quiet, "axes.edgecolor": look.floor, "axes.linewidth": 0.8,
        "axes.titlesize": 10.5, "axes.titleweight": "bold", "axes.titlelocation": "left", "axes.titlepad": 8,
        "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "axes.axisbelow": True,
        "grid.color": look.grid, "grid.linewidth": 0.8, "xtick.color": look.quiet, "ytick.color": look.quiet,
        "xtick.major.size": 3, "ytick.major.size": 3, "xtick.minor.size": 0, "ytick.minor.size": 0,
        "svg.fonttype": "none", "svg.hashsalt": "polhode",
    }
    with matplotlib.rc_context(chosen):
        yield


@contextmanager
def used() -> Iterator[Any]:
    """Use the style, without a display, and hand out pyplot."""
    import matplotlib

    matplotlib.use("Agg", force=False)
    import matplotlib.pyplot as plt

    with settings():
        yield plt


def heading(figure: Figure, title: str, under: str, left: float, quiet: str = QUIET) -> None:
    """Write the finding on top, and below it what was measured; `left` is where the axes begin."""
    height = figure.get_figheight()
    figure.text(left, 1 - 0.2 / height, title, ha="left", va="top", fontsize=13, fontweight="bold", linespacing=1.25)
    lines = title.count("\n") + 1
    figure.text(left, 1 - (0.27 + 0.25 * lines) / height, under, ha="left", va="top", fontsize=9, color=quiet,
                linespacing=1.35)


HALO: dict[str, Any] = {"boxstyle": "square,pad=0.08", "facecolor": PAPER, "edgecolor": "none", "alpha": 0.8}


def label(axes: Axes, x: float, y: float, text: str, colour_: str, **changes: Any) -> Any:
    """Write a curve's name beside a point of it."""
    options: dict[str, Any] = {"xytext": (7, 0), "ha": "left", "va": "center", "fontsize": 9, "fontweight": "bold",
                               "bbox": HALO} | changes
    return axes.annotate(text, (x, y), textcoords="offset points", color=colour_, zorder=6, **options)


def save(figure: Figure, folder: pathlib.Path, name: str) -> list[pathlib.Path]:
    """Write PNG and SVG, and return their paths."""
    paths = [folder / f"{name}.{suffix}" for suffix in ("png", "svg")]
    for path in paths:
        with _files.whole(path, follow=False) as draft:
            figure.savefig(draft, metadata={"Date": None} if path.suffix == ".svg" else None)
    return paths
