"""Charts: measure every scene, draw the pictures, and write the files."""

from __future__ import annotations

import functools
import json
import os
import time
from collections.abc import Callable, Iterable
from typing import Any

from .. import _files
from .._core import InvalidInput
from .._harness.folder import make_folder
from .._scene.files import find_scene, read_toml
from .._scene.scene import Scene
from . import choice, pictures
from .candidates import candidates
from .engines import find_errors_per_turn
from .entrant import read_entrants
from .measure import SceneResult, measure
from .results import document
from .runners import Both, Runner, make_runner

DRAWING = 1.5    # seconds a scene's picture takes, about
GENEROUS = 1.5   # times an equal share of the time left is what a scene may use


def _title(source: Any) -> str:
    return "" if isinstance(source, Scene) else str(read_toml(find_scene(source)).get("title", ""))


def _report(progress: Callable[[int, str], object], index: int, label: str, text: str) -> None:
    progress(index, f"{label}: {text}")


def chart(
    scenes: Iterable[Any],
    folder: str | os.PathLike[str],
    *,
    budget: float = 130.0,
    peers: bool = True,
    entrants: Iterable[Any] = (),
    progress: Callable[[int, str], object] = lambda done, text: None,
    show: Callable[[SceneResult], object] = lambda result: None,
) -> tuple[list[SceneResult], dict[str, Any]]:
    """Measure scenes, draw their pictures, and write everything to a folder.

    Parameters
    ----------
    scenes : iterable of Scene, paths or names
        Scenes whose `want` has omega and attitude.
    folder : path
        Created if missing. It gets ``which_method`` (the fastest at each error), one picture for each scene,
        ``overview``, ``limits`` (if a tolerance does not help), as .png and .svg, and ``results.json``.
    budget : float
        Approximate time limit [s]. Runs that do not fit are left out, slow programs first, and listed.
    peers : bool
        Also run other programs that are installed. Missing programs are listed.
    entrants : iterable of Entrant, callables or peers
        Solvers of your own. A function ``f(scene, rtol)`` returns omega and attitude; `Entrant` has more of it.
        A module of `polhode.charts.peers` adds that program alone. Functions run in this process.
    progress : callable
        ``progress(finished scenes, present task)``.
    show : callable
        Called with the result of each scene when it is finished.

    Returns
    -------
    results : list of SceneResult
    document : dict
        The content of results.json.

    Raises
    ------
    InvalidInput
        For a scene that cannot be read, a budget that is not positive, a folder that cannot be written.
    """
    start = time.perf_counter()
    if not budget > 0:
        raise InvalidInput(f"budget: must be positive, got {budget:g}")
    sources = list(scenes)
    loaded = [(source if isinstance(source, Scene) else Scene.load(source), _title(source)) for source in sources]
    if not loaded:
        raise InvalidInput("scenes: none given")
    for scene, _ in loaded:
        if set(scene.want) != {"omega", "attitude"}:
            wanted = ", ".join(scene.want)
            raise InvalidInput(f"{scene.name or 'scene'}: want: must be omega and attitude for a chart, got {wanted}")
    names = [scene.name for scene, _ in loaded]
    if len(set(names)) < len(names):
        twice = max(names, key=names.count)
        raise InvalidInput(f"scenes: {twice!r} is given twice; each needs a name of its own for its picture")
    output = make_folder(folder)

    taking_part = candidates(peers)
    mine = read_entrants(entrants, taking_part)
    runner: Runner
    runner, together = make_runner(taking_part, [scene for scene, _ in loaded])
    if mine:
        runner, taking_part = Both(mine, runner), [*taking_part, *mine]
    results: list[SceneResult] = []
    try:
        runner.enter(loaded[0][0])   # a process apart takes a moment to be there
        for index, (scene, title) in enumerate(loaded):
            left = budget - (time.perf_counter() - start) - DRAWING * (len(loaded) + 2)
            # Most scenes need less than an equal share, and what they leave goes to those after them.
            share = max(left, 0.1 * budget) * min(1.0, GENEROUS / (len(loaded) - index))
            label = scene.name or "scene"
            report = functools.partial(_report, progress, index, label)
            results.append(measure(scene, title, taking_part, share, report, runner))
            results[-1].per_turn = find_errors_per_turn(scene)
            if together:
                results[-1].notes.append(together)
            show(results[-1])
    finally:
        runner.close()

    progress(len(results), "pictures: which method")
    files = choice.picture(results, output)   # first: it answers what most people ask
    for result in results:
        progress(len(results), f"pictures: {result.scene.name}")
        files += pictures.work_precision(result, output)
    progress(len(results), "pictures: overview")
    files += pictures.overview(results, output) + pictures.limits(results, output)
    written = [path.name for path in files] + ["results.json"]
    content = document(results, time.perf_counter() - start, written, peers)
    _files.write(output / "results.json", json.dumps(content, indent=1) + "\n", follow=False)
    return results, content
