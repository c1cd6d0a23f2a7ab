"""Motions as files: CSV for spreadsheets, NPZ for NumPy, JSON for other programs."""

from __future__ import annotations

import json
import math
import os
import pathlib
from typing import Any

import numpy as np

from .. import _files
from .._core import InvalidInput
from .._solve.motion import Motion

COLUMNS = {"t": ("t",), "omega": ("omega_x", "omega_y", "omega_z"),
           "attitude": ("attitude_x", "attitude_y", "attitude_z", "attitude_w")}
BOUNDS = ("lower", "upper")   # of a proof
COLUMNS |= {f"{name}_{side}": tuple(f"{column}_{side}" for column in COLUMNS[name])
            for name in ("omega", "attitude") for side in BOUNDS}


def check(path: pathlib.Path, endings: tuple[str, ...] = (".csv", ".npz", ".json"), option: str = "output") -> None:
    """Refuse a file that cannot be written, before the motion is computed."""
    if path.suffix not in endings:
        known = f"{', '.join(endings[:-1])} or {endings[-1]}" if len(endings) > 1 else endings[0]
        raise InvalidInput(f"{option}: must end in {known}, got {str(path)!r}")
    if path.is_dir() or not path.parent.is_dir() or not os.access(path.parent, os.W_OK):
        raise InvalidInput(f"{option}: {path} cannot be written: no such folder, or not writable")


def _arrays(motion: Motion) -> dict[str, Any]:
    arrays = {name: getattr(motion, name) for name in COLUMNS}
    return {name: array for name, array in arrays.items() if array is not None}


def _ticks(motion: Motion) -> list[dict[str, Any]]:
    """Of each controller the ticks, their commands and the states behind them, by the names of `motion.ticks`."""
    return [{"t": one.t, **one._arrays()} for one in motion.ticks]


def to_json(motion: Motion) -> dict[str, Any]:
    """Return all parts of a motion; numbers that are not finite are null."""
    return {
        "scene": motion.scene.name,
        "plan": {key: getattr(motion.plan, key) for key in ("model", "method", "state", "rtol")}, "asked": motion.asked,
        "success": motion.success, "status": motion.status, "message": motion.message,
        "error": motion.error if math.isfinite(motion.error) else None, "error_kind": motion.error_kind,
        "drift": motion.drift, "stats": motion.stats,
        **({} if motion.proved_span is None else {"proved_span": list(motion.proved_span)}),
        **{name: _finite(array) for name, array in _arrays(motion).items()},
        **({"ticks": [{name: _finite(array) for name, array in one.items()} for one in _ticks(motion)]}
           if motion.ticks else {}),
    }


def _finite(array: Any) -> Any:
    """Return an array as lists; bounds beyond the reach of a proof are null."""
    if np.isfinite(array).all():
        return array.tolist()
    return [[value if math.isfinite(value) else None for value in row] for row in array.tolist()]


def write(path: pathlib.Path, motion: Motion) -> None:
    """Write a motion in the format of the file's suffix. CSV numbers have all their digits."""
    arrays = _arrays(motion)
    if path.suffix == ".npz":
        with _files.whole(path) as draft:
            ticks = {f"ticks.{i}.{name}": array for i, one in enumerate(_ticks(motion)) for name, array in one.items()}
            np.savez_compressed(draft, **arrays, **ticks)
    elif path.suffix == ".json":
        _files.write(path, json.dumps(to_json(motion)) + "\n")
    else:
        header = ",".join(column for name in arrays for column in COLUMNS[name])
        table = np.column_stack(list(arrays.values()))
        rows = (",".join(map(repr, row)) for row in table.tolist())
        _files.write(path, "\n".join([header, *rows]) + "\n")
