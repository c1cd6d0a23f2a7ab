"""Repaired samples as a new file."""

from __future__ import annotations

import io
import pathlib

import numpy as np

from .. import _files
from .judgement import Repaired

COLUMNS = {
    "omega": ("omega_x", "omega_y", "omega_z"),
    "attitude": ("attitude_x", "attitude_y", "attitude_z", "attitude_w"),
}


def write_repaired(path: pathlib.Path, samples: Repaired) -> None:
    """Write samples in polhode's conventions to a file that does not exist yet, .csv or .npz.

    Raises
    ------
    InvalidInput
        Something has this name, a link too; nothing is overwritten or followed.
    """
    parts = {name: getattr(samples, name) for name in COLUMNS}
    arrays = {"t": samples.t, **{name: array for name, array in parts.items() if array is not None}}
    if path.suffix == ".npz":
        held = io.BytesIO()
        np.savez_compressed(held, **arrays)
        _files.create(path, held.getvalue())
        return
    header = ",".join(["t", *(column for name in arrays if name in COLUMNS for column in COLUMNS[name])])
    rows = (",".join(map(repr, row)) for row in np.column_stack(list(arrays.values())).tolist())
    _files.create(path, "\n".join([header, *rows]) + "\n")
