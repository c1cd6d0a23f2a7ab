"""Reports: measure, draw, and write the page."""

from __future__ import annotations

import os
import pathlib
import time
from collections.abc import Callable, Iterable
from typing import Any

from .. import _files
from .._core import InvalidInput
from .._scene.scene import Scene
from .._solve.solve import solve
from ..atlas.atlas import atlas
from ..charts.chart import chart
from ..charts.measure import SceneResult
from . import atlas_part, page

SCENES = ("S1", "S2", "S3", "S4", "S5", "S5c", "S6", "S7", "S7b", "S9", "N2", "Z1")
MOTIONS = ("S1", "S2", "S4", "S5")   # pictures of these, of those that are charted
QUICK, FULL = 95.0, 900.0            # seconds for the charts
PAGE, SCRIPT = "index.html", "plotly.min.js"


def plotly_script() -> str:
    """Return Plotly's script from its Python package, without a download."""
    try:
        from plotly.offline import get_plotlyjs  # type: ignore[import-untyped,unused-ignore]
    except ImportError:
        raise InvalidInput("report: needs plotly: pip install 'polhode[plot]'") from None
    text: str = get_plotlyjs()
    return text


def motion_pictures(names: Iterable[Any], folder: pathlib.Path) -> list[page.Picture]:
    """Draw motions, and return them for the page."""
    found = []
    for name in names:
        scene = name if isinstance(name, Scene) else Scene.load(name)
        path = folder / f"motion-{scene.name}.png"   # of lines so long that an SVG would be large
        with _files.whole(path, follow=False) as draft:
            solve(scene, accuracy=1e-9).plot().savefig(draft, dpi=130)
        found.append(page.picture(path, f"motion of {scene.name}", f"{scene.name}.",
                                  f"polhode run {scene.name} --plot {scene.name}.svg"))
    return found


def _atlas(folder: pathlib.Path, quick: bool, say: Callable[[str], object]) -> dict[str, Any]:
    """Measure the atlas; families that are finished there are kept."""
    _, content = atlas(folder=folder, quick=quick, progress=lambda done, total, text: say(f"{done}/{total} {text}"))
    return atlas_part.part(content, folder, " --quick" if quick else "")


def report(
    folder: str | os.PathLike[str],
    *,
    scenes: Iterable[Any] = SCENES,
    full: bool = False,
    budget: float | None = None,
    peers: bool = True,
    with_atlas: bool = True,
    progress: Callable[[int, str], object] = lambda done, text: None,
    show: Callable[[SceneResult], object] = lambda result: None,
) -> pathlib.Path:
    """Measure everything and write a web page about it.

    Parameters
    ----------
    folder : path
        Created if missing. It gets ``index.html``, which opens from disk without a network, Plotly's script, and
        folders with all pictures and results.
    scenes : iterable of Scene, paths or names
    full : bool
        Run everything, without the limit of a few minutes.
    budget : float, optional
        Approximate time limit of the charts [s].
    peers : bool
        Also run other programs that are installed.
    with_atlas : bool
        Also measure the atlas.
    progress, show : callable
        As for `polhode.charts.chart`.

    Returns
    -------
    path
        The path of the page.

    Raises
    ------
    InvalidInput
        For everything that `polhode.charts.chart` refuses, and without Jinja2 or Plotly.
    """
    start = time.perf_counter()
    script = plotly_script()
    home, sources = pathlib.Path(folder), list(scenes)
    results, content = chart(sources, home / "charts", budget=budget or (FULL if full else QUICK), peers=peers,
                             progress=progress, show=show)
    progress(len(results), "pictures of motion")
    drawn = [source for source, result in zip(sources, results) if result.scene.name in MOTIONS]
    motions = motion_pictures(drawn or sources[:1], home / "charts")
    atlas = _atlas(home / "atlas", not full, lambda text: progress(len(results),
                                                                   f"atlas: {text}")) if with_atlas else None
    command = "polhode report" + " --full" * full
    text = page.render(content, home / "charts", motions=motions, atlas=atlas, command=command,
                       seconds=time.perf_counter() - start)
    _files.write(home / SCRIPT, script, follow=False)
    _files.write(home / PAGE, text, follow=False)
    return home / PAGE
