"""`polhode chart`, `report` and `atlas`."""

from __future__ import annotations

import pathlib
from typing import Annotated, Any

import typer

from . import show
from .options import Json, need_matplotlib, to_seconds
from .streams import write_json


def chart(
    scenes: Annotated[list[str], typer.Argument(help="Scene files, or names such as S1.")],
    output: Annotated[
        pathlib.Path, typer.Option("-o", "--output", help="Folder for all files.")] = pathlib.Path("charts"),
    budget: Annotated[
        str, typer.Option(help="Approximate time limit, such as 60s or 5min. Runs that exceed it are left out and "
                               "listed.")
    ] = "130s",
    peers: Annotated[bool, typer.Option(help="Also run other programs that are installed.")] = True,
    brief: Annotated[bool, typer.Option("--brief", help="Print the fastest at each error alone.")] = False,
    as_json: Json = False,
) -> int:
    """Chart speed against accuracy.

    Runs all methods, the plan's choice, closed forms and other programs on the given scenes, and compares them with
    the truth.
    """
    need_matplotlib("charts need")
    from ..charts import chart as make_chart
    from . import show_charts as tables

    seconds = to_seconds(budget)
    with show.Bar("charting", len(scenes), quiet=brief) as bar:
        quiet = as_json or brief
        results, content = make_chart(scenes, output, budget=seconds, peers=peers, progress=bar.step,
                                      show=lambda result: None if quiet else bar.above(tables.scene, result))
    if as_json:
        write_json(content)
    elif brief:
        tables.choice(results, content, output)
    else:
        tables.end(content, output)
    return 0


def report(
    output: Annotated[
        pathlib.Path, typer.Option("-o", "--output",
                                   help="Folder for the page and its files.")] = pathlib.Path("report"),
    full: Annotated[bool, typer.Option(help="Run everything, without the limit of a few minutes.")] = False,
    budget: Annotated[
        str | None, typer.Option(help="Approximate time limit of the charts, such as 60s or 5min.")] = None,
    peers: Annotated[bool, typer.Option(help="Also run other programs that are installed.")] = True,
    atlas: Annotated[bool, typer.Option(help="Also measure where methods fail.")] = True,
    scenes: Annotated[list[str] | None, typer.Argument(help="Scene files or names; polhode's scenes if none is "
                                                            "given.")] = None,
) -> int:
    """Write a web page of charts, pictures and tables.

    It opens from disk and needs no network.
    """
    need_matplotlib("reports need")
    from ..report import report as make_report
    from ..report.report import SCENES

    chosen = list(scenes or SCENES)
    seconds = None if budget is None else to_seconds(budget)
    with show.Bar("reporting", len(chosen)) as bar:
        page = make_report(output, scenes=chosen, full=full, budget=seconds, peers=peers, with_atlas=atlas,
                           progress=bar.step)
    print(page)
    return 0


def atlas(
    families: Annotated[list[str] | None, typer.Argument(help="Names of families; all if none is given.")] = None,
    output: Annotated[pathlib.Path, typer.Option(
        "-o", "--output", help="Folder for all files; finished families in it are kept.")] = pathlib.Path("atlas"),
    quick: Annotated[bool, typer.Option("--quick", help="Use fewer values, which takes about a minute.")] = False,
    fresh: Annotated[bool, typer.Option("--fresh", help="Repeat finished families.")] = False,
    processes: Annotated[int, typer.Option(help="Number of worker processes.")] = 2,
    limit: Annotated[
        float | None, typer.Option(help="Limit of CPU time of one run [s]; 60, or 2 with --quick.")] = None,
    as_json: Json = False,
) -> int:
    """Chart where methods fail.

    Runs every method on families of hard problems, from the tennis racket to stiff damping. Compares each result with
    the truth and a threshold.
    """
    need_matplotlib("the atlas needs")
    from ..atlas import atlas as make_atlas
    from ..report.atlas_part import write as write_page
    from . import atlas as tables

    def table(result: Any) -> None:
        if not as_json:
            bar.above(tables.family, result)

    with show.Bar("atlas") as bar:
        _, content = make_atlas(families or (), output, quick=quick, fresh=fresh, processes=processes, limit=limit,
                                progress=bar.of, show=table)
    page = write_page(content, output)
    if as_json:
        write_json(content)
    else:
        tables.matrix(content)
        tables.end(content, output)
        print(page)
    return 1 if content["broken_claims"] else 0
