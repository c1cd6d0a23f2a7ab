"""The log of a store's runs, in a file beside it: the store itself tells neither time nor machine."""

from __future__ import annotations

import contextlib
import json
import pathlib
import time
from typing import Any

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
            with contextlib.suppress(OSError):
                self._file = open(file_of(out), "a", encoding="utf-8")   # noqa: SIM115  closed in close()

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
    """Return the events of a store, oldest first; lines cut short are left out."""
    path = file_of(out)
    try:
        with open(path, "rb") as file:
            file.seek(max(path.stat().st_size - MOST, 0))
            lines = file.read(MOST).splitlines()
    except OSError:
        return []
    events = []
    for line in lines:
        with contextlib.suppress(ValueError):
            event = json.loads(line)
            if isinstance(event, dict) and isinstance(event.get("at"), (int, float)) and "event" in event:
                events.append(event)
    return events
