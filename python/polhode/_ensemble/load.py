"""Reading what was saved: stores and files of ensembles."""

from __future__ import annotations

import pathlib
from typing import Any

import numpy as np

from .._core import InvalidInput
from . import begin, store
from . import layout as layouts
from . import recipe as recipes
from .ensemble import Ensemble
from .layout import Layout
from .task import Task, fields


def open_run(out: str) -> Ensemble:
    """Return the ensemble of a store, also while its run goes on, and after one that ended early.

    Raises
    ------
    InvalidInput
        For a folder that is no store, and for one of another version or arithmetic.
    """
    recipe, layout, stamp = store.recipe_of(out)
    functions = {name: _absent for name in stamp.get("functions", {})}
    task = Task(recipes.to_message(recipe), layout, {}, str(pathlib.Path(out).resolve()))
    store.check_stamp(out, stamp, {**store.stamp(task), "functions": stamp.get("functions", {})})
    begin.check(out, task)
    return Ensemble(task._replace(functions=functions))


def _absent(*arguments: Any) -> Any:
    raise InvalidInput("functions: are not in a store; use the states instead")


def from_arrays(path: pathlib.Path, about: dict[str, Any], arrays: Any) -> Ensemble:
    """Return the ensemble of a .npz file."""
    task, chunks, records = task_of(path, about), arrays["chunks"], arrays["records"]
    numbers = np.unique(chunks)
    if numbers.size < chunks.size or numbers.size and not 0 <= numbers[0] <= numbers[-1] < task.layout.chunks:
        raise InvalidInput(f"{path}: is damaged: its chunks are not those of its recipe")
    return Ensemble(task, {int(chunk): row for chunk, row in zip(chunks, records, strict=True)})


def sizes(path: pathlib.Path, about: dict[str, Any]) -> tuple[int, int]:
    """Return the number of chunks that a .npz file of an ensemble describes, and the numbers in a record."""
    task = task_of(path, about)
    return task.layout.chunks, fields(task).size


def task_of(path: pathlib.Path, about: dict[str, Any]) -> Task:
    """Return the task that a .npz file of an ensemble describes."""
    try:
        recipe = recipes.from_content(about["recipe"], about["folder"], str(path))
        stamp, layout = about["stamp"], Layout(**about["layout"])
        layouts.check(recipe, layout, str(path))
        task = Task(recipes.to_message(recipe), layout, {}, None)
        store.check_stamp(str(path), stamp, {**store.stamp(task), "functions": stamp.get("functions", {})})
        return task
    except (LookupError, TypeError, ValueError, AttributeError) as error:
        if isinstance(error, InvalidInput):
            raise
        raise InvalidInput(f"{path}: is damaged: {type(error).__name__}") from None
