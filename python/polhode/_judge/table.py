"""Tables of text: separators, headers and numbers, with the line of every row."""

from __future__ import annotations

import contextlib
import csv
import io
import pathlib
from collections.abc import Sequence
from typing import Any

import numpy as np

from .. import _files
from .._core import InvalidInput
from .states import Array

MOST = 2_000_000_000  # bytes
MOST_ROWS = 5_000_000
NAMES = {",": "commas", ";": "semicolons", "\t": "tabs", None: "blanks"}


def short(text: str) -> str:
    """Return a text that fits into a sentence."""
    return text if len(text) <= 40 else text[:37] + "..."


class Table:
    """A table of text. `names` is empty without a header."""

    def __init__(self, file: pathlib.Path) -> None:
        self.file = file
        self.rows, self.lines, said = _split(file)
        if not self.rows:
            raise InvalidInput(f"{file}: must have rows of numbers, got none")
        second = self.rows[min(1, len(self.rows) - 1)]
        self.separator = _separator(second)
        self.names: list[str] = []
        if any(not _is_number(cell) for cell in self.cells(self.rows[0])):
            own = _separator(self.rows[0])
            if own != self.separator and len(self.rows) > 1:
                raise InvalidInput(
                    f"{file}: line {self.lines[1]}: is separated by {NAMES[self.separator]}, "
                    f"and the header by {NAMES[own]}"
                )
            self.names = self.cells(self.rows[0])
            self.rows, self.lines = self.rows[1:], self.lines[1:]
        else:
            self.names = next((named for text in said if (named := self._names_in(text))), [])
        if len(self.rows) < 2:
            raise InvalidInput(f"{file}: must have at least 2 rows of numbers, got {len(self.rows)}")
        self.width = len(self.cells(self.rows[0]))

    def cells(self, row: str) -> list[str]:
        """Return the cells of a row."""
        if self.separator is None:
            return row.split()
        return [cell.strip() for cell in next(csv.reader([row], delimiter=self.separator))]

    def _names_in(self, comment: str) -> list[str]:
        """Return the names that a comment gives, if it has as many as there are columns."""
        count = len(self.cells(self.rows[0]))
        for cells in (self.cells(comment), comment.split()):
            if len(cells) == count and not any(_is_number(cell) for cell in cells):
                return cells
        return []

    def numbers(self, places: Sequence[int]) -> Array:
        """Return columns, shape (n, len(places)). Empty cells are NaN."""
        self._require_width()
        with contextlib.suppress(ValueError):
            quick: Array = np.loadtxt(
                self.rows, delimiter=self.separator, usecols=places, ndmin=2, comments=None, quotechar='"'
            )
            return quick
        out = np.empty((len(self.rows), len(places)))
        for k, row in enumerate(self.rows):
            cells = self.cells(row)
            out[k] = [self._number(cells[place], k) for place in places]
        return out

    def integers(self, place: int) -> Any:
        """Return a column as whole numbers of 64 bits, or None where it has others."""
        try:
            return np.loadtxt(self.rows, delimiter=self.separator, usecols=[place], dtype=np.int64, comments=None)
        except (ValueError, OverflowError):
            return None

    def _require_width(self) -> None:
        if self.separator is None:
            widths: Any = (len(row.split()) for row in self.rows)
        elif any('"' in row for row in self.rows):
            widths = (len(self.cells(row)) for row in self.rows)
        else:
            widths = (row.count(self.separator) + 1 for row in self.rows)
        wanted = len(self.names) or self.width
        for k, width in enumerate(widths):
            if width != wanted:
                what = "the header names" if self.names else "the first row has"
                other = _separator(self.rows[k])
                why = f"; it is separated by {NAMES[other]}" if width == 1 and other != self.separator else ""
                raise InvalidInput(f"{self.file}: line {self.lines[k]}: has {width} cells, {what} {wanted}{why}")

    def _number(self, cell: str, row: int) -> float:
        try:
            return float(cell) if cell else np.nan
        except ValueError:
            comma = "; write decimals with a point" if "," in cell else ""
            raise InvalidInput(
                f"{self.file}: line {self.lines[row]}: must be numbers, got {short(cell)!r}{comma}"
            ) from None


def _split(file: pathlib.Path) -> tuple[list[str], list[int], list[str]]:
    """Return the rows that are no comments, their lines, and the comments before the first row, the last one first."""
    data = _files.read(file, MOST)
    if (count := data.count(b"\n")) > MOST_ROWS:
        raise InvalidInput(
            f"{file}: must have at most {MOST_ROWS} lines, got {count}; keep one row of {-(-count // MOST_ROWS)}"
        )
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InvalidInput(f"{file}: must be text in UTF-8") from None
    if "\0" in text:
        raise InvalidInput(f"{file}: must be text, got null characters")
    rows: list[str] = []
    lines: list[int] = []
    said: list[str] = []
    for number, line in enumerate(io.StringIO(text, newline=None), 1):
        row = line.strip("\n\r ")
        if not row.strip():
            continue
        if row.lstrip()[0] == "#" or (row[0] == "%" and not row.startswith("%time")):
            if not rows:
                said.append(row.lstrip("#% "))
            continue
        rows.append(row)
        lines.append(number)
    return rows, lines, said[::-1]


def _separator(row: str) -> str | None:
    counts = {sign: row.count(sign) for sign in (",", ";", "\t")}
    if counts[";"] and counts[","]:  # a decimal comma
        return ";"
    best = max(counts, key=lambda sign: counts[sign])
    return best if counts[best] else None


def _is_number(cell: str) -> bool:
    try:
        float(cell or "nan")
    except ValueError:
        return False
    return True
