"""Ensembles for xarray and pandas."""

from __future__ import annotations

import pathlib
from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import InvalidInput
from .begin import specs
from .summary import QUANTILES, arrays_of

if TYPE_CHECKING:
    from .ensemble import Ensemble


def _need(name: str) -> Any:
    import importlib

    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise InvalidInput(f"{name}: is not installed: pip install 'polhode[ensemble]' ({error.name})") from None


def to_xarray(run: Ensemble) -> Any:
    """Return the store as a Dataset, or the summaries where there is none."""
    xarray = _need("xarray")
    if run.out is not None:
        known = {spec.name for spec in specs(run._task)}
        there = {path.parent.name for path in pathlib.Path(run.out).glob("*/zarr.json")}
        return xarray.open_zarr(run.out, consolidated=False, chunks=None, drop_variables=sorted(there - known))
    lead = ("point",) if len(run.points) > 1 else ()
    variables = {}
    for summary in run.summary.values():
        for name, (dims, values, unit, text) in arrays_of(summary).items():
            variables[name] = ((*lead, *dims), values, {"units": unit, "long_name": text})
    return xarray.Dataset(variables, {"time": ("time", run.times, {"units": "s"}), "quantile": list(QUANTILES)},
                          {"Conventions": "CF-1.11", "title": run.name})


def to_pandas(run: Ensemble) -> Any:
    """Return the summaries as a table, a row for each time and point."""
    pandas = _need("pandas")
    columns: dict[str, Any] = {}
    points, times = len(run.points), run.times
    columns["time"] = np.tile(times, points)
    if points > 1:
        columns["point"] = np.repeat(np.arange(points), times.size)
    for summary in run.summary.values():
        for name, (dims, values, _, _) in arrays_of(summary).items():
            if dims == ("time",):
                columns[name] = values.reshape(-1)
            elif dims == ("time", "component"):
                columns |= {f"{name}_{axis}": values[..., k].reshape(-1) for k, axis in enumerate("xyzw")}
            else:
                columns |= {f"{name}_{q:g}": values[..., k].reshape(-1) for k, q in enumerate(QUANTILES)}
    return pandas.DataFrame(columns)
