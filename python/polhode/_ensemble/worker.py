"""What a worker process of an ensemble runs: the functions that it is sent."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from typing import Any


def extend_path(folders: list[str]) -> None:
    """Let this process import what its parent can."""
    sys.path += [folder for folder in folders if folder not in sys.path]


def make_handler() -> Callable[[Any], Iterator[Any]]:
    """Return what answers a message (function, arguments)."""

    def answer(message: Any) -> Iterator[Any]:
        function, arguments = message
        yield function(*arguments)

    return answer
