"""The atlas: measure every family, judge, draw and write."""

from __future__ import annotations

import json
import os
import pathlib
import time
from collections.abc import Callable, Iterable
from typing import Any

from .. import _files
from .._core import InvalidInput
from .._harness.folder import make_folder
from . import pictures
from .claims import find_broken
from .families import FAMILIES
from .family import Family, Point
from .jobs import Job, find_families, rows_of
from .page import page
from .results import FamilyResult, document, read_family, write_family
from .work import work

LIMIT = {True: 2.0, False: 60.0}   # seconds of CPU a point: quick, whole


def atlas(
    families: Iterable[str] = (),
    folder: str | os.PathLike[str] = "atlas",
    *,
    quick: bool = False,
    fresh: bool = False,
    processes: int = 2,
    limit: float | None = None,
    draw: bool = True,
    progress: Callable[[int, int, str], object] = lambda done, total, text: None,
    show: Callable[[FamilyResult], object] = lambda result: None,
) -> tuple[list[FamilyResult], dict[str, Any]]:
    """Measure where methods fail, and write pictures, tables and a matrix to a folder.

    Parameters
    ----------
    families : iterable of str
        Names of `FAMILIES`; all if none is given.
    folder : path
        Created if missing. It gets a picture (.png and .svg) and a .json file for each family. For all families in
        the folder it gets ``matrix``, ``atlas.json`` and the page ``atlas.md``. Finished families of the same settings
        and version are kept and not run again.
    quick : bool
        Use fewer values of the swept quantities.
    fresh : bool
        Repeat finished families.
    processes : int
        Number of worker processes.
    limit : float, optional
        Limit of CPU time of a single run [s]. Longer runs are left out, with the reason.
    draw : bool
        Draw the pictures, which needs matplotlib.
    progress : callable
        ``progress(finished rows, all rows, last finished row)``.
    show : callable
        Called with the result of each family when it is finished.

    Returns
    -------
    results : list of FamilyResult
    document : dict
        The content of atlas.json. Its "broken_claims" are claims of polhode about its methods that did not hold.

    Raises
    ------
    InvalidInput
        For an unknown family, a folder that cannot be written, a limit that is not positive.
    """
    start = time.perf_counter()
    wanted = find_families(families)
    if processes < 1:
        raise InvalidInput(f"processes: must be at least 1, got {processes}")
    seconds = LIMIT[quick] if limit is None else limit
    if not seconds > 0:
        raise InvalidInput(f"limit: must be positive, got {seconds:g}")
    output = make_folder(folder)
    results: dict[str, FamilyResult] = {}
    files: list[str] = []

    def there(result: FamilyResult) -> None:
        results[result.family.name] = result
        if draw:   # while others are measured still
            files.extend(path.name for path in pictures.draw_family(result, output))
        show(result)

    for family in wanted:
        kept = None if fresh else read_family(output / f"{family.name}.json", (quick, seconds))
        if kept is not None:
            there(kept)
    _measure([f for f in wanted if f.name not in results], there, output, quick, seconds, processes, progress)

    ordered = [results[family.name] for family in wanted]
    # The matrix is of all that the folder holds.
    held = [results.get(f.name) or read_family(output / f"{f.name}.json", (quick, seconds)) for f in FAMILIES]
    everything = [result for result in held if result is not None]
    if draw:
        files += [path.name for path in pictures.draw_matrix(everything, output)]
    files = sorted(files) + [f"{family.name}.json" for family in wanted] + ["atlas.json", "atlas.md"]
    content = document(everything, time.perf_counter() - start, find_broken(everything), files)
    _files.write(output / "atlas.json", json.dumps(content, indent=1, allow_nan=False) + "\n", follow=False)
    _files.write(output / "atlas.md", page(content), follow=False)
    return ordered, content


def _measure(
    families: list[Family], there: Callable[[FamilyResult], object], output: pathlib.Path, quick: bool, limit: float,
    processes: int, progress: Callable[[int, int, str], object],
) -> None:
    """Measure the rows of all families; write each family after its last row."""
    costliest_first = sorted(families, key=lambda f: -f.cost)   # so that all processes end together
    jobs = [Job(f.name, e.name, quick, limit) for f in costliest_first for e in rows_of(f)]
    by_name = {f.name: f for f in families}
    order = {f.name: [e.name for e in rows_of(f)] for f in families}
    rows: dict[str, dict[str, list[Point]]] = {f.name: {} for f in families}
    count = 0

    def done(job: Job, points: list[Point]) -> None:
        nonlocal count
        count += 1
        progress(count, len(jobs), f"{job.family}: {job.entrant}")
        found = rows[job.family]
        found[job.entrant] = points
        if len(found) == len(order[job.family]):
            ordered = {name: found[name] for name in order[job.family]}
            result = FamilyResult(by_name[job.family], quick, limit, ordered, made=time.strftime("%Y-%m-%d %H:%M"))
            write_family(result, output)
            there(result)

    work(jobs, done, processes=processes)
