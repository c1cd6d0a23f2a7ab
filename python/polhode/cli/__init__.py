"""The command line: `polhode run`, `plan`, `inertia`, `chart`, `atlas` and others.

Exit status: 0 without a finding, 1 with a finding (such as a drift of an invariant, or an impossible body), 2 for bad
input, with one line that says why.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence


EXTRA = ("typer", "rich")


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command and exit with its status."""
    sys.exit(_run(arguments))


def _run(arguments: Sequence[str] | None) -> int:
    try:
        from .app import app

        given = list(sys.argv[1:] if arguments is None else arguments)
        return app(args=given or ["--help"], prog_name="polhode", standalone_mode=False) or 0
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] not in EXTRA:
            raise
        return _say(f"the command line needs {error.name}: pip install 'polhode[cli]'", 2)
    except BrokenPipeError:   # the reader has closed the pipe
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())   # because Python flushes again at exit
        return 0
    except KeyboardInterrupt:
        return _say("interrupted", 130)
    except Exception as error:
        if type(error).__name__ == "Abort":   # typer's exception for Ctrl-C
            return _say("interrupted", 130)
        if not hasattr(error, "format_message"):   # not about the arguments: a bug, shown with its traceback
            raise
        return _say(error.format_message(), 2)


def _say(text: str, status: int) -> int:
    print(f"polhode: {text}", file=sys.stderr)
    return status
