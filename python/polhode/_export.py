"""Motions for pandas and xarray, and as files with all that is needed to repeat them."""

from __future__ import annotations

import importlib
import json
import os
import pathlib
import shutil
from typing import Any

import numpy as np

from . import _files, _folders
from ._core import InvalidInput, __version__

COMPONENTS = {"omega": ("x", "y", "z"), "attitude": ("x", "y", "z", "w")}
DIMENSIONS = {"omega": "axis", "attitude": "component"}
UNITS = {"t": "s", "time": "s", "omega": "rad s-1", "attitude": "1", "t_reached": "s", "error": "1", "steps": "1"}
TEXTS = {"omega": "angular velocity in body axes", "attitude": "unit quaternion (x, y, z, w), body to space",
         "time": "time since the epoch of the scene", "error": "error of all samples, NaN if not estimated"}
STATES = ("states.", "states_lower.", "states_upper.")   # before the names of a formula's states
SUFFIXES = (".npz", ".zarr")


def need(package: str) -> Any:
    """Import an optional package; raise InvalidInput with the command that installs it."""
    try:
        return importlib.import_module(package)
    except ImportError as error:
        raise InvalidInput(f"{package}: needs {error.name}: pip install 'polhode[ensemble]'") from None


def describe(name: str) -> dict[str, str]:
    """Return the attributes of an array by the conventions of CF."""
    base = name.removesuffix("_lower").removesuffix("_upper")
    found = {"units": UNITS.get(base, "1")}
    if text := TEXTS.get(base):
        found["long_name"] = text + (f", {name.removeprefix(base)[1:]} bound" if name != base else "")
    return found


def columns_of(name: str, array: Any) -> dict[str, Any]:
    """Return the columns of an array, such as omega_x, omega_y and omega_z."""
    if name.startswith(STATES):
        flat = array.reshape(-1, *array.shape[array.ndim - 1:]) if array.ndim > 1 else array
        own, tail = _split_state(name)
        return ({own + tail: flat} if flat.ndim == 1
                else {f"{own}_{k}{tail}": flat[:, k] for k in range(flat.shape[1])})
    base = name.removesuffix("_lower").removesuffix("_upper")
    tail = name.removeprefix(base)
    return {f"{base}_{axis}{tail}": array[..., k].reshape(-1) for k, axis in enumerate(COMPONENTS[base])}


def _split_state(name: str) -> tuple[str, str]:
    """Return a state's own name, and "_lower" or "_upper" of a bound."""
    part, _, own = name.partition(".")
    return own, part.removeprefix("states")


def to_pandas(index: dict[str, Any], arrays: dict[str, Any]) -> Any:
    """Return a table with the columns of the index first."""
    pandas = need("pandas")
    columns = dict(index)
    for name, array in arrays.items():
        columns |= columns_of(name, array)
    return pandas.DataFrame(columns)


def to_xarray(dims: tuple[str, ...], coordinates: dict[str, Any], arrays: dict[str, Any], about: dict[str, Any],
              more: dict[str, Any] | None = None) -> Any:
    """Return a Dataset: states along `dims`, and `more` arrays along the first of them."""
    xarray = need("xarray")
    variables = {}
    for name, array in arrays.items():
        if name.startswith(STATES):
            own, tail = _split_state(name)
            about_it = {"long_name": f"state {own} of a torque" + (f", {tail[1:]} bound" if tail else "")}
            variables[own + tail] = ((*dims, f"{own}_component")[:array.ndim], array, about_it)
            continue
        base = name.removesuffix("_lower").removesuffix("_upper")
        variables[name] = ((*dims, DIMENSIONS[base]), array, describe(name))
    for name, array in (more or {}).items():
        variables[name] = (dims[:1], array, describe(name))
    coords: dict[str, Any] = {name: (name if np.ndim(values) == 1 else dims, values, describe(name))
              for name, values in coordinates.items()}
    coords |= {DIMENSIONS[name]: list(axes) for name, axes in COMPONENTS.items() if name in arrays}
    attributes = {"Conventions": "CF-1.11", "source": f"polhode {__version__}", "polhode": json.dumps(about)}
    return xarray.Dataset(variables, coords, attributes)


def _ticks_columns(arrays: dict[str, Any]) -> dict[str, Any]:
    columns: dict[str, Any] = {}
    for name, array in arrays.items():
        own = name.rpartition(".")[2]
        if own in COMPONENTS:
            columns |= columns_of(own, array)
        else:
            columns |= {own: array} if array.ndim == 1 else {f"{own}_{k}": array[:, k] for k in range(array.shape[1])}
    return columns


def ticks_to_pandas(t: Any, arrays: dict[str, Any]) -> Any:
    """Return a table of one controller's ticks."""
    return need("pandas").DataFrame({"t": t, **_ticks_columns(arrays)})


def add_ticks(dataset: Any, ticks: list[tuple[Any, dict[str, Any]]]) -> Any:
    """Return a Dataset with variables of each controller's ticks, along a dimension of their own."""
    for i, (t, arrays) in enumerate(ticks):
        dim = f"ticks_{i}"
        added: dict[str, Any] = {f"{dim}_t": ((dim,), t, {"units": "s",
                                                          "long_name": f"times of the ticks of controller {i}"})}
        for name, array in arrays.items():
            own = f"{dim}_{name.rpartition('.')[2]}"
            added[own] = ((dim, f"{own}_component")[:array.ndim], array)
        dataset = dataset.assign(added)
    return dataset


def check_path(path: str | os.PathLike[str], more: tuple[str, ...] = ()) -> pathlib.Path:
    """Return the path of a file to save; refuse other suffixes than .npz, .zarr and `more`."""
    found = _files.to_path(path, "path")
    if found.suffix not in SUFFIXES + more:
        *some, last = SUFFIXES + more
        raise InvalidInput(f"path: must end in {', '.join(some)} or {last}, got {str(path)!r}")
    return found


def save(path: pathlib.Path, about: dict[str, Any], arrays: dict[str, Any]) -> None:
    """Write arrays and what they are to a .npz file, or to a folder of Zarr."""
    text = _folders.require_about(json.dumps({**about, "polhode": __version__}))
    if path.suffix == ".npz":
        if path.is_dir():
            raise InvalidInput(f"path: {path} is a folder")
        with _files.whole(path) as draft:
            np.savez_compressed(draft, about=np.array(text), **arrays)
        return
    zarr = need("zarr")
    target = pathlib.Path(os.path.realpath(path))   # links are followed, as for files
    _folders.require_replaceable(target)   # before the work
    draft = target.with_name(_files.draft_of(target.name))
    try:
        group = zarr.open_group(str(draft), mode="w")
        for name, array in arrays.items():
            dims = [f"{name}_{axis}" for axis in range(array.ndim)]
            dims[-1:] = [DIMENSIONS[base] for base in COMPONENTS if name.startswith(base)] or dims[-1:]
            group.create_array(name, data=array, dimension_names=dims, attributes=describe(name))
        group.attrs.update({"Conventions": "CF-1.11", "polhode": text})
        _folders.put(draft, target)
    finally:
        shutil.rmtree(draft, ignore_errors=True)
