"""How an ensemble is cut into chunks, and where each number stands in a chunk's record.

The cut depends on the recipe alone, never on the machine, so that stores of the same recipe are the same.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from .. import _core
from .._core import InvalidInput
from .distributions import Floats
from .draw import draw
from .recipe import EnsembleRecipe
from .states import compute, is_free

BLOCK = 4096             # bodies of the core's sums, which are in the order of the bodies within a block
FREE_STATES = 2**26      # of a chunk of free bodies: about a second of one core
CHUNK_STEPS = 2**19      # of a chunk of driven bodies: about a second of one core
LANE_STEPS = 2**21       # the same for methods that step eight bodies at once
LANES = ("rk45", "taylor")
TRIALS = 8               # bodies whose steps are counted
MOST_CHUNK = 2**20       # bodies
SLAB_STATES = 2**18      # states in memory at once: 15 MB


class Layout(NamedTuple):
    """The cut of an ensemble: all sizes are in bodies and powers of two, but `number`."""

    number: int      # at each point of the sweep
    points: int
    chunk: int       # of a task, and of a record
    slab: int        # of the arrays in memory, and of the Zarr chunks of states

    @property
    def per_point(self) -> int:
        """The number of chunks of a point."""
        return -(-self.number // self.chunk)

    @property
    def chunks(self) -> int:
        """The number of all chunks."""
        return self.points * self.per_point

    def place(self, chunk: int) -> tuple[int, int, int]:
        """Return the point of a chunk, its first body and the end of its bodies."""
        point, index = divmod(chunk, self.per_point)
        first = index * self.chunk
        return point, first, min(first + self.chunk, self.number)

    def block_of(self, first: int) -> int:
        """Return the number of a body for the core's sums. A chunk below a block counts as a block, which is short."""
        return first if self.chunk >= BLOCK else first // self.chunk * BLOCK

    def bodies(self, chunk: int) -> int:
        """Return how many bodies a chunk has."""
        _, first, end = self.place(chunk)
        return end - first

    def slabs(self, first: int, end: int) -> Iterator[tuple[int, int]]:
        """Yield the parts of a range of bodies that are in memory at once."""
        for start in range(first, end, self.slab):
            yield start, min(start + self.slab, end)


def _power(value: float, least: int, most: int) -> int:
    return int(min(max(2 ** math.floor(math.log2(max(value, 1))), least), most))


def make(recipe: EnsembleRecipe) -> Layout:
    """Return the layout of a recipe."""
    check_memory(recipe)
    states = recipe.times.size
    if recipe.chunk is not None:
        chunk = recipe.chunk
    elif all(is_free(recipe, point) for point in recipe.points):
        chunk = _power(FREE_STATES / states, BLOCK, MOST_CHUNK)
    else:
        point = next(point for point in recipe.points if not is_free(recipe, point))
        steps = int(compute(recipe, point, draw(recipe, point, 0, min(TRIALS, recipe.count))).steps.max())
        lanes = {"rtol", "atol"} & recipe.options.keys() and recipe.options.get("method", "rk45") in LANES
        chunk = _power((LANE_STEPS if lanes else CHUNK_STEPS) / max(steps, 1), 8, MOST_CHUNK)
    return Layout(recipe.count, len(recipe.points), chunk, min(_power(SLAB_STATES / states, 1, 2**16), chunk))


MOST_BYTES = 2**31       # of the summaries of all points, and of a record


def check_memory(recipe: EnsembleRecipe) -> None:
    """Refuse a recipe whose histograms need more memory than a worker should have."""
    bins = 0
    for wanted in recipe.wanted:
        of = "value" if wanted.of == "function" else wanted.of
        unit = {"angle": {"nominal": np.array([0.0, 0.0, 0.0, 1.0])},
                "axis_angle": {"axis": np.array([0.0, 0.0, 1.0]), "target": np.array([0.0, 0.0, 1.0])}}
        single = new_summary([{"of": of, **wanted.bounds, **unit.get(of, {})}], 1)
        bins += 20 if of == "attitude" else single.edges(0).size
    needed = 8 * bins * recipe.times.size * len(recipe.points)
    if needed > MOST_BYTES:
        raise InvalidInput(f"times, sweep: must be fewer: the histograms of {recipe.times.size} times at "
                           f"{len(recipe.points)} points need {needed} bytes, of {MOST_BYTES}; least and largest "
                           f"narrow a histogram")


def _is_power(value: Any) -> bool:
    return type(value) is int and 0 < value <= 2**30 and value & (value - 1) == 0


def check(recipe: EnsembleRecipe, layout: Layout, where: str) -> None:
    """Refuse a layout from a file that is none of the recipe."""
    check_memory(recipe)
    fits = layout.number == recipe.count and layout.points == len(recipe.points)
    if not (fits and _is_power(layout.chunk) and _is_power(layout.slab) and layout.slab <= layout.chunk):
        raise InvalidInput(f"{where}: must have the layout of its recipe, got {tuple(layout)}")


HEAD = ("bodies", "failed", "redrawn", "impossible", "solved", "certified", "steps", "worst_error")


class Fields:
    """Where the numbers stand in a record of float64: the head, then each quantity's arrays one after the other.

    Counts stay whole: they are below 2^53.
    """

    def __init__(self, empty: dict[str, Any]) -> None:
        self.places: dict[str, tuple[int, tuple[int, ...], str]] = {name: (i, (), "<i8") for i, name in enumerate(HEAD)}
        self.places["worst_error"] = (HEAD.index("worst_error"), (), "<f8")
        self.size = len(HEAD)
        for index, quantity in enumerate(empty["quantities"]):
            for name, array in quantity.items():
                if hasattr(array, "dtype"):
                    self.places[f"{index}.{name}"] = (self.size, array.shape, array.dtype.str)
                    self.size += array.size

    def pack(self, head: dict[str, float], record: dict[str, Any]) -> Floats:
        """Return the record as one row."""
        row = np.empty(self.size)
        for name in HEAD:
            row[self.places[name][0]] = head[name]
        for index, quantity in enumerate(record["quantities"]):
            for name, array in quantity.items():
                if f"{index}.{name}" in self.places:
                    start = self.places[f"{index}.{name}"][0]
                    row[start:start + array.size] = array.ravel()
        return row

    def head(self, row: Floats) -> dict[str, float]:
        """Return the head of a row."""
        return {name: float(row[self.places[name][0]]) for name in HEAD}

    def unpack(self, row: Floats, first: int) -> dict[str, Any]:
        """Return the record of a row, as `Summary.from_record` takes it."""
        quantities: dict[int, dict[str, Any]] = {}
        for name, (start, shape, dtype) in self.places.items():
            index, _, part = name.partition(".")
            if part:
                array = row[start:start + math.prod(shape)].reshape(shape).astype(dtype)
                quantities.setdefault(int(index), {})[part] = array
        head = self.head(row)
        bodies = int(head["bodies"])
        return {"first": first, "end": first + bodies, "bodies": bodies, "failed": int(head["failed"]),
                "quantities": [quantities[index] for index in sorted(quantities)]}


def new_summary(quantities: list[dict[str, Any]], times: int) -> Any:
    """Return an empty summary of the core."""
    return _core._Summary(quantities, times)


def old_summary(quantities: list[dict[str, Any]], times: int, record: dict[str, Any]) -> Any:
    """Return the summary of a record."""
    return _core._Summary.from_record(quantities, times, record)
