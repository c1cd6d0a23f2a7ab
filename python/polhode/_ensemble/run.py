"""`ph.ensemble`: run a recipe on an executor, into a store or into memory."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import Any

from .._core import InvalidInput
from . import begin, engine, layout, states, store, summary
from . import recipe as recipes
from .chunk import Outcome
from .distributions import Floats
from .ensemble import Ensemble
from .log import Log
from .progress import Progress
from .recipe import EnsembleRecipe
from .task import Task


def _check_functions(recipe: EnsembleRecipe, functions: Mapping[str, Callable[..., Any]] | None,
                     executor: Any) -> dict[str, Any]:
    given = dict(functions or {})
    wanted = {summary.function for summary in recipe.wanted if summary.of == "function"}
    if missing := wanted - given.keys():
        raise InvalidInput(f"functions: must have {min(missing)!r}, which the recipe names; files run no code")
    for name in wanted:
        if not callable(given[name]):
            raise InvalidInput(f"functions: {name} must be callable, got {type(given[name]).__name__}")
        local = getattr(given[name], "__module__", "__main__") == "__main__"
        if local and (executor is None or isinstance(executor, int) and executor):
            raise InvalidInput(f"functions: {name} must stand in a module that worker processes can import, or use "
                               f"executor=0")
    return {name: given[name] for name in sorted(wanted)}


def prepare(recipe: Any, *, out: Any = None, count: int | None = None, functions: Any = None,
            executor: Any = 0) -> Task:
    """Return the task of a recipe, checked, without running it."""
    spec = recipe if isinstance(recipe, EnsembleRecipe) else recipes.load(recipe, count)
    states.check_options(spec)
    if out is None and spec.states != "none":
        raise InvalidInput("out: must name a folder for the states that the recipe stores")
    return Task(recipes.to_message(spec), layout.make(spec), _check_functions(spec, functions, executor),
                None if out is None else os.path.abspath(os.fspath(out)))


def open_store(task: Task, resume: bool) -> list[int]:
    """Begin a store or take up an old one; return the chunks that are not done."""
    assert task.out is not None
    store.need_zarr()
    found = store.read_stamp(task.out)
    if found is None:
        with store.disk(task):
            if begin.begin(task):
                return list(range(task.layout.chunks))
        found = store.read_stamp(task.out)   # of a run that began at the same time: it writes the same bytes
        if found is None:
            raise InvalidInput(f"{task.out}: is being made by another run; start again with --resume")
    elif not resume:
        raise InvalidInput(f"{task.out}: must be a new folder; resume=True or --resume goes on with a store")
    store.check_stamp(task.out, found["stamp"], store.stamp(task))
    store.require_own(task.out)
    begin.check(task.out, task)
    store.clean(task.out)
    done = store.marked(task.out, task.layout)
    spec = recipes.from_message(task.recipe)
    store.check_files(task.out, spec, task.layout, done)
    reader = store.Reader(task.out)
    for chunk in done:
        reader.record(chunk)
    return sorted(set(range(task.layout.chunks)) - set(done))


def ensemble(
    recipe: str | os.PathLike[str],
    *,
    out: str | os.PathLike[str] | None = None,
    resume: bool = False,
    executor: Any = None,
    count: int | None = None,
    functions: Mapping[str, Callable[..., Any]] | None = None,
    progress: Callable[[int, int], object] | bool = False,
) -> Ensemble:
    """Draw the bodies of a recipe, compute their motions, and sum them up at each time.

    Parameters
    ----------
    recipe : path
        A recipe file with ``draw = "by-body"``; see docs/ensemble.md.
    out : path, optional
        A folder for the results, in Zarr. A run that ended early goes on there.
    resume : bool
        Go on with the store, or begin it if it is not there. Otherwise a store that is there is refused.
    executor : None, int, Executor, dask.distributed.Client or str, optional
        Where to compute: so many processes of this machine (None: one for each processor, 0: this process), any
        executor of `concurrent.futures`, a client of Dask, or the address of its scheduler.
    count : int, optional
        Bodies, instead of the recipe's number. They are the first ones of any larger number.
    functions : dict, optional
        The functions that summaries of the recipe name: ``function(times, omega, attitude)`` returns an array of shape
        (bodies, times).
    progress : bool or callable
        True prints to stderr. ``progress(done, total)`` is called with numbers of bodies; False from it ends the run.

    Returns
    -------
    Ensemble
        Chunks that were given up are in its `failed`.

    Raises
    ------
    InvalidInput
        For a wrong recipe, and for a store of another recipe, version or arithmetic.
    OSError
        ENOSPC when the disk is full, with the bytes that are missing. The store can be resumed.
    """
    task = prepare(recipe, out=out, count=count, functions=functions, executor=executor)
    rows: dict[int, Floats] = {}
    shown = Progress(progress, task.layout)
    with engine.open_workers(executor) as workers:
        chunks = list(range(task.layout.chunks)) if task.out is None else open_store(task, resume)
        result = _drive(task, chunks, workers, rows, shown)
    if task.out is not None and not result.failed and not result.stopped:
        finish(task)
    return Ensemble(task, rows if task.out is None else None, result.failed)


def finish(task: Task) -> None:
    """Write the summaries of all bodies, once every chunk is done."""
    assert task.out is not None
    with store.disk(task):
        for found in Ensemble(task).summary.values():
            store.write_summary(task.out, summary.arrays_of(found))
    store.clean(task.out)


def _drive(task: Task, chunks: list[int], workers: engine.Workers, rows: dict[int, Floats],
           progress: Progress) -> engine.Result:
    log = Log(task.out)
    log.write("begin", chunks=len(chunks), workers=workers.width, executor=workers.name, pid=os.getpid())
    progress.begin(task.layout.chunks - len(chunks))

    def on_outcome(outcome: Outcome) -> bool:
        log.write(outcome.kind, chunk=outcome.chunk, why=outcome.why, host=outcome.host, pid=outcome.pid,
                  seconds=round(outcome.seconds, 6), cpu=round(outcome.cpu, 6))
        if outcome.record is not None:
            rows[outcome.chunk] = outcome.record
        return progress.step(outcome.chunk) if outcome.kind in ("done", "found") else True

    try:
        result = engine.run(task, chunks, workers, on_outcome)
        log.write("end", failed=len(result.failed))
    except KeyboardInterrupt:
        log.write("interrupted")
        raise
    finally:
        progress.end()
        log.close()
    if result.full is not None:
        store.raise_full(task)
    return result
