"""A process that measures what it is told to, one job a line: `python -m polhode.atlas.worker`.

In: {"family", "entrant", "quick", "limit"}. Out: one line a point, then {"end": true}; every second {"cpu": seconds},
so that a busy machine is not taken for a hang. What happens to this process happens to one job.
"""

from __future__ import annotations

import json
import sys
import threading
import time
from typing import Any, TextIO

from .family import to_json
from .jobs import find_entrant, find_family


BEAT = 1.0   # seconds


def serve(jobs: TextIO, answers: TextIO) -> None:
    """Work until there is no more."""
    one_at_a_time = threading.Lock()

    def say(content: dict[str, Any]) -> None:
        with one_at_a_time:
            answers.write(json.dumps(content) + "\n")
            answers.flush()

    def beat() -> None:
        while True:
            time.sleep(BEAT)
            try:
                say({"cpu": time.process_time()})
            except (OSError, ValueError):   # nobody listens any more
                return

    threading.Thread(target=beat, daemon=True).start()

    for line in jobs:
        job = json.loads(line)
        try:
            family, entrant = find_family(job["family"]), find_entrant(job["entrant"])
            for point in family.measure(entrant, job["quick"], job["limit"]):
                say(to_json(point))
        except BrokenPipeError:
            raise
        except Exception as error:   # a fault of a method, or of the atlas, is told and costs one row
            say({"fault": f"{type(error).__name__}: {error}".splitlines()[0]})
        say({"end": True})


if __name__ == "__main__":
    answers, sys.stdout = sys.stdout, sys.stderr   # what a library prints must not look like an answer
    try:
        serve(sys.stdin, answers)
    except BrokenPipeError:   # nobody listens any more
        pass
