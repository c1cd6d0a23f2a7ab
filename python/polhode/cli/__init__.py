"""The command line: `polhode run`, `plan`, `inertia`, `chart`, `atlas` and others.

Exit status: 0 without a finding, 1 with a finding (such as a drift of an invariant, or an impossible body), or with
a file or stdout that cannot be written, 2 for bad input; one line says why.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from . import streams

EXTRA = ("typer", "rich")


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command and exit with its status."""
    streams.open_missing()
    status = 0
    refused: OSError | ValueError | None = None   # the first writing that failed: all that is read has its own messages
    try:
        status = _run(arguments)
    except OSError as error:
        refused = error
    try:
        sys.stdout.flush()   # fails once more with what a full disk left in the buffer
    except BrokenPipeError:
        streams.drop_stdout()
    except (OSError, ValueError) as error:   # a full disk; ValueError: already closed
        streams.drop_stdout()
        refused = refused or error
    if refused:
        file, reason = getattr(refused, "filename", None), getattr(refused, "strerror", None)
        status = _say(f"{file or 'stdout'}: {reason or refused}", 1)
    streams.drop_full_stderr()
    sys.exit(status)


def _run(arguments: Sequence[str] | None) -> int:
    try:
        from .app import app

        given = list(sys.argv[1:] if arguments is None else arguments)
        status = app(args=given or ["--help"], prog_name="polhode", standalone_mode=False) or 0
        return _say("interrupted", 130) if status == 130 else status   # typer's status for Ctrl-C
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] not in EXTRA:
            raise
        return _say(f"the command line needs {error.name}: pip install 'polhode[cli]'", 2)
    except streams.PipeClosed:
        streams.drop_stdout()
        return 0
    except SystemExit:
        if type(sys.stdout).__name__ != "PacifyFlushWrapper":   # typer's mark of a closed pipe, with its status 1
            raise
        streams.drop_stdout()
        return 0
    except KeyboardInterrupt:
        return _say("interrupted", 130)
    except Exception as error:
        if type(error).__name__ == "Abort":   # typer's exception for Ctrl-C
            return _say("interrupted", 130)
        if not hasattr(error, "format_message"):   # of the system, or a bug: shown with its traceback
            raise
        return _say(error.format_message(), 2)


def _say(text: str, status: int) -> int:
    streams.say(text)
    return status
