"""Pictures of a motion: its parts laid out on one figure, or one part in the caller's axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _wings
from .._core import InvalidInput
from .._solve.motion import Floats, Motion
from . import style
from .panels import DRAW, WITHOUT_ATTITUDE, Drawing, angles
from .track import Track, of_motion, to_times

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .._wings import Film

PARTS = tuple(DRAW)


def _choose(track: Track, parts: tuple[str, ...]) -> list[str]:
    for part in parts:
        if part not in PARTS:
            raise InvalidInput(f"plot: must be of {', '.join(PARTS)}; got {part!r}")
        if track.attitude is None and part not in WITHOUT_ATTITUDE:
            raise InvalidInput(f"plot: {part!r} must have the attitude; solve a scene whose want includes it")
    if parts:
        return list(parts)
    if track.scene.controllers:
        return ["polhode", "momentum", "rates", "commands"] if track.attitude is None else [
            "polhode", "axis", "commands", "rates", "angles", "invariants"]
    if track.attitude is None:
        return ["polhode", "momentum", "rates", "invariants"]
    return ["polhode", "axis" if track.scene.torques else "herpolhode", "momentum", "rates", "angles", "invariants"]


def _find_marks(marks: Any, track: Track) -> Floats:
    """Return the times to mark: as given, or this many evenly over the curve."""
    if marks is None:
        return np.empty(0)
    if isinstance(marks, (int, np.integer)) and not isinstance(marks, bool):
        if not 0 <= marks <= 1000:
            raise InvalidInput(f"marks: must be a number from 0 to 1000, or times; got {marks}")
        return np.linspace(track.curve.t[0], track.curve.t[-1], int(marks) + 2)[1:-1]
    return to_times(marks, "marks")


def plot(motion: Motion[Any, Any], *parts: str, ax: Axes | None = None, marks: Any = None,
         dark: bool = False) -> Figure:
    """Draw a motion; see `Motion.plot`."""
    style.need_matplotlib("plot")
    return draw(of_motion(motion), parts, ax, marks, dark)


def animate(motion: Motion[Any, Any], body: Any, axis: Any, title: str | None) -> Film:
    """Make a film of a motion; see `Motion.animate`."""
    return make_film(of_motion(motion), body, axis, title)


def make_film(track: Track, body: Any, axis: Any, title: str | None = None) -> Film:
    """Make a film of what was taken of a motion."""
    film: Film = _wings.load("_plot.film.film").Film(track, body, axis, title)
    return film


def draw(track: Track, parts: tuple[str, ...], ax: Axes | None, marks: Any, dark: bool) -> Figure:
    """Draw what was taken of a motion."""
    from .picture import Picture

    wanted, palette = _choose(track, parts), style.DARK if dark else style.LIGHT
    drawing = Drawing(track, palette, _find_marks(marks, track))
    if ax is not None:
        if len(parts) != 1:
            raise InvalidInput(f"ax: must be given with one part, got {len(parts)}")
        with style.settings(palette):
            DRAW[parts[0]](ax, drawing)
        figure: Any = ax.get_figure()
        return figure   # type: ignore[no-any-return]
    columns = {1: 1, 2: 2, 4: 2}.get(len(wanted), 3)
    rows = -(-len(wanted) // columns)
    with style.settings(palette):
        width, height = 5.0 * columns, 4.3 * rows + 0.9
        figure = Picture(figsize=(width, height))
        grid = figure.add_gridspec(rows, columns, left=0.75 / width, right=1 - 0.3 / width, bottom=0.55 / height,
                                   top=1 - 1.35 / height, wspace=0.28, hspace=0.34)
        for index, part in enumerate(wanted):
            cell = grid[divmod(index, columns)]
            if part == "angles":
                inner = cell.subgridspec(3, 1, hspace=0.18)
                angles(drawing, [figure.add_subplot(inner[k]) for k in range(3)])
            else:
                DRAW[part](figure.add_subplot(cell), drawing)
        style.heading(figure, *_words(track), 0.3 / width, palette.quiet)
    return figure   # type: ignore[no-any-return]


def _words(track: Track) -> tuple[str, str]:
    scene, curve = track.scene, track.curve
    acting = ", ".join(type(torque).__name__ for torque in scene.torques) or "no torque"
    if scene.rotors:
        acting += f"; {len(scene.rotors)} rotor" + ("s" if len(scene.rotors) > 1 else "")
    if scene.controllers:
        acting += f"; {len(scene.controllers)} controller" + ("s" if len(scene.controllers) > 1 else "")
    moments = ", ".join(f"{m:.4g}" for m in scene.inertia.moments)
    under = f"moments {moments} kg m²; {acting}; {track.source}"
    if not curve.whole:
        under += f"; curves: the first {curve.t[-1] - curve.t[0]:.3g} s of {np.ptp(track.t):.4g} s"
    return scene.name or "Motion", under
