"""Measurements from a table of text: CSV with a header, or columns that the caller names."""

from __future__ import annotations

import csv
import math
import pathlib
from collections.abc import Sequence

import numpy as np

from .. import _files
from .._core import InvalidInput
from ..measured import Attitudes, Axis, Direction, Measurement, Rates

SENSORS = {"omega": "xyz", "attitude": "xyzw", "axis": "xyz", "direction": "xyz"}


def _rows(file: pathlib.Path) -> list[list[str]]:
    try:
        text = _files.read(file, _files.TEXT).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InvalidInput(f"{file}: must be text in UTF-8: {error}") from None
    rows = [row for row in csv.reader(text.splitlines()) if row and not row[0].lstrip().startswith("#")]
    if len(rows) < 2:
        raise InvalidInput(f"{file}: must have a header and rows, got {len(rows)} lines")
    return rows


def _number(text: str, file: pathlib.Path, line: int) -> float:
    try:
        return float(text) if text.strip() else math.nan
    except ValueError:
        raise InvalidInput(f"{file}: row {line}: must be numbers, got {text!r}") from None


def read(file: pathlib.Path, columns: str | None, sigma: dict[str, float], *, bias: bool = False,
         degrees: bool = False, axis: Sequence[float] = (0, 0, 1), direction: Sequence[float] | None = None,
         ) -> list[Measurement]:
    """Return the measurements of a CSV file. Empty cells are NaN; rows of one sensor need not hold another."""
    rows = _rows(file)
    names = [name.strip() for name in (columns.split(",") if columns else rows[0])]
    width = max(map(len, rows[1:]))
    if len(names) != width:
        raise InvalidInput(f"--columns: must name the {width} columns of {file}, got {len(names)} names")
    if "t" not in names:
        raise InvalidInput(f"--columns: must name the time 't', got {', '.join(names)}")
    table = np.array([[_number(text, file, k + 2) for text in row + [""] * (width - len(row))]
                      for k, row in enumerate(rows[1:])])
    t = table[:, names.index("t")]
    data: list[Measurement] = []
    for sensor, parts in SENSORS.items():
        wanted = [f"{sensor}_{part}" for part in parts]
        present = [name for name in wanted if name in names]
        if not present:
            continue
        if present != wanted:
            raise InvalidInput(f"--columns: {sensor} needs {', '.join(wanted)}, got {', '.join(present)}")
        if sensor not in sigma:
            raise InvalidInput(f"--sigma: must give {sensor}, as {sensor}=0.01")
        y, noise = table[:, [names.index(name) for name in wanted]], sigma[sensor]
        if degrees and sensor in ("omega", "attitude"):
            noise = math.radians(noise)
        here = np.isfinite(y).any(axis=1)
        if sensor == "omega":
            data.append(Rates(t[here], np.radians(y[here]) if degrees else y[here], noise, bias))
        elif sensor == "attitude":
            data.append(Attitudes(t[here], y[here], noise))
        elif sensor == "axis":
            data.append(Axis(t[here], y[here], noise, axis))
        elif direction is None:
            raise InvalidInput("--direction: must give the space vector that the columns direction_* see")
        else:
            data.append(Direction(t[here], y[here], noise, direction))
    if not data:
        known = "; ".join(", ".join(f"{s}_{p}" for p in parts) for s, parts in SENSORS.items())
        raise InvalidInput(f"--columns: must name a sensor ({known}), got {', '.join(names)}")
    return data
