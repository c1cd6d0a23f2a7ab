"""Reading what was saved: stores and files of ensembles."""

from __future__ import annotations

import pathlib
import zipfile
from typing import Any

from .._core import InvalidInput
from . import layout as layouts
from . import recipe as recipes
from . import store
from .ensemble import Ensemble
from .layout import Layout
from .task import Task


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
    return Ensemble(task._replace(functions=functions))


def _absent(*arguments: Any) -> Any:
    raise InvalidInput("functions: are not in a store; use the states instead")


def from_arrays(path: pathlib.Path, about: dict[str, Any], arrays: Any) -> Ensemble:
    """Return the ensemble of a .npz file."""
    try:
        recipe = recipes.from_content(about["recipe"], about["folder"], str(path))
        stamp, layout = about["stamp"], Layout(**about["layout"])
        layouts.check(recipe, layout, str(path))
        task = Task(recipes.to_message(recipe), layout, {}, None)
        store.check_stamp(str(path), stamp, {**store.stamp(task), "functions": stamp.get("functions", {})})
        chunks, records = arrays["chunks"], arrays["records"]
    except (LookupError, TypeError, ValueError, EOFError, OSError, zipfile.BadZipFile) as error:
        if isinstance(error, InvalidInput):
            raise
        raise InvalidInput(f"{path}: is damaged: {type(error).__name__}") from None
    if chunks.ndim != 1 or records.shape[:1] != chunks.shape:
        raise InvalidInput(f"{path}: is damaged: {records.shape} records of {chunks.shape} chunks")
    return Ensemble(task, {int(chunk): row for chunk, row in zip(chunks, records, strict=True)})
