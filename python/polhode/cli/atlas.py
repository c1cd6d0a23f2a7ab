"""Output of `polhode atlas`: a table for each family, the matrix, and the files."""

from __future__ import annotations

import math
import pathlib
import sys
from typing import TYPE_CHECKING, Any

from rich.text import Text

from . import show

if TYPE_CHECKING:
    from ..atlas.results import FamilyResult

SYMBOLS = {"holds": "●", "degrades": "◐", "fails": "✕", "unknown": "?", "none": "·"}
STYLES = {"holds": "blue", "degrades": "yellow", "fails": "red", "unknown": "dim", "none": "dim"}


def family(result: FamilyResult) -> None:
    """Print one family: a row for each entrant, a column for each value of the swept quantity."""
    from ..atlas.family import Point, to_short
    from ..atlas.page import costs

    out, what = show.console(), result.family
    out.print(Text(f"\n{what.title}{' (kept from ' + result.made + ')' if result.kept else ''}"))
    out.print(Text(f"swept: {what.sweeps}\nholds: {what.holds}; degrades: {what.degrades}; truth: {what.truth}"))
    out.print(Text(f"took {costs(result.cpu)}"))
    for series, title in what.series:
        def of(points: list[Point], series: str = series) -> dict[float, Point]:
            return {p.x: p for p in points if p.series == series and not math.isnan(p.x) and p.status != "refused"}

        columns = sorted({x for points in result.rows.values() for x in of(points)}, reverse=what.x_inverted)
        if not columns or what.name == "norm" and len(columns) > 8:   # its entrants have different steps
            columns = columns[:: max(1, len(columns) // 8)]
        out.print(Text(f"{what.y_label}{', ' + title if title else ''}; by {what.x_label}"))
        table = show._table("", *(f"{x:.3g}" for x in columns), left=1)
        for name, points in result.rows.items():
            found = of(points)
            if found:
                table.add_row(name, *(_cell(found.get(x), what.y, to_short) for x in columns))
        out.print(table)
    for name in result.rows:
        verdict = result.verdict(name)
        if verdict.level in ("fails", "unknown") and verdict.why:
            out.print(Text(f"{name}: {verdict.level}: {verdict.why}"))


def _cell(point: Any, value: str, to_short: Any) -> str:
    if point is None or point.status == "left out":
        return ""
    return "failed" if point.status == "failed" else str(to_short(point.get(value)))


def matrix(content: dict[str, Any]) -> None:
    """Print the matrix of methods and families."""
    families = list(content["families"])
    table = show._table("", *families, left=1 + len(families))
    for name, row in content["matrix"].items():
        cells = [Text(f"{SYMBOLS[row[f]['level']]} {row[f]['text']}", style=STYLES[row[f]["level"]]) for f in families]
        table.add_row(name, *cells)
    out = show.console()
    out.print()
    out.print(table)
    out.print(Text("● holds   ◐ degrades   ✕ fails   ? too slow to measure here   · does not apply"))


def end(content: dict[str, Any], folder: pathlib.Path) -> None:
    """Print where the files are, and which claims of polhode did not hold."""
    out = show.console()
    count = len(content["families"])
    out.print(Text(f"\n{count} famil{'ies' if count > 1 else 'y'} in {content['seconds']:.0f} s "
                   f"({content['cpu_seconds']:.0f} s of CPU) on "
                   f"{content['machine']['processor']}; in {folder}:"))
    out.print(Text("  ".join(name for name in content["files"] if not name.endswith(".svg"))))
    for sentence in content["broken_claims"]:
        out.print(Text(f"FINDING: {sentence}"))
    sys.stdout.flush()
