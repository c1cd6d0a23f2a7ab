"""The standard streams of the command, also where they are closed."""

from __future__ import annotations

import contextlib
import errno
import io
import json
import math
import os
import sys
from typing import Any


class PipeClosed(Exception):
    """The reader of stdout has seen enough."""


class _Closed(io.TextIOBase):
    """What stands for a stdout that is closed."""

    def write(self, text: str) -> int:
        raise OSError(errno.EBADF, os.strerror(errno.EBADF), "stdout")

    def flush(self) -> None:
        pass


def _finite(content: Any) -> Any:
    """Return the content with null in the place of NaN and inf, which JSON does not have."""
    if isinstance(content, float):
        return content if math.isfinite(content) else None
    if isinstance(content, dict):
        return {key: _finite(value) for key, value in content.items()}
    return [_finite(value) for value in content] if isinstance(content, (list, tuple)) else content


def write_json(content: Any) -> None:
    """Print JSON, with null for a number that is not finite."""
    print(json.dumps(_finite(content), indent=1, allow_nan=False))


def open_missing() -> None:
    """Give the program the streams that its caller closed, so that no file that it opens takes their place."""
    while (number := os.open(os.devnull, os.O_RDWR)) < 3:
        pass
    os.close(number)
    if sys.stdout is None:
        sys.stdout = _Closed()
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w", encoding="utf-8")   # noqa: SIM115  it stays open


def drop_stdout() -> None:
    """Let Python's own flush at exit succeed."""
    sys.stdout = open(os.devnull, "w", encoding="utf-8")   # noqa: SIM115  it stays open


def say(text: str) -> None:
    """Print a line on stderr; it is lost where that is full."""
    with contextlib.suppress(OSError):
        print(f"polhode: {text}", file=sys.stderr)


def drop_full_stderr() -> None:
    """Let Python's own flush at exit succeed, which would change the status."""
    try:
        sys.stderr.flush()
    except OSError:
        sys.stderr = open(os.devnull, "w", encoding="utf-8")   # noqa: SIM115  it stays open
