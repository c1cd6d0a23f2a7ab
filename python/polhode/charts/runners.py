"""What runs candidates: this process, or one of their own that may crash or hang without ending the chart."""

from __future__ import annotations

import os
import pickle
import time
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from .._scene.scene import Scene
from .._workers import Worker, command
from .candidate import Answer, Candidate, Failure, Run
from .candidates import candidates

WARM = 0.5      # seconds: a first run shorter than this is warm-up, and is run again
START = 120.0   # seconds a candidate may take to get ready
GRACE = 15.0    # seconds a run may overstay before its process is ended, and four times its limit


class Reply(NamedTuple):
    """An answer, the thread's CPU seconds it took, and those that its first run took longer."""

    answer: Answer
    seconds: float
    warm_up: float


class InProcess:
    """Runs candidates in this process."""

    def __init__(self, taking_part: list[Candidate]) -> None:
        self._candidates = {candidate.name: candidate for candidate in taking_part}
        self._runs: dict[str, Run] = {}
        self._answers: dict[tuple[str, float], Answer] = {}
        self._scene: Scene | None = None

    def enter(self, scene: Scene) -> None:
        """Forget the last scene and take this one."""
        self._scene, self._runs, self._answers = scene, {}, {}

    def start(self, name: str) -> float:
        """Get a candidate ready; return the seconds of wall time this took."""
        assert self._scene is not None
        begin = time.perf_counter()
        self._runs[name] = self._guarded(lambda: self._candidates[name].start(self._scene))
        return time.perf_counter() - begin

    def run(self, name: str, value: float, limit: float) -> Reply:
        """Answer once within a limit of wall time; a short first run is warm-up."""
        if name not in self._runs:
            self.start(name)
        begin = time.thread_time()
        answer: Answer = self._guarded(lambda: self._runs[name](value, limit))
        first = time.thread_time() - begin
        self._answers[name, value] = answer
        if first > WARM:
            return Reply(answer, first, 0.0)
        second = self.clock(name, value, 1)
        return Reply(answer, second, max(0.0, first - second))

    def clock(self, name: str, value: float, calls: int) -> float:
        """Run without a limit; return the mean seconds of a call. The answer must be the one there was before."""
        if name not in self._runs:   # its process was made anew
            self.start(name)
        run = self._runs[name]
        begin = time.thread_time()
        for _ in range(calls):
            answer = run(value, None)
        seconds = (time.thread_time() - begin) / calls
        before = self._answers.get((name, value), answer)
        if not (np.array_equal(answer.omega, before.omega, equal_nan=True)
                and np.array_equal(answer.attitude, before.attitude, equal_nan=True)):
            raise Failure("another answer the second time")
        return seconds

    @staticmethod
    def _guarded(action: Any) -> Any:
        try:
            return action()
        except Failure:
            raise
        except Exception as error:   # a candidate may raise anything, and the others go on
            raise Failure(f"{type(error).__name__}: {error}".splitlines()[0]) from None

    def close(self) -> None:
        """Nothing is held here."""


class Subprocess:
    """Runs candidates in a process of their own, which is ended when it hangs and made anew when it is gone."""

    def __init__(self) -> None:
        self._process: Worker | None = None
        self._scene: Scene | None = None

    def enter(self, scene: Scene) -> None:
        """Forget the last scene and take this one."""
        self._scene = scene
        self._ask(START, "enter", scene)

    def start(self, name: str) -> float:
        """Get a candidate ready; return the seconds of wall time this took."""
        return float(self._ask(START, "start", name))

    def run(self, name: str, value: float, limit: float) -> Reply:
        """Answer once; a crash and a hang are failures."""
        reply: Reply = self._ask(4 * limit + GRACE, "run", name, value, limit)
        return reply

    def clock(self, name: str, value: float, calls: int) -> float:
        """Run without a limit; return the mean seconds of a call."""
        return float(self._ask(START, "clock", name, value, calls))

    def _open(self) -> Worker:
        self._process = Worker(*command(__name__))
        self._ask(START, "enter", self._scene)   # also after one that is gone
        return self._process

    def _ask(self, patience: float, *message: Any) -> Any:
        process = self._process or self._open()
        process.tell(message)
        replies: list[tuple[str, Any]] = []
        end = time.monotonic() + patience
        while not replies or replies[-1][0] != "end":
            left = end - time.monotonic()
            messages = process.receive(max(0.0, left))
            if messages is None or left <= 0:
                how = self.close(kill=messages is not None)
                raise Failure(how if messages is None else f"hung: not back after {patience:.0f} s")
            replies += messages
        content = replies[0][1]   # or, at the end, why there is none
        if len(replies) < 2 or isinstance(content, Failure):
            raise Failure(str(content))
        return content

    def close(self, kill: bool = True) -> str:
        """End the process; say how it went."""
        process, self._process = self._process, None
        return process.end(kill) if process else ""


class Both:
    """Runs entrants in this process, and the other candidates by another runner."""

    def __init__(self, entrants: list[Candidate], others: InProcess | Subprocess) -> None:
        self._names = {candidate.name for candidate in entrants}
        self._here, self._others = InProcess(entrants), others

    def _of(self, name: str) -> InProcess | Subprocess:
        return self._here if name in self._names else self._others

    def enter(self, scene: Scene) -> None:
        """Forget the last scene and take this one."""
        self._here.enter(scene)
        self._others.enter(scene)

    def start(self, name: str) -> float:
        """Get a candidate ready; return the seconds of wall time this took."""
        return self._of(name).start(name)

    def run(self, name: str, value: float, limit: float) -> Reply:
        """Answer once; an entrant's run is not ended by the limit."""
        return self._of(name).run(name, value, limit)

    def clock(self, name: str, value: float, calls: int) -> float:
        """Run without a limit; return the mean seconds of a call."""
        return self._of(name).clock(name, value, calls)

    def close(self) -> None:
        """End the other runner."""
        self._others.close()


Runner = InProcess | Subprocess | Both


def make_handler() -> Callable[[tuple[Any, ...]], Iterator[Any]]:
    """Return what a `Subprocess` does with a message: it calls a method of `InProcess` with arguments."""
    runner = InProcess(candidates())

    def answer(message: tuple[Any, ...]) -> Iterator[Any]:
        try:
            yield getattr(runner, message[0])(*message[1:])
        except Failure as failure:   # in its own words
            yield failure

    return answer


def make_runner(taking_part: list[Candidate], scenes: list[Scene]) -> tuple[InProcess | Subprocess, str]:
    """Return a process of the candidates' own where that can be, else this one, and why."""
    if os.name != "posix":
        return InProcess(taking_part), "all in this process: one apart needs POSIX"
    try:
        pickle.dumps(scenes)
    except Exception as error:   # such as a torque that is a function of a notebook
        return InProcess(taking_part), f"all in this process: a scene cannot be sent to another ({error})"
    return Subprocess(), ""
