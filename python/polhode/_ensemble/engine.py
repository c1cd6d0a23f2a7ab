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


class Crew(NamedTuple):
    """An executor, and how many chunks it is given at once."""

    executor: Any                   # None: the chunks are computed in this process
    width: int
    name: str
    is_alive: Callable[[], bool] = lambda: True


def _dask(client: Any, name: str) -> Crew:
    """A client's executor. Two chunks a thread are on their way, so that no worker waits for the next one."""
    threads = sum(client.nthreads().values())
    # Calls are never answered once the scheduler is gone.
    return Crew(client.get_executor(pure=False), 2 * max(threads, 1), name, lambda: client.status != "closed")


@contextlib.contextmanager
def crew(executor: Any) -> Iterator[Crew]:
    """Give the crew of the argument `executor`; what was started here is ended here.

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
            yield Crew(None, 1, "this process")
            return
        own = Processes(count)
        try:
            yield Crew(own, count, f"{count} processes")
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
        yield Crew(executor, getattr(executor, "_max_workers", 0) or default_count(), type(executor).__name__)
    else:
        raise InvalidInput(f"executor: must be None, a number, an Executor, a Client or an address, got "
                           f"{type(executor).__name__}")


class _Flight:
    """The chunks on their way."""

    def __init__(self, task: Task, chunks: Sequence[int], crew: Crew) -> None:
        self.task, self.crew = task, crew
        self.waiting = collections.deque(chunks)
        self.flying: dict[Any, int] = {}
        self.tries: collections.Counter[int] = collections.Counter()
        self.failed: dict[int, str] = {}
        self.stopping = False

    def launch(self) -> None:
        """Submit as many chunks as the crew takes."""
        while self.waiting and len(self.flying) < self.crew.width:
            chunk = self.waiting.popleft()
            try:
                self.flying[self.crew.executor.submit(chunks_of.run, self.task, chunk)] = chunk
            except Exception as error:   # a broken or closed executor takes no more
                why = f"{type(error).__name__}: {error}".splitlines()[0]
                self.failed |= dict.fromkeys([chunk, *self.waiting], why)
                self.waiting.clear()

    def land(self) -> list[Outcome]:
        """Return what has come back; chunks whose worker died wait again."""
        done, _ = concurrent.futures.wait(self.flying, timeout=0.2, return_when=concurrent.futures.FIRST_COMPLETED)
        if not done and not self.crew.is_alive():
            self.failed |= dict.fromkeys([*self.flying.values(), *self.waiting], "the scheduler is gone")
            self.flying.clear()
            self.waiting.clear()
        landed = []
        for future in done:
            chunk = self.flying.pop(future)
            if future.cancelled() and self.stopping:
                continue
            error = concurrent.futures.CancelledError("cancelled") if future.cancelled() else future.exception()
            outcome = Outcome(chunk, "died", str(error) or type(error).__name__) if error else future.result()
            if outcome.kind == "died":
                self.tries[chunk] += 1
                if self.tries[chunk] < TRIES:
                    self.waiting.append(chunk)
            landed.append(outcome)
        return landed

    def stop(self) -> None:
        """Start no more chunks."""
        self.waiting.clear()
        self.stopping = True
        for future in self.flying:
            future.cancel()


def run(task: Task, chunks: Sequence[int], crew: Crew, heard: Callable[[Outcome], bool]) -> Result:
    """Compute chunks; `heard` gets each outcome and returns False to stop."""
    flight = _Flight(task, chunks, crew)
    full: Outcome | None = None
    stopped = False
    try:
        while flight.waiting or flight.flying:
            if crew.executor is None:
                landed = [chunks_of.run(task, flight.waiting.popleft())]
            else:
                flight.launch()
                landed = flight.land() if flight.flying else []
            for outcome in landed:
                if outcome.kind == "failed" or outcome.kind == "died" and flight.tries[outcome.chunk] >= TRIES:
                    flight.failed[outcome.chunk] = outcome.why
                go_on = heard(outcome)
                if outcome.kind == "full" or not go_on:
                    full = full or (outcome if outcome.kind == "full" else None)
                    stopped = stopped or not go_on
                    flight.stop()
    except BaseException:
        flight.stop()
        raise
    return Result(dict(sorted(flight.failed.items())), full, stopped)
