"""The engine: it gives chunks to an executor, tries those again whose worker died, and stops at a full disk."""

from __future__ import annotations

import collections
import concurrent.futures
import contextlib
from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple

from .._core import InvalidInput
from . import chunk as chunks_of
from .chunk import Outcome
from .processes import Processes, default_count
from .task import Task

TRIES = 3   # of a chunk whose worker dies
MOST_WORKERS = 4096


class Result(NamedTuple):
    """How a run ended."""

    failed: dict[int, str]          # chunks that were given up, and why
    full: Outcome | None = None     # the chunk for which the disk had no room
    stopped: bool = False           # by the caller's progress


class Workers(NamedTuple):
    """An executor, and how many chunks it is given at once."""

    executor: Any                   # None: the chunks are computed in this process
    width: int
    name: str
    is_alive: Callable[[], bool] = lambda: True


def _dask(client: Any, name: str) -> Workers:
    """A client's executor. Two chunks a thread are on their way, so that no worker waits for the next one."""
    threads = sum(client.nthreads().values())
    # Calls are never answered once the scheduler is gone.
    return Workers(client.get_executor(pure=False), 2 * max(threads, 1), name, lambda: client.status != "closed")


@contextlib.contextmanager
def open_workers(executor: Any) -> Iterator[Workers]:
    """Give the workers of the argument `executor`; what was started here is ended here.

    Raises
    ------
    InvalidInput
        For anything but None, a number, an executor, a client of Dask or a scheduler's address.
    """
    if executor is None or isinstance(executor, int) and not isinstance(executor, bool):
        count = default_count() if executor is None else executor
        if not 0 <= count <= MOST_WORKERS:
            raise InvalidInput(f"executor: must be 0 to {MOST_WORKERS} worker processes, got {count}")
        if count == 0:
            yield Workers(None, 1, "this process")
            return
        own = Processes(count)
        try:
            yield Workers(own, count, f"{count} processes")
        finally:
            own.shutdown()
    elif isinstance(executor, str):
        try:
            from distributed import Client
        except ImportError as error:
            raise InvalidInput(f"executor: needs {error.name}: pip install 'polhode[ensemble]'") from None
        try:
            client: Any = Client(executor, set_as_default=False)  # type: ignore[no-untyped-call]
        except (OSError, ValueError) as error:
            raise InvalidInput(f"executor: {executor} does not answer: {type(error).__name__}") from None
        with client:
            yield _dask(client, executor)
    elif hasattr(executor, "get_executor") and hasattr(executor, "nthreads"):
        yield _dask(executor, "dask")
    elif hasattr(executor, "submit"):
        yield Workers(executor, getattr(executor, "_max_workers", 0) or default_count(), type(executor).__name__)
    else:
        raise InvalidInput(f"executor: must be None, a number, an Executor, a Client or an address, got "
                           f"{type(executor).__name__}")


class _InFlight:
    """The chunks in flight, and those that wait."""

    def __init__(self, task: Task, chunks: Sequence[int], workers: Workers) -> None:
        self.task, self.workers = task, workers
        self.waiting = collections.deque(chunks)
        self.futures: dict[Any, int] = {}
        self.tries: collections.Counter[int] = collections.Counter()
        self.failed: dict[int, str] = {}
        self.stopping = False

    def submit(self) -> None:
        """Submit as many chunks as the workers take."""
        while self.waiting and len(self.futures) < self.workers.width:
            chunk = self.waiting.popleft()
            try:
                self.futures[self.workers.executor.submit(chunks_of.run, self.task, chunk)] = chunk
            except Exception as error:   # a broken or closed executor takes no more
                why = f"{type(error).__name__}: {error}".splitlines()[0]
                self.failed |= dict.fromkeys([chunk, *self.waiting], why)
                self.waiting.clear()

    def collect(self) -> list[Outcome]:
        """Return what has come back; chunks whose worker died wait again."""
        done, _ = concurrent.futures.wait(self.futures, timeout=0.2, return_when=concurrent.futures.FIRST_COMPLETED)
        if not done and not self.workers.is_alive():
            self.failed |= dict.fromkeys([*self.futures.values(), *self.waiting], "the scheduler is gone")
            self.futures.clear()
            self.waiting.clear()
        outcomes = []
        for future in done:
            chunk = self.futures.pop(future)
            if future.cancelled() and self.stopping:
                continue
            error = concurrent.futures.CancelledError("cancelled") if future.cancelled() else future.exception()
            outcome = Outcome(chunk, "died", str(error) or type(error).__name__) if error else future.result()
            if outcome.kind == "died":
                self.tries[chunk] += 1
                if self.tries[chunk] < TRIES:
                    self.waiting.append(chunk)
            outcomes.append(outcome)
        return outcomes

    def stop(self) -> None:
        """Start no more chunks."""
        self.waiting.clear()
        self.stopping = True
        for future in self.futures:
            future.cancel()


def run(task: Task, chunks: Sequence[int], workers: Workers, on_outcome: Callable[[Outcome], bool]) -> Result:
    """Compute chunks; `on_outcome` gets each outcome and returns False to stop."""
    in_flight = _InFlight(task, chunks, workers)
    full: Outcome | None = None
    stopped = False
    try:
        while in_flight.waiting or in_flight.futures:
            if workers.executor is None:
                outcomes = [chunks_of.run(task, in_flight.waiting.popleft())]
            else:
                in_flight.submit()
                outcomes = in_flight.collect() if in_flight.futures else []
            for outcome in outcomes:
                if outcome.kind == "failed" or outcome.kind == "died" and in_flight.tries[outcome.chunk] >= TRIES:
                    in_flight.failed[outcome.chunk] = outcome.why
                go_on = on_outcome(outcome)
                if outcome.kind == "full" or not go_on:
                    full = full or (outcome if outcome.kind == "full" else None)
                    stopped = stopped or not go_on
                    in_flight.stop()
    except BaseException:
        in_flight.stop()
        raise
    return Result(dict(sorted(in_flight.failed.items())), full, stopped)
