"""Tables of charts."""

from __future__ import annotations

import pathlib
from typing import TYPE_CHECKING, Any

from rich.text import Text

from .show import _table, console

if TYPE_CHECKING:
    from ..charts.measure import Point, SceneResult


def _drifts(point: Point) -> tuple[str, str]:
    energy = [v for k, v in point.drift.items() if k in ("energy", "jacobi")]
    momentum = [v for k, v in point.drift.items() if k.endswith("momentum")]
    return tuple(f"{v[0]:.0e}" if v else "-" for v in (energy, momentum))  # type: ignore[return-value]


def _per_turn(result: SceneResult, point: Point, shown: set[str]) -> str:
    """The error per turn of a method at 1/60 s, in its first row."""
    value = result.per_turn.get(point.candidate)
    if value is None or point.candidate in shown:
        return ""
    shown.add(point.candidate)
    return f"{value:.0e}" if value < 0.5 else "lost"


def scene(result: SceneResult) -> None:
    """Print the table of one scene of a chart."""
    from .._plot.text import to_time
    from ..charts.findings import dominated, headline

    out = console()
    truth = result.truth
    known = f"input rounding {truth.floor:.0e}" if truth.floor is not None else f"uncertain by {truth.uncertainty:.0e}"
    out.print(Text(f"\n{result.scene.name} {result.title}: {headline(result)}"))
    out.print(Text(f"reference: {truth.kind} ({truth.source}), {known}"))
    table = _table("method", "setting", "error", "time", "fastest", "slowest", "of", "steps", "derivatives",
                   "drift of energy", "of momentum", "per turn, 1/60 s", left=2)
    shown: set[str] = set()
    for point in result.points:
        if not point.answered:
            continue
        counts = [f"{point.stats[key]:,}" if key in point.stats else "-" for key in ("steps", "derivatives")]
        times = [to_time(seconds) for seconds in (point.seconds, point.fastest, point.slowest)]
        table.add_row(point.candidate, point.setting, f"{point.error:.1e}", *times, str(point.repeats), *counts,
                      *_drifts(point), _per_turn(result, point, shown))
    out.print(table)
    missing: dict[tuple[str, str], list[str]] = {}
    for point in result.points:
        if not point.answered:
            why = f"{'left out' if point.left_out else 'failed'}: {point.why}"
            missing.setdefault((point.candidate, why), []).append(point.setting)
    for (name, why), settings in missing.items():
        out.print(Text(f"{name} {', '.join(settings)}: {why}"))
    starts = [f"{name} {to_time(seconds)}" for name, seconds in result.startups.items() if seconds > 1e-3]
    if starts:
        out.print(Text(f"start-up and warm-up before the first answer: {', '.join(starts)}"))
    if beaten := sorted(dominated(result)):
        out.print(Text(f"beaten everywhere, in grey: {', '.join(beaten)}"))
    for note in result.notes:
        out.print(Text(note))


def choice(results: list[SceneResult], content: dict[str, Any], folder: pathlib.Path) -> None:
    """Print the fastest at each error, what failed in numbers, and where the rest stands."""
    from .._plot.text import to_error
    from ..charts.choice import LEVELS, PICTURE, finding, rows

    out, machine = console(), content["machine"]
    table = _table("fastest", *(f"error <= {to_error(level)}" for level in LEVELS), left=1 + len(LEVELS))
    for row in rows(results):
        table.add_row(*row)
    out.print(table)
    out.print(Text(f"{finding(results)}"))
    points = [point for result in results for point in result.points]
    failed = sum(not point.answered and not point.left_out for point in points)
    out.print(Text(f"{sum(point.answered for point in points):,} runs answered, {failed:,} failed, "
                   f"{sum(point.left_out for point in points):,} were left out for want of time; "
                   f"{folder / 'results.json'} has each with its reason"))
    out.print(Text(f"{len(results)} scenes in {content['seconds']:.0f} s on {machine['processor']}"))
    out.print(Text(f"look at {folder / PICTURE}.png, then at {folder / 'overview'}.png"))


def end(content: dict[str, Any], folder: pathlib.Path) -> None:
    """Print where the files are."""
    machine, out = content["machine"], console()
    count = len(content["scenes"])
    scenes = f"{count} scene{'s' if count > 1 else ''}"
    out.print(Text(f"\n{scenes} in {content['seconds']:.0f} s on {machine['processor']}"))
    for name, how in content["missing"].items():
        out.print(Text(f"{name} is not installed: {how}"))
    for name in content["files"]:
        if not name.endswith(".svg"):
            out.print(Text(f"{folder / name}"))
    out.print(Text("each picture also exists as .svg"))
