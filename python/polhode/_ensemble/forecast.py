"""What a run would take: bodies, states, bytes and hours, measured on a few bodies of its own."""

from __future__ import annotations

import pathlib
import shutil
import time
import zlib
from typing import Any, NamedTuple

from . import chunk as chunks
from . import store
from .recipe import from_message
from .task import Task

TRIAL_STATES = 2**20   # of free bodies
TRIAL_BODIES = 64      # driven ones
BEGIN = 20_000         # bytes of the metadata, about


class Forecast(NamedTuple):
    """What a run would take on this machine."""

    bodies: int
    times: int
    states: int
    chunks: int
    chunk: int          # bodies
    bytes: int          # of the store
    free_bytes: int     # of its disk; -1 without a store
    seconds: float      # of one processor

    @property
    def fits(self) -> bool:
        """Return False if the disk has less room than the store takes."""
        return self.free_bytes < 0 or self.bytes <= self.free_bytes

    def as_dict(self, workers: int) -> dict[str, Any]:
        """Return all parts for JSON, with the hours of so many workers."""
        return {**self._asdict(), "hours": self.seconds / 3600 / workers, "workers": workers, "fits": self.fits}


def make(task: Task) -> Forecast:
    """Compute a few bodies and return what all of them take."""
    recipe, layout = from_message(task.recipe), task.layout
    times = recipe.times.size
    free = not any(point.nominal.torques or point.nominal.rotors for point in recipe.points)
    few = min(recipe.count, layout.chunk, max(TRIAL_STATES // times, 1) if free else TRIAL_BODIES)
    trial = task._replace(layout=layout._replace(number=few), out=None)
    chunks.compute(trial, 0)   # the first call makes the recipe and the nominal motion
    start = time.thread_time()   # all of it is this thread's; that of the process may come in ticks of 4 ms
    record = chunks.compute(trial, 0)
    seconds = (time.thread_time() - start) / few * recipe.count * layout.points
    size, room = 0, -1
    if task.out is not None:
        folder = pathlib.Path(task.out)
        while not folder.exists():
            folder = folder.parent
        room = shutil.disk_usage(folder).free
        packed = len(zlib.compress(record.tobytes(), 1))
        size = BEGIN + sum(store.bytes_of(recipe, layout, chunk) for chunk in range(layout.chunks))
        size += layout.chunks * packed
    bodies = recipe.count * layout.points
    return Forecast(bodies, times, bodies * times, layout.chunks, layout.chunk, size, room, seconds)
