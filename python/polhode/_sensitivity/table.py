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
KNOWN = {"t", *(f"{sensor}_{part}" for sensor, parts in SENSORS.items() for part in parts)}


def _rows(file: pathlib.Path) -> list[list[str]]:
    try:
        text = _files.read(file, _files.TEXT).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InvalidInput(f"{file}: must be text in UTF-8: {error}") from None
    try:
        rows = [row for row in csv.reader(text.splitlines()) if row and not row[0].lstrip().startswith("#")]
    except csv.Error as error:
        raise InvalidInput(f"{file}: must be a table of text: {error}") from None
    if len(rows) < 2:
        raise InvalidInput(f"{file}: must have a header and rows, got {len(rows)} lines")
    return rows


def _short(text: str) -> str:
    return text if len(text) <= 60 else text[:57] + "..."


def _number(text: str, file: pathlib.Path, line: int) -> float:
    try:
        return float(text) if text.strip() else math.nan
    except ValueError:
        raise InvalidInput(f"{file}: row {line}: must be numbers, got {_short(text)!r}") from None


def _names(header: Sequence[str], columns: str | None, file: pathlib.Path) -> list[str]:
    """Return the names of the columns: the header, or all names in order, or name=column for some of the header."""
    own = [name.strip() for name in header]
    if columns is None:
        return own
    given = [part.strip() for part in columns.split(",")]
    if not any("=" in part for part in given):
        return given
    names = [""] * len(own)
    for part in given:
        name, _, column = (piece.strip() for piece in part.partition("="))
        if column not in own:
            raise InvalidInput(f"--columns: must be name=column with columns of {file}, got {_short(part)!r}")
        names[own.index(column)] = name
    return names


def read(file: pathlib.Path, columns: str | None, sigma: dict[str, float], *, bias: bool = False,
         degrees: bool = False, axis: Sequence[float] = (0, 0, 1), direction: Sequence[float] | None = None,
         first: float | None = None, last: float | None = None) -> list[Measurement]:
    """Return the measurements of a CSV file. Empty cells are NaN; rows of one sensor need not hold another.

    With `first` times count from there, and rows before are left out; so are those after `last`.
    """
    rows = _rows(file)
    names = _names(rows[0], columns, file)
    width = max(map(len, rows[1:]))
    if len(names) != width:
        raise InvalidInput(f"--columns: must name the {width} columns of {file}, got {len(names)} names")
    given = _short(", ".join(names))
    if "t" not in names:
        raise InvalidInput(f"--columns: must name the time 't', got {given}")
    # The known columns alone: short rows beside one of a million cells would make a large table.
    places = [k for k, name in enumerate(names) if name in KNOWN and names.index(name) == k]
    table = np.full((len(rows) - 1, len(places)), math.nan)
    for k, row in enumerate(rows[1:]):
        numbers = [_number(text, file, k + 2) for text in row]
        table[k] = [numbers[place] if place < len(numbers) else math.nan for place in places]
    names = [names[place] for place in places]
    t = table[:, names.index("t")]
    inside = (t >= (-math.inf if first is None else first)) & (t <= (math.inf if last is None else last))
    if first is not None or last is not None:
        table = table[inside]
        t = t[inside] - (0.0 if first is None else first)
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
        raise InvalidInput(f"--columns: must name a sensor ({known}), got {given}")
    return data
