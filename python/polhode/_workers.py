"""Worker processes that may crash, hang or be too slow without ending the caller.

A module with a function `make_handler()` can be a worker's: what that returns takes a message and yields its answers.
They come back as ("answer", content), the last followed by ("end", why they broke off or ""). Messages are pickled.
"""

from __future__ import annotations

import contextlib
import importlib
import os
import pickle
import queue
import signal
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterable, Sequence
from typing import IO, Any, TypeVar

BEAT = 1.0        # seconds between signs of life
PROGRESS = 0.01   # seconds of CPU that make one
UNREAD = 16       # pieces of a process's answers that are read ahead

_news = threading.Condition()   # something has come from a process


def command(module: str) -> tuple[str, ...]:
    """What starts a worker that answers by a module's `make_handler`."""
    return sys.executable, "-m", __name__, module


class Worker(subprocess.Popen[bytes]):
    """A process that answers messages. Ctrl-C is for the one that started it, whose end is its end too."""

    def __init__(self, *command: str) -> None:
        super().__init__(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True,
                         creationflags=getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0))
        self.alive = time.monotonic()   # when it last got anywhere: a sleep without end beats as well
        self._cpu = self._mark = 0.0    # seconds it has used: as of its last beat, and at its last answer
        self._rest = b""
        self._chunks: queue.Queue[bytes] = queue.Queue(UNREAD)
        self._over = False              # nothing more is wanted of it
        # Windows cannot wait for several pipes, so each has a thread that reads it.
        threading.Thread(target=self._pump, daemon=True).start()

    def _pump(self) -> None:
        """Pass on what the process says; the last piece is empty."""
        assert self.stdout is not None
        with self.stdout as stream:
            chunk = b"first"
            while chunk:
                chunk = os.read(stream.fileno(), 1 << 20)
                while not self._over:
                    with contextlib.suppress(queue.Full):
                        self._chunks.put(chunk, timeout=BEAT)
                        break
                with _news:
                    _news.notify_all()

    @property
    def ready(self) -> bool:
        """Whether `receive` returns at once."""
        return not self._chunks.empty()

    @property
    def spent(self) -> float:
        """Seconds of CPU since its last answer."""
        return self._cpu - self._mark

    def tell(self, message: Any) -> None:
        """Send a message."""
        self.alive = time.monotonic()
        assert self.stdin is not None
        with contextlib.suppress(BrokenPipeError):   # one that is gone says so when it is read
            _write(self.stdin, message)

    def receive(self, patience: float = 0.0) -> list[tuple[str, Any]] | None:
        """What has come in so many seconds at most, which may be nothing; None when the process has ended."""
        try:
            chunk = self._chunks.get(timeout=patience) if patience > 0 else self._chunks.get_nowait()
        except queue.Empty:
            return []
        if not chunk:
            with contextlib.suppress(queue.Full):
                self._chunks.put_nowait(chunk)   # for the next call
            return None
        self._rest += chunk
        messages = []
        while (end := _end(self._rest)) <= len(self._rest):
            kind, content = pickle.loads(self._rest[8:end])
            self._rest = self._rest[end:]
            if kind != "beat":
                messages.append((kind, content))
                self._mark = self._cpu
            if kind != "beat" or content > self._cpu + PROGRESS:
                self.alive = time.monotonic()
            self._cpu = content if kind == "beat" else self._cpu
        return messages

    def end(self, kill: bool = True) -> str:
        """End it, or wait for its own end, and say how it went."""
        if kill:
            self.kill()
        code = self.wait()
        self._over = True
        assert self.stdin is not None
        with contextlib.suppress(BrokenPipeError):   # what was not sent to one that is gone
            self.stdin.close()
        how = f"by signal {-code} ({signal.Signals(-code).name})" if code < 0 else f"with status {code}"
        return f"ended its process {how}"


AnyWorker = TypeVar("AnyWorker", bound=Worker)


def wait(workers: Sequence[AnyWorker], patience: float) -> list[AnyWorker]:
    """Return those that have said something, at the latest after so many seconds."""
    with _news:
        _news.wait_for(lambda: any(worker.ready for worker in workers), patience)
    return [worker for worker in workers if worker.ready]


def _write(stream: IO[bytes], message: Any) -> None:
    data = pickle.dumps(message)
    stream.write(struct.pack("<q", len(data)) + data)
    stream.flush()


def _end(data: bytes) -> int:
    """Where the first message ends, or more than there is."""
    return 8 + struct.unpack("<q", data[:8])[0] if len(data) >= 8 else sys.maxsize


def serve(answer: Callable[[Any], Iterable[Any]]) -> None:
    """Answer the messages on standard input until there are no more; what is raised costs the rest of one answer."""
    replies = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)   # what a program prints is not a reply
    one_at_a_time = threading.Lock()

    def say(kind: str, content: Any) -> None:
        with one_at_a_time:
            try:
                _write(replies, (kind, content))
            except OSError:   # the reader has ended
                os._exit(1)

    def beat() -> None:
        while True:
            time.sleep(BEAT)
            say("beat", time.process_time())

    threading.Thread(target=beat, daemon=True).start()
    while len(head := sys.stdin.buffer.read(8)) == 8:
        message = pickle.loads(sys.stdin.buffer.read(_end(head) - 8))
        why = ""
        try:
            for reply in answer(message):
                say("answer", reply)
        except Exception as error:   # whoever asked decides what to make of it
            why = f"{type(error).__name__}: {error}".splitlines()[0]
        say("end", why)


if __name__ == "__main__":
    serve(importlib.import_module(sys.argv[1]).make_handler())
