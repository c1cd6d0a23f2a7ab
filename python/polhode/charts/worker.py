"""The process that candidates run in: `python -m polhode.charts.worker`, by pickled messages on its standard streams."""

from __future__ import annotations

import os
import sys

from .candidate import Failure
from .candidates import candidates
from .stage import Here, receive, send


def main() -> None:
    """Answer messages (what, arguments...) with (whether it went well, content or why not), until there are no more."""
    replies = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)   # what a program prints is not a reply
    stage = Here(candidates())
    while (message := receive(sys.stdin.buffer)) is not None:
        try:
            send(replies, (True, getattr(stage, message[0])(*message[1:])))
        except Failure as failure:
            send(replies, (False, str(failure)))
        except Exception as error:   # while repeating, for one
            send(replies, (False, f"{type(error).__name__}: {error}".splitlines()[0]))


if __name__ == "__main__":
    main()
