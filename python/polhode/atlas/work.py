"""Jobs given out to processes, so that a crash or a hang of one is a data point and not the end."""

from __future__ import annotations

import select
import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from .. import workers
from ..workers import Worker
from .family import Point, from_json, to_json
from .jobs import Job, find_entrant, find_family

PATIENCE = 10.0   # times the limit of a run, in CPU: a point is a few runs
SILENCE = 60.0    # seconds of wall time without a sign of life

Done = Callable[[Job, list[Point]], object]


def answerer() -> Callable[[Job], Iterator[dict[str, Any]]]:
    """What a worker does: the points of one row, each with the CPU time it took."""
    def answer(job: Job) -> Iterator[dict[str, Any]]:
        mark = time.process_time()
        for point in find_family(job.family).measure(find_entrant(job.entrant), job.quick, job.limit):
            point.cpu = time.process_time() - mark
            yield to_json(point)
            mark = time.process_time()

    return answer


class _Hand(Worker):
    """A worker and the job it has."""

    job: Job | None = None
    points: list[Point]

    def give(self, job: Job) -> None:
        self.job, self.points, self.limit = job, [], job.limit
        self.tell(job)

    def broke_off(self, why: str) -> None:
        """What it was at counts as failed, for this reason."""
        if why:
            self.points.append(Point(float("nan"), status="failed", why=why, cpu=self.spent))

    def take(self) -> bool | None:
        """Take what has come; whether the job is done, None when the process has ended."""
        heard = self.hear()
        for kind, content in heard or ():
            if kind == "answer":
                self.points.append(from_json(content))
            else:
                self.broke_off(content)
        return None if heard is None else bool(heard) and heard[-1][0] == "end"


def work(jobs: Sequence[Job], done: Done, *, processes: int = 2,
         command: Sequence[str] = workers.command(__name__), silence: float = SILENCE) -> None:
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
    hands: list[_Hand] = []

    def hand_over(hand: _Hand) -> None:
        job, hand.job = hand.job, None
        if job is not None:
            done(job, hand.points)

    def lay_off(hand: _Hand, why: str = "") -> None:
        """Take a process out, with what it was at."""
        hands.remove(hand)
        ended = hand.end(kill=bool(why))
        if hand.job:
            hand.broke_off(why or ended)
        hand_over(hand)

    try:
        while waiting or any(hand.job for hand in hands):
            hands += [_Hand(*command) for _ in range(min(len(waiting), processes - len(hands)))]
            for hand in hands:
                if waiting and not hand.job:
                    hand.give(waiting.pop())
            for hand in select.select(hands, [], [], 0.5)[0]:
                complete = hand.take()
                if complete is None:
                    lay_off(hand)
                elif complete:
                    hand_over(hand)
            for hand in [hand for hand in hands if hand.job]:
                quiet = time.monotonic() - hand.alive
                if quiet > silence or hand.spent > PATIENCE * hand.limit:
                    lay_off(hand, f"hung: no answer for {max(quiet, hand.spent):.0f} s")
    finally:
        for hand in hands:
            hand.end()
