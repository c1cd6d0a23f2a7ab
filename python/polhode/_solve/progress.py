"""Progress of a long run on stderr: a bar where rich is installed, otherwise lines of text."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Callable, Iterator
from typing import Any

PATIENCE = 1.0   # seconds before anything is shown
EVERY = 10       # per cent between two lines

Progress = Callable[[float, float], object]


def _make_bar(title: str) -> Any:
    """Return rich's bar, started, or None where it is missing and where stderr is neither a terminal nor a notebook."""
    try:
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn
    except ImportError:
        return None
    console = Console(stderr=True)
    if not (console.is_terminal or console.is_jupyter):
        return None
    bar = Progress(TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn(),
                   console=console, transient=True)
    bar.start()
    bar.add_task(title, total=1.0)
    return bar


class Shown:
    """The callback of `solve`, which shows nothing of a run below a second."""

    def __init__(self, title: str) -> None:
        self._title, self._start = title, time.monotonic()
        self._bar: Any = None
        self._begun, self._last_tenth = False, -1

    def __call__(self, reached: float, last: float) -> bool:
        if time.monotonic() - self._start < PATIENCE:
            return True
        if not self._begun:
            self._bar, self._begun = _make_bar(self._title), True
        done = min(1.0, reached / last) if last else 1.0
        if self._bar is not None:
            self._bar.update(self._bar.task_ids[0], completed=done)
        elif (tenth := int(100 * done) // EVERY) != self._last_tenth:
            self._last_tenth = tenth
            with contextlib.suppress(OSError):   # a full disk is no reason to stop the work
                print(f"{self._title}: {EVERY * tenth} %", file=sys.stderr, flush=True)
        return True

    def close(self) -> None:
        """End the bar."""
        if self._bar is not None:
            self._bar.stop()


@contextlib.contextmanager
def shown(progress: Progress | bool | None, title: str) -> Iterator[Progress | None]:
    """Give the callback that belongs to the argument `progress` of `solve`."""
    if not isinstance(progress, bool):
        yield progress
    elif not progress:
        yield None
    else:
        callback = Shown(title)
        try:
            yield callback
        finally:
            callback.close()
