"""Where candidates run: in this process, or in one of their own that may crash or hang without ending the chart."""

from __future__ import annotations

import contextlib
import os
import pickle
import select
import struct
import subprocess
import sys
import time
from typing import IO, Any, NamedTuple

import numpy as np

from ..scene import Scene
from .candidate import Answer, Candidate, Failure, Run

WARM = 0.5      # seconds: a first run shorter than this is warm-up, and is run again
START = 120.0   # seconds a candidate may take to get ready
GRACE = 15.0    # seconds a run may overstay before its process is ended, and four times its limit


class Reply(NamedTuple):
    """An answer, the thread's CPU seconds it took, and those that its first run took longer."""

    answer: Answer
    seconds: float
    warm_up: float


class Here:
    """Runs candidates in this process."""

    def __init__(self, candidates: list[Candidate]) -> None:
        self._candidates = {candidate.name: candidate for candidate in candidates}
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


def send(stream: IO[bytes], message: Any) -> None:
    """Write a message with its length before it."""
    data = pickle.dumps(message)
    stream.write(struct.pack("<q", len(data)) + data)
    stream.flush()


def receive(stream: IO[bytes]) -> Any:
    """Read a message; None at the end."""
    head = stream.read(8)
    if len(head) < 8:
        return None
    return pickle.loads(stream.read(struct.unpack("<q", head)[0]))


class Apart:
    """Runs candidates in a process of their own, which is ended when it hangs and made anew when it is gone."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None
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

    def _open(self) -> subprocess.Popen[bytes]:
        process = subprocess.Popen([sys.executable, "-m", "polhode.charts.worker"], stdin=subprocess.PIPE,
                                   stdout=subprocess.PIPE, start_new_session=True)   # Ctrl-C is for this one
        self._process = process
        self._ask(START, "enter", self._scene)   # also after one that is gone
        return process

    def _ask(self, patience: float, *message: Any) -> Any:
        process = self._process or self._open()
        assert process.stdin is not None and process.stdout is not None
        try:
            send(process.stdin, message)
        except BrokenPipeError:
            pass   # what the exit says is read below
        ready, _, _ = select.select([process.stdout], [], [], patience)
        reply = receive(process.stdout) if ready else None
        if reply is None:
            raise Failure(self._end(patience if not ready else None))
        good, content = reply
        if not good:
            raise Failure(content)
        return content

    def _end(self, waited: float | None) -> str:
        """End the process; say how it went."""
        assert self._process is not None
        process, self._process = self._process, None
        if waited is not None:
            process.kill()
        code = process.wait()
        for stream in (process.stdin, process.stdout):
            assert stream is not None
            with contextlib.suppress(BrokenPipeError):   # what was not sent to a process that is gone
                stream.close()
        if waited is not None:
            return f"hung: not back after {waited:.0f} s"
        return f"ended its process by signal {-code}" if code < 0 else f"ended its process with status {code}"

    def close(self) -> None:
        """End the process."""
        if self._process is not None:
            self._end(0.0)


def make_stage(candidates: list[Candidate], scenes: list[Scene]) -> tuple[Here | Apart, str]:
    """Return a process apart where that can be, else this one, and why."""
    if os.name != "posix":
        return Here(candidates), "all in this process: one apart needs POSIX"
    try:
        pickle.dumps(scenes)
    except Exception as error:   # such as a torque that is a function of a notebook
        return Here(candidates), f"all in this process: a scene cannot be sent to another ({error})"
    return Apart(), ""
