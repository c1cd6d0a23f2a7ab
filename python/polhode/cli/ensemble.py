"""`polhode ensemble`: run a recipe, show the state of a run, and write its report."""

from __future__ import annotations

import errno
import pathlib
import sys
from typing import Annotated, Any

import typer
from rich.text import Text

from .. import _files
from .._core import InvalidInput
from . import show
from .streams import say, write_json

WORDS = ("status", "report")   # they win over files of these names


def ensemble(
    what: Annotated[list[str], typer.Argument(
        help="A recipe file. Or `status` and a store, or `report` and a store.")],
    output: Annotated[pathlib.Path | None, typer.Option(
        "-o", "--output", help="Folder of the store; of `report`, the HTML file.")] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on with the store, or begin it.")] = False,
    workers: Annotated[int | None, typer.Option(
        help="Number of worker processes; by default one for each processor.")] = None,
    scheduler: Annotated[str | None, typer.Option(help="Address of a Dask scheduler, such as tcp://host:8786.")] = None,
    count: Annotated[int | None, typer.Option(help="Number of bodies, instead of the recipe's.")] = None,
    dry_run: Annotated[bool, typer.Option(
        "--dry-run", help="Print bodies, states, bytes and hours; compute a few bodies only.")] = False,
    verify: Annotated[bool, typer.Option("--verify", help="Of status: read every file and check it.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON instead of a table.")] = False,
) -> int:
    """Compute many bodies that a recipe draws.

    A run that ended early goes on with --resume. `polhode ensemble status STORE` shows what is done, also during a run.
    `polhode ensemble report STORE` writes a page with the spread against time.
    """
    if what[0] in WORDS:
        if len(what) != 2:
            raise InvalidInput(f"{what[0]}: must be followed by one store, got {len(what) - 1}")
        for name, given in (("--resume", resume), ("--workers", workers is not None), ("--count", count is not None),
                            ("--scheduler", scheduler is not None), ("--dry-run", dry_run)):
            if given:
                raise InvalidInput(f"{name}: must be used with a recipe, got {what[0]}")
        return _status(what[1], verify, as_json) if what[0] == "status" else _report(what[1], output)
    if len(what) != 1:
        raise InvalidInput(f"recipe: must be one file, got {len(what)}")
    if verify:
        raise InvalidInput("--verify: must be used with status, got a recipe")
    if workers is not None and scheduler is not None:
        raise InvalidInput("--workers: must be given, or else --scheduler, got both")
    if workers is not None and workers < 1:
        raise InvalidInput(f"--workers: must be 1 or more, got {workers}")
    if output is None and not dry_run:
        raise InvalidInput("--output: missing; it names the folder of the store")
    if dry_run:
        return _dry_run(what[0], output, workers, count, as_json)
    return _run(what[0], output, resume, scheduler if scheduler is not None else workers, count, as_json)


def _run(recipe: str, output: Any, resume: bool, executor: Any, count: int | None, as_json: bool) -> int:
    from .._ensemble.run import ensemble as run_ensemble

    with show.Bar("bodies") as bar:
        try:
            run = run_ensemble(recipe, out=output, resume=resume, executor=executor, count=count, progress=bar.fraction)
        except OSError as error:
            if error.errno not in (errno.ENOSPC, errno.EDQUOT):
                raise
            say(f"{output}: {error.strerror}; --resume goes on")
            return 1
    from .._ensemble.status import status

    _print(status(run), as_json)
    for chunk, why in run.failed.items():
        say(f"chunk {chunk} was given up: {why}")
    return 1 if run.failed else 0


def _dry_run(recipe: str, output: Any, workers: int | None, count: int | None, as_json: bool) -> int:
    from .._ensemble import forecast
    from .._ensemble.processes import default_count
    from .._ensemble.run import prepare

    found = forecast.make(prepare(recipe, out=output or "out.zarr", count=count))
    content = found.as_dict(workers or default_count())
    if output is None:
        content |= {"free_bytes": None, "fits": None}
    if as_json:
        write_json(content)
    else:
        out = show.console()
        rows = {"bodies": f"{found.bodies:,}", "times": f"{found.times:,}", "states": f"{found.states:,}",
                "chunks": f"{found.chunks:,} of {found.chunk:,} bodies", "store": f"about {found.bytes:,} bytes",
                "time": f"about {content['hours']:.2g} hours with {content['workers']} workers of this machine"}
        for name, text in rows.items():
            out.print(Text(f"{name:<8}{text}"))
    if output is not None and not found.fits:
        print(f"polhode: {output}: the store needs {found.bytes} bytes and the disk has {found.free_bytes}: "
              f"{found.bytes - found.free_bytes} are missing", file=sys.stderr)
        return 1
    return 0


def _status(out: str, verify: bool, as_json: bool) -> int:
    from .._ensemble import status
    from .._ensemble.load import open_run

    run = open_run(out)
    if verify:
        status.verify(run)
    content = status.status(run)
    _print(content, as_json)
    return 1 if content["failed_chunks"] else 0


def _print(content: dict[str, Any], as_json: bool) -> None:
    from .._ensemble.progress import to_text

    if as_json:
        write_json(content)
        return
    out = show.console()
    share = 100 * content["bodies_done"] / content["bodies"]
    head = f"{content['name']}: {content['bodies_done']:,} of {content['bodies']:,} bodies ({share:.3g} %)"
    if content["seconds_left"] is not None:
        head += f", {to_text(content['seconds_left'])} left"
    elif not content["complete"]:
        head += ", not running"
    out.print(Text(head))
    counts = {key: value for key, value in content["counts"].items() if value and key not in ("bodies", "worst_error")}
    if counts:
        out.print(Text("counts  " + ", ".join(f"{value:,} {key}" for key, value in counts.items())))
    if content["certified"] is not None:
        out.print(Text(f"error   {100 * content['certified']:.4g} % certified, largest bound "
                       f"{content['counts']['worst_error']:.2g}"))
    for name, early in content["summary"].items():
        if "spread" in early:
            out.print(Text(f"{name}  at the last time: spread {_short(early['spread'])} rad"))
        else:
            parts = ", ".join(f"{share} below {_short(upper)}" for share, (_, upper) in early["quantiles"].items())
            out.print(Text(f"{name}  at the last time: rms {_short(early['rms'])} {early['unit']}; shares {parts}"))
    for chunk, why in content["failed_chunks"].items():
        out.print(Text(f"failed  chunk {chunk}: {why}"))


def _short(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"


def _report(out: str, output: pathlib.Path | None) -> int:
    from .._ensemble.load import open_run
    from .._ensemble.report import page
    from . import files

    path = output or pathlib.Path(f"{out.rstrip('/')}.html")
    files.check(path, (".html",))
    _files.write(path, page(open_run(out)), follow=output is not None)   # else a name beside a foreign store
    print(path)
    return 0
