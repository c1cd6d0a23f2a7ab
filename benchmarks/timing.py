"""How the benchmarks take times."""

import time


def best(work, repeats=40):
    """The least time of a call [ns of this thread], after one that is not counted."""
    work()
    found = float("inf")
    for _ in range(repeats):
        start = time.thread_time_ns()
        work()
        found = min(found, time.thread_time_ns() - start)
    return found
