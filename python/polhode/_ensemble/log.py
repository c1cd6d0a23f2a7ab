"""The log of a store's runs, in a file beside it: the store itself has neither time nor machine."""

from __future__ import annotations

import contextlib
import json
import math
import pathlib
import time
from typing import Any

from .. import _files
from .._core import InvalidInput

LATEST = 1e15        # seconds
MOST = 64_000_000   # bytes that are read: the end of a longer log


def file_of(out: str) -> pathlib.Path:
    """Return the log of a store."""
    path = pathlib.Path(out)
    return path.with_name(f"{path.name}.log")


class Log:
    """Writes one line of JSON for each event. A full disk does not stop the run."""

    def __init__(self, out: str | None) -> None:
        self._file = None
        if out is not None:
            with contextlib.suppress(OSError, InvalidInput):
                self._file = _files.open_log(file_of(out))

    def write(self, event: str, **content: Any) -> None:
        """Append an event."""
        if self._file is not None:
            with contextlib.suppress(OSError):
                self._file.write(json.dumps({"at": round(time.time(), 3), "event": event, **content}) + "\n")
                self._file.flush()

    def close(self) -> None:
        """Close the file."""
        if self._file is not None:
            with contextlib.suppress(OSError):
                self._file.close()


def read(out: str) -> list[dict[str, Any]]:
    """Return the events of a store, oldest first; lines that are damaged are left out."""
    path = file_of(out)
    try:
        with _files.opened(path, 2**62) as (file, size):
            file.seek(max(size - MOST, 0))
            lines = file.read(min(size, MOST)).splitlines()
    except (OSError, InvalidInput):
        return []
    events = []
    for line in lines:
        with contextlib.suppress(ValueError, RecursionError):
            event = json.loads(line)
            if isinstance(event, dict) and _is_event(event):
                events.append(event)
    return events


def _is_event(event: dict[str, Any]) -> bool:
    """Return whether the parts of an event that are used are of their types."""
    numbers = (event.get("at"), event.get("seconds", 0.0))
    return (isinstance(event.get("event"), str) and isinstance(event.get("why", ""), str)
            and isinstance(event.get("chunk"), (int, type(None)))
            and all(isinstance(number, (int, float)) and abs(number) < LATEST and math.isfinite(number)
                    for number in numbers))
