"""The work on one chunk: draw its bodies, compute their states, sum them up, and store what the recipe stores."""

from __future__ import annotations

import errno
import os
import socket
import time
from typing import Any, NamedTuple

import numpy as np

from .._core import InvalidInput
from . import layout as layouts
from . import memory, states
from .distributions import Floats
from .draw import Bodies, draw
from .layout import HEAD
from .recipe import EnsembleRecipe, from_message
from .store import Writer
from .task import Task, fields, quantities


class Outcome(NamedTuple):
    """What became of a chunk."""

    chunk: int
    kind: str                # "done", "found", "full" (the disk), "failed", "died" (it may be tried again)
    why: str = ""
    record: Floats | None = None
    host: str = ""
    pid: int = 0
    seconds: float = 0.0     # of wall time
    cpu: float = 0.0         # seconds of this process


def _values(task: Task, recipe: EnsembleRecipe, found: states.States) -> Floats | None:
    columns = []
    for wanted in recipe.wanted:
        if wanted.of == "function":
            value = task.functions[wanted.function](recipe.times, found.omega, found.attitude)
            array = np.asarray(value, dtype=float)
            if array.shape != found.omega.shape[:2]:
                raise InvalidInput(f"functions: {wanted.function} must return an array of shape (bodies, times), "
                                   f"{found.omega.shape[:2]}, got {array.shape}")
            columns.append(array)
    return np.stack(columns, axis=-1) if columns else None


def _inertia(bodies: Bodies) -> Any:
    if not isinstance(bodies.inertia, list):
        return bodies.inertia
    return np.array([np.full((3, 3), np.nan) if tensor is None else tensor.matrix for tensor in bodies.inertia])


def _keep(writer: Any, recipe: EnsembleRecipe, place: tuple[int, int], found: states.States) -> None:
    writer.write_states(*place, found.omega[:, ::recipe.every], found.attitude[:, ::recipe.every])


def compute(task: Task, chunk: int, writer: Any = None) -> Floats:
    """Return the record of a chunk; `writer` takes the states and the outcomes, if they are stored."""
    recipe = from_message(task.recipe)
    index, first, end = task.layout.place(chunk)
    point = recipe.points[index]
    summary = layouts.new_summary(quantities(task.recipe, index), recipe.times.size)
    free = states.is_free(recipe, point)
    in_lanes = free and not any(wanted.of == "function" for wanted in recipe.wanted)
    stores = writer is not None and recipe.states != "none"
    number = task.layout.block_of(first) - first
    head = dict.fromkeys(HEAD, 0.0)
    outcomes = []
    for start, stop in task.layout.slabs(first, end):
        bodies = draw(recipe, point, start, stop - start)
        head["redrawn"] += int((bodies.attempts > 0).sum())
        head["impossible"] += int(bodies.impossible.sum())
        inertia = states.diagonal(bodies) if in_lanes else None
        if inertia is not None:
            omega, attitude = states.start_of(point, bodies)
            times = point.nominal.times - point.nominal.t0
            summary.add_free(number + start, inertia, omega, attitude, times, threads=1)
        if inertia is None or stores:
            found = states.compute(recipe, point, bodies)
            outcomes.append(found)
            if inertia is None:
                summary.add_states(number + start, found.omega, found.attitude, _inertia(bodies),
                                   _values(task, recipe, found))
            if stores:
                _keep(writer, recipe, (index, start), found)
    if outcomes and not free:
        _count(head, outcomes)
        if writer is not None:
            writer.write_outcomes(index, first, np.concatenate([found.status for found in outcomes]),
                                  np.concatenate([found.error for found in outcomes]))
    record = summary.record()
    head["bodies"], head["failed"] = record["bodies"], record["failed"]
    return fields(task).pack(head, record)


def _count(head: dict[str, float], outcomes: list[states.States]) -> None:
    for found in outcomes:
        known = np.isfinite(found.error)
        head["solved"] += int(found.success.sum())
        head["certified"] += int((found.success & known).sum())
        head["steps"] += int(found.steps.sum())
        head["worst_error"] = max(head["worst_error"], float(found.error[known].max(initial=0.0)))


def run(task: Task, chunk: int) -> Outcome:
    """Compute a chunk, unless its mark is there, and mark it. Nothing is raised but what ends the process."""
    begun, cpu = time.perf_counter(), time.process_time()
    memory.keep()
    try:
        kind, record = "done", None
        if task.out is None:
            record = compute(task, chunk)
        else:
            writer = Writer(task, chunk)
            if writer.is_marked():
                kind = "found"
            else:
                writer.require_room()
                writer.mark(compute(task, chunk, writer))
    except OSError as error:
        full = error.errno in (errno.ENOSPC, errno.EDQUOT)
        return Outcome(chunk, "full" if full else "died", str(error.strerror or error))
    except Exception as error:
        return Outcome(chunk, "failed", f"{type(error).__name__}: {error}".splitlines()[0])
    return Outcome(chunk, kind, "", record, socket.gethostname(), os.getpid(), time.perf_counter() - begun,
                   time.process_time() - cpu)
