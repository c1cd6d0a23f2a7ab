"""What a worker needs to know for any chunk of an ensemble: recipe, layout, and what is summed up."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from . import layout as layouts
from . import states
from .distributions import Floats
from .layout import Fields, Layout
from .recipe import EnsembleRecipe, Point, from_message

Functions = dict[str, Callable[..., Any]]


class Task(NamedTuple):
    """What a worker needs for any chunk of an ensemble."""

    recipe: tuple[str, str]
    layout: Layout
    functions: Functions
    out: str | None          # the store's folder; None returns the record


def _unit(values: Sequence[float]) -> Floats:
    """Return a vector or a quaternion of length 1, with the same bits on any machine."""
    size = math.sqrt(sum(value * value for value in values))
    return np.array([value / size for value in values])


def core_quantities(recipe: EnsembleRecipe, point: Point, undisturbed: Any) -> list[dict[str, Any]]:
    """Return what the core's summary takes for the summaries of a recipe."""
    found = []
    for wanted in recipe.wanted:
        quantity: dict[str, Any] = {"of": "value" if wanted.of == "function" else wanted.of, **wanted.bounds}
        if wanted.of == "angle":
            quantity["nominal"] = undisturbed if wanted.nominal == "undisturbed" else _unit(wanted.nominal)
        if wanted.of == "axis_angle":
            quantity |= {"axis": _unit(wanted.axis), "target": _unit(wanted.target)}
        if wanted.of == "attitude" and undisturbed is not None:
            quantity["nominal"] = undisturbed
        found.append(quantity)
    return found


@lru_cache(maxsize=4)
def quantities(message: tuple[str, str], index: int) -> list[dict[str, Any]]:
    """Return the core's quantities of a point, made once in each process."""
    recipe = from_message(message)
    point = recipe.points[index]
    needed = not point.without_middle and any(wanted.of in ("angle", "attitude") and wanted.nominal in
                                              ("undisturbed", None) for wanted in recipe.wanted)
    undisturbed = states.nominal_attitude(recipe, point) if needed else None
    return core_quantities(recipe, point, undisturbed)


@lru_cache(maxsize=4)
def _fields(message: tuple[str, str]) -> Fields:
    times = from_message(message).times.size
    return Fields(layouts.new_summary(quantities(message, 0), times).record())


def fields(task: Task) -> Fields:
    """Return where the numbers of a record stand."""
    return _fields(task.recipe)
