"""The state of a run: what is done, what failed, the time that is left, and early quantiles."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from . import log, store
from .ensemble import Ensemble

SHARES = (0.5, 0.95, 0.99)
ENDS = ("end", "interrupted")
QUIET = 30.0   # seconds: a run that is silent for longer than this and three of its chunks may have ended


def status(run: Ensemble) -> dict[str, Any]:
    """Return the status as `polhode ensemble status` prints it, for JSON."""
    assert run.out is not None
    chunks = run.chunks
    events = log.read(run.out)
    begin = max((i for i, event in enumerate(events) if event["event"] == "begin"), default=None)
    last = events[begin:] if begin is not None else []
    done = [event for event in last if event["event"] == "done"]
    failed = {event.get("chunk"): event.get("why") for event in last if event["event"] in ("failed", "died")}
    left = None
    silent = time.time() - last[-1]["at"] if last else None
    if done and len(chunks) < run.total_chunks:
        left = (done[-1]["at"] - last[0]["at"]) / len(done) * (run.total_chunks - len(chunks))
    longest = max((event.get("seconds", 0.0) for event in done), default=0.0)
    ended = bool(last) and last[-1]["event"] in ENDS
    running = bool(last) and not ended and silent is not None and silent < max(QUIET, 3 * longest)
    return {
        "name": run.name, "out": run.out, "bodies": run.total, "bodies_done": run.done, "chunks": run.total_chunks,
        "chunks_done": len(chunks), "complete": len(chunks) == run.total_chunks, "running": running,
        "seconds_left": left if running else None, "seconds_since_last_event": silent,
        "failed_chunks": {str(chunk): why for chunk, why in failed.items() if chunk not in chunks},
        "counts": run.counts, "certified": None if np.isnan(run.certified) else run.certified,
        "summary": {name: _early(found) for name, found in run.summary.items()},
    }


def _early(found: Any) -> dict[str, Any]:
    """Return the summary at the last time, of the first point of a sweep."""
    if found.of == "attitude":
        return {"spread": _number(np.atleast_2d(found.spread)[0, -1]), "unit": "rad"}
    bounds = found.quantile(SHARES)
    parts = {f"{share:g}": [_number(np.reshape(side, (-1, len(SHARES)))[found.mean.shape[-1] - 1, k])
                            for side in (bounds.lower, bounds.upper)] for k, share in enumerate(SHARES)}
    return {"rms": _number(np.atleast_2d(found.rms)[0, -1]), "quantiles": parts, "unit": found.unit}


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def verify(run: Ensemble) -> None:
    """Read every file of the finished chunks.

    Raises
    ------
    InvalidInput
        For the first file that is damaged, with its name.
    """
    assert run.out is not None
    store.verify(run.out, run._recipe, run._task.layout, list(run.chunks))
