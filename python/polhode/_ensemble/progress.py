"""The progress of an ensemble: bodies that are done, and the time that is left."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

from .._core import InvalidInput
from .layout import Layout

EVERY = 1.0   # seconds between two lines


def to_text(seconds: float) -> str:
    """Return a time for people, such as "3 min"."""
    for unit, size in (("d", 86400.0), ("h", 3600.0), ("min", 60.0)):
        if seconds >= 2 * size:
            return f"{seconds / size:.0f} {unit}"
    return f"{seconds:.0f} s"


class Progress:
    """Calls the caller's function, or prints to stderr."""

    def __init__(self, wanted: Callable[[int, int], object] | bool, layout: Layout) -> None:
        if not isinstance(wanted, bool) and not callable(wanted):
            raise InvalidInput(f"progress: must be callable, True or False, got {type(wanted).__name__}")
        self._call = wanted if callable(wanted) else self._print if wanted else None
        self._layout, self._total = layout, layout.number * layout.points
        self._done = self._begun = 0
        self._start = self._last = time.monotonic()
        self._printed = False

    def begin(self, chunks: int) -> None:
        """So many chunks were done before."""
        self._done = self._begun = min(chunks * self._layout.chunk, self._total)
        if self._call is not None and chunks:
            self._call(self._done, self._total)

    def step(self, chunk: int) -> bool:
        """A chunk is done; return False if the caller wants to stop."""
        self._done = min(self._done + self._layout.bodies(chunk), self._total)
        return self._call is None or self._call(self._done, self._total) is not False

    def _print(self, done: int, total: int) -> None:
        now = time.monotonic()
        if now - self._last < EVERY and done < total:
            return
        self._last = now
        fresh = done - self._begun
        left = f", {to_text((now - self._start) / fresh * (total - done))} left" if fresh and done < total else ""
        print(f"\r{done} of {total} bodies{left}   ", end="", file=sys.stderr, flush=True)
        self._printed = True

    def end(self) -> None:
        """The run has ended."""
        if self._printed:
            print(file=sys.stderr)
