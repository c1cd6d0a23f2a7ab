"""Worker processes of this machine as an executor. One that dies costs its own chunk alone.

The standard library's pool of processes is broken by the first process that dies: it does not say which chunk killed
it, and it imports the caller's script again. These workers do neither.
"""

from __future__ import annotations

import concurrent.futures
import os
import queue
import sys
import threading
from collections.abc import Callable
from typing import Any

from .._workers import Worker, command
from . import worker

MODULE = worker.__name__


class WorkerDied(RuntimeError):
    """The process that computed a chunk ended before it answered."""


class Processes(concurrent.futures.Executor):
    """So many worker processes, each started with its first chunk."""

    def __init__(self, count: int) -> None:
        self.count = count
        self._tasks: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._ending = False
        self._living: dict[int, Worker] = {}
        self._lock = threading.Lock()
        self._threads = [threading.Thread(target=self._serve, args=(i,), daemon=True) for i in range(count)]
        for thread in self._threads:
            thread.start()

    @property
    def pids(self) -> list[int]:
        """The processes that are alive."""
        with self._lock:
            return [living.pid for living in self._living.values()]

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> concurrent.futures.Future[Any]:
        """Queue a call."""
        future: concurrent.futures.Future[Any] = concurrent.futures.Future()
        self._tasks.put((future, fn, args))
        return future

    def _worker(self, index: int) -> Worker:
        with self._lock:
            found = self._living.get(index)
            if found is None:
                found = self._living[index] = Worker(*command(MODULE))
                found.tell((worker.extend_path, (sys.path,)))
                while (messages := found.receive(1.0)) is not None and "end" not in [kind for kind, _ in messages]:
                    pass
            return found

    def _serve(self, index: int) -> None:
        while (task := self._tasks.get()) is not None:
            future, function, arguments = task
            if self._ending or not future.set_running_or_notify_cancel():
                continue
            try:
                future.set_result(self._call(index, function, arguments))
            except Exception as error:   # it belongs to whoever waits for the chunk
                future.set_exception(error)

    def _call(self, index: int, function: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
        process = self._worker(index)
        process.tell((function, arguments))
        answers = []
        while True:
            messages = process.receive(1.0)
            if messages is None:
                with self._lock:
                    self._living.pop(index, None)
                raise WorkerDied(f"the worker {process.end(kill=False)}")
            for kind, content in messages:
                if kind == "answer":
                    answers.append(content)
                elif content:
                    raise RuntimeError(content)
                else:
                    return answers[0]

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End all processes at once; a chunk that one is computing is lost."""
        self._ending = True
        for _ in self._threads:
            self._tasks.put(None)
        with self._lock:
            for living in self._living.values():
                living.kill()
        for thread in self._threads:
            thread.join(timeout=10)
        for living in self._living.values():
            living.end()
        self._living.clear()


def default_count() -> int:
    """Return the number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
