"""Jobs given out to processes, so that a crash or a hang of one is a data point and not the end."""

from __future__ import annotations

import json
import os
import selectors
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from typing import IO, Any

from .family import Point, from_json
from .jobs import Job

COMMAND = (sys.executable, "-m", "polhode.atlas.worker")
PATIENCE = 10.0   # times the limit of a run, in CPU: a point is a few runs
SILENCE = 60.0    # seconds of wall time without a sign of life

Done = Callable[[Job, list[Point]], object]


class _Worker:
    """A process and the job it has."""

    def __init__(self, command: Sequence[str]) -> None:
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.job: Job | None = None
        self.points: list[Point] = []
        self.heard = time.monotonic()
        self.cpu = self.mark = 0.0   # of the process, now and at its last point
        self._rest = b""

    @property
    def out(self) -> IO[bytes]:
        assert self.process.stdout is not None
        return self.process.stdout

    def give(self, job: Job) -> None:
        self.job, self.points, self.heard, self.mark = job, [], time.monotonic(), self.cpu
        assert self.process.stdin is not None
        try:
            self.process.stdin.write(json.dumps(job._asdict()).encode() + b"\n")
            self.process.stdin.flush()
        except BrokenPipeError:
            pass   # its end is seen when its output is read

    def read(self) -> tuple[bool, bool]:
        """Take what has come; whether the job is done, and whether the process has ended."""
        chunk = os.read(self.out.fileno(), 1 << 16)
        self.heard = time.monotonic()
        *lines, self._rest = (self._rest + chunk).split(b"\n")
        done = False
        for line in lines:
            content: dict[str, Any] = json.loads(line)
            if "cpu" in content:
                self.cpu = content["cpu"]
                continue
            self.mark = self.cpu
            if "fault" in content:
                self.points.append(Point(float("nan"), status="failed", why=content["fault"]))
            elif "end" in content:
                done = True
            else:
                self.points.append(from_json(content))
        return done, not chunk

    def stop(self) -> int:
        self.process.kill()
        code = self.process.wait()
        for pipe in (self.process.stdin, self.process.stdout):
            if pipe is not None:
                try:
                    pipe.close()
                except BrokenPipeError:
                    pass
        return code


def _how_it_ended(code: int) -> str:
    return f"the process ended: {signal.Signals(-code).name}" if code < 0 else f"the process ended with status {code}"


def work(jobs: Sequence[Job], done: Done, *, processes: int = 2, command: Sequence[str] = COMMAND,
         silence: float = SILENCE) -> None:
    """Do all jobs, in their order, and hand over the points of each as soon as it ends.

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
    workers: list[_Worker] = []
    selector = selectors.DefaultSelector()

    def start() -> None:
        worker = _Worker(command)
        selector.register(worker.out, selectors.EVENT_READ, worker)
        workers.append(worker)
        worker.give(waiting.pop())

    def finish(worker: _Worker, why: str, code_known: bool = False) -> None:
        """Take a process out; what it was at counts as failed, for this reason."""
        selector.unregister(worker.out)
        code = worker.process.wait() if code_known else 0
        worker.stop()
        workers.remove(worker)
        job = worker.job
        if job is not None:
            said = why or _how_it_ended(code)
            done(job, [*worker.points, Point(float("nan"), status="failed", why=said)])

    try:
        while waiting or any(w.job for w in workers):
            while waiting and len(workers) < processes:
                start()
            for event, _ in selector.select(timeout=0.5):
                worker: _Worker = event.data
                complete, ended = worker.read()
                if complete and worker.job is not None:
                    job, points = worker.job, worker.points
                    worker.job = None
                    done(job, points)
                    if waiting and not ended:
                        worker.give(waiting.pop())
                if ended:
                    finish(worker, "", code_known=True)
            now = time.monotonic()
            for worker in [w for w in workers if w.job]:
                assert worker.job is not None
                spent = worker.cpu - worker.mark
                if now - worker.heard > silence or spent > PATIENCE * worker.job.limit:
                    finish(worker, f"hung: no answer for {max(now - worker.heard, spent):.0f} s")
    finally:
        selector.close()
        for worker in list(workers):
            worker.stop()
