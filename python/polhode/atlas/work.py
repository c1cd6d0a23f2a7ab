"""Jobs in worker processes, so that a crash or a hang is a data point and does not end the atlas."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from .. import _workers
from .._workers import Worker
from .family import Point, from_json, to_json
from .jobs import Job, find_entrant, find_family

PATIENCE = 10.0   # times the limit of a run, in CPU: a point is a few runs
SILENCE = 60.0    # seconds of wall time without a sign of life

Done = Callable[[Job, list[Point]], object]


def make_handler() -> Callable[[Job], Iterator[dict[str, Any]]]:
    """Return what a worker does with a job: it yields the points of one row, each with the CPU time it took."""
    def answer(job: Job) -> Iterator[dict[str, Any]]:
        mark = time.process_time()
        for point in find_family(job.family).measure(find_entrant(job.entrant), job.quick, job.limit):
            point.cpu = time.process_time() - mark
            yield to_json(point)
            mark = time.process_time()

    return answer


class _JobWorker(Worker):
    """A worker and the job it has."""

    job: Job | None = None
    points: list[Point]

    def start(self, job: Job) -> None:
        """Give it a job."""
        self.job, self.points, self.limit = job, [], job.limit
        self.tell(job)

    def fail(self, why: str) -> None:
        """Count what it was at as failed, for this reason."""
        if why:
            self.points.append(Point(float("nan"), status="failed", why=why, cpu=self.spent))

    def take(self) -> bool | None:
        """Take what has come; whether the job is done, None when the process has ended."""
        messages = self.receive()
        for kind, content in messages or ():
            if kind == "answer":
                self.points.append(from_json(content))
            else:
                self.fail(content)
        return None if messages is None else bool(messages) and messages[-1][0] == "end"


def work(jobs: Sequence[Job], done: Done, *, processes: int = 2,
         command: Sequence[str] = _workers.command(__name__), silence: float = SILENCE) -> None:
    """Do all jobs in their order, and pass on the points of each when it ends.

    Parameters
    ----------
    jobs : sequence of Job
    done : callable
        ``done(job, points)``, in this process. A job whose process crashed or hung has a last point that says so.
    processes : int
    command : sequence of str
        What starts a worker.
    silence : float
        A process that gives no sign of life for so long hangs [s]; so does one that takes `PATIENCE` times the limit of
        a run without an answer.
    """
    waiting = list(reversed(jobs))
    pool: list[_JobWorker] = []

    def hand_in(worker: _JobWorker) -> None:
        job, worker.job = worker.job, None
        if job is not None:
            done(job, worker.points)

    def dismiss(worker: _JobWorker, why: str = "") -> None:
        """Take a process out, with the job it had."""
        pool.remove(worker)
        ended = worker.end(kill=bool(why))
        if worker.job:
            worker.fail(why or ended)
        hand_in(worker)

    try:
        while waiting or any(worker.job for worker in pool):
            pool += [_JobWorker(*command) for _ in range(min(len(waiting), processes - len(pool)))]
            for worker in pool:
                if waiting and not worker.job:
                    worker.start(waiting.pop())
            for worker in _workers.wait(pool, 0.5):
                complete = worker.take()
                if complete is None:
                    dismiss(worker)
                elif complete:
                    hand_in(worker)
            for worker in [worker for worker in pool if worker.job]:
                quiet = time.monotonic() - worker.alive
                if quiet > silence or worker.spent > PATIENCE * worker.limit:
                    dismiss(worker, f"hung: no answer for {max(quiet, worker.spent):.0f} s")
    finally:
        for worker in pool:
            worker.end()
