"""Progress of long calls: what users may hand in as `progress=`."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

from .._core import InvalidInput

Report = Callable[[int, int], object]


class Printer:
    """Writes the share that is done and the time left to stderr, four times a second, on one line."""

    def __init__(self) -> None:
        """Start the clock."""
        self._begin = self._last = time.monotonic()

    def __call__(self, done: int, total: int) -> None:
        """Write the line anew; end it when all is done."""
        now = time.monotonic()
        if done < total and now - self._last < 0.25:
            return
        self._last = now
        spent = now - self._begin
        left = f", {spent * (total - done) / done:.0f} s left" if 0 < done < total else ""
        share = done / total if total else 1.0
        sys.stderr.write(f"\r{share:6.1%} of {total} states, {spent:.0f} s{left}    " + ("\n" if done >= total else ""))
        sys.stderr.flush()


def reporter(progress: Any) -> Report | None:
    """Return the callable for what a user handed in as `progress`."""
    if progress is None or progress is False:
        return None
    if progress is True:
        return Printer()
    if callable(progress):
        return progress  # type: ignore[no-any-return]
    raise InvalidInput(f"progress: must be True or a callable of (done, total), got {type(progress).__name__}")
