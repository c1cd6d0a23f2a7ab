"""Tables of the command line. They fit a terminal; other output is not cut."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rich import box
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table
from rich.text import Text

if TYPE_CHECKING:
    from .._solve.motion import Motion

UNCUT = 100_000


class _Console(Console):
    """A console that leaves a closed pipe to the command, in every version of rich."""

    def on_broken_pipe(self) -> None:
        raise BrokenPipeError


def console(stderr: bool = False) -> Console:
    """Return a console on the present stdout or stderr."""
    stream = sys.stderr if stderr else sys.stdout
    return _Console(file=stream, highlight=False, markup=False, width=None if stream.isatty() else UNCUT)


class Bar:
    """Progress on stderr: a bar on a terminal, otherwise one line for each new task."""

    def __init__(self, title: str, total: float = 1.0, quiet: bool = False) -> None:
        self._quiet = quiet   # no lines where there is no bar
        self._console = console(stderr=True)
        self._bar = Progress(TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), console=self._console,
                             transient=True, disable=not self._console.is_terminal)
        self._task = self._bar.add_task(title, total=total)
        self._title, self._last, self._start = title, "", time.monotonic()

    def __enter__(self) -> Bar:
        self._bar.start()
        return self

    def __exit__(self, *exception: object) -> None:
        self._bar.stop()

    def fraction(self, reached: float, last: float) -> bool:
        """The callback of `solve`."""
        done = reached / last if last else 1.0
        self._bar.update(self._task, completed=done)
        if not self._console.is_terminal and time.monotonic() - self._start > 2:
            self._line(f"{self._title}: {int(10 * done) * 10} %")
        return True

    def step(self, done: int, text: str) -> None:
        """The callback of `chart`."""
        self._bar.update(self._task, completed=done, description=text)
        if not self._console.is_terminal:
            self._line(f"{time.monotonic() - self._start:5.0f} s  {text}")

    def _line(self, text: str) -> None:
        if text != self._last and not self._quiet:
            with contextlib.suppress(OSError):   # a full disk is no reason to stop the work
                print(text, file=sys.stderr, flush=True)
            self._last = text

    def of(self, done: int, total: int, text: str) -> None:
        """The callback of `atlas`."""
        self._bar.update(self._task, total=total)
        self.step(done, text)

    def above(self, show: Callable[[Any], object], result: Any) -> None:
        """Print something above the bar."""
        if self._console.is_terminal and sys.stdout.isatty():
            self._bar.stop()
            show(result)
            self._bar.start()
        else:
            show(result)
            sys.stdout.flush()


def _table(*columns: str, left: int = 1) -> Table:
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False)
    for index, column in enumerate(columns):
        table.add_column(column, justify="left" if index < left else "right", no_wrap=not sys.stdout.isatty(),
                         overflow="fold")   # no word is cut
    return table


def _numbers(row: Any) -> list[str]:
    return [f"{value:.9g}" for value in row]


def _narrow_tables(out: Console, names: list[str], rows: list[list[str]]) -> None:
    """Print as many columns beside the first as fit the terminal, then the next ones: no number is cut."""
    widths = [2 + max(len(name), *(len(row[k]) for row in rows)) for k, name in enumerate(names)]
    rest = list(range(1, len(names)))
    while rest:
        fits = [k for count, k in enumerate(rest)
                if widths[0] + sum(widths[j] for j in rest[:count + 1]) <= out.width] or rest[:1]
        rest = rest[len(fits):]
        table = _table(*(names[k] for k in [0, *fits]), left=0)
        for row in rows:
            table.add_row(*(row[k] for k in [0, *fits]))
        out.print(table)


def motion(result: Motion) -> None:
    """Print first and last samples, drift of the invariants, counts and message."""
    out = console()
    plan, n = result.plan, len(result)
    name = result.scene.name or "scene"
    out.print(Text(f"{name}: {n} samples by {plan.method}, model {plan.model}, state {plan.state}"))
    names = ["t [s]"] + (["omega x", "y", "z [rad/s]"] if result.omega is not None else [])
    names += ["attitude x", "y", "z", "w"] if result.attitude is not None else []
    rows = []
    for i in range(n) if n <= 8 else [0, 1, 2, -1, n - 3, n - 2, n - 1]:
        cells = ["..."] * len(names) if i < 0 else _numbers([result.t[i]])
        for array in (result.omega, result.attitude):
            if i >= 0 and array is not None:
                cells += _numbers(array[i])
        rows.append(cells)
    _narrow_tables(out, names, rows)
    for i, ticks in enumerate(result.ticks):
        _ticks(out, i, result.scene.controllers[i], ticks)
    drift = ", ".join(f"{name.replace('_', ' ')} {value:.1e}" for name, value in result.drift.items())
    counts = ", ".join(f"{value:,} {name.removesuffix('s') if value == 1 else name}"
                       for name, value in result.stats.items() if isinstance(value, int) and value)
    out.print(Text(f"drift   {drift or 'no invariant is known here'}"))
    if result.proved_span is not None:
        begin, end = result.proved_span
        widths = [f"{name} {float((upper - lower).max()):.1e}" for name, lower, upper in (
            ("omega", result.omega_lower, result.omega_upper),
            ("attitude", result.attitude_lower, result.attitude_upper)) if lower is not None and upper is not None]
        out.print(Text(f"proof   from {begin:g} to {end:g} s; widest bounds: {', '.join(widths)}"))
    out.print(Text(f"cost    {counts}; {1e3 * result.stats['seconds']:.3g} ms"))
    out.print(Text(f"result  {'' if result.success else 'FINDING: '}{result.message}"))


def _ticks(out: Console, i: int, controller: Any, ticks: Any) -> None:
    """Print the first and last ticks of a controller."""
    n = len(ticks.t)
    out.print(Text(f"controller {i}: {n} ticks, a command of {controller.output}"))
    arrays = {"command": ticks.command, **ticks.states}
    columns = {name: array.reshape(n, -1) for name, array in arrays.items()}
    names = ["tick", "t [s]"]
    for name, array in columns.items():
        names += [f"{name} {k}" if array.shape[1] > 1 else name for k in range(array.shape[1])]
    rows = []
    for k in range(n) if n <= 8 else [0, 1, 2, -1, n - 3, n - 2, n - 1]:
        rows.append(["..."] * len(names) if k < 0 else [
            str(k), *_numbers([ticks.t[k], *(x for array in columns.values() for x in array[k])])])
    if rows:
        _narrow_tables(out, names, rows)


def calibration(factors: dict[str, float], file: str) -> None:
    """Print the time of each model and method over its forecast."""
    out = console()
    table = _table("model or method", "time / forecast", left=1)
    for name, factor in factors.items():
        table.add_row(name, f"{factor:.2f}")
    out.print(table)
    out.print(Text(f"saved in {file}"))


def methods(records: list[dict[str, Any]]) -> None:
    """Print one line for each method."""
    table = _table("method", "order", "dense", "steps", "keeps", "what it is", "source", left=7)
    for record in records:
        table.add_row(record["name"], str(record["order"]), str(record["dense_order"]),
                      "adaptive" if record["adaptive"] else "fixed", record["keeps"], record["doc"], record["source"])
    console().print(table)


BODY = ("shape", "mesh", "parts", "faces", "surfaces", "cavities", "size", "volume", "mass", "com", "moments",
        "symmetry",
        "arbitrary", "axes", "verdict")
BODY_UNITS = {"size": " [m]", "volume": " [m^3]", "mass": " [kg]", "com": " [m]", "moments": " [kg m^2]",
              "axes": " (columns)"}


def body(finding: dict[str, Any]) -> None:
    """Print the mass properties of a body."""
    out = console()
    table = _table("", "", left=2)
    table.show_header = False
    for name in BODY:
        value = finding.get(name)
        if value is None:
            continue
        if name == "axes":
            value = "\n".join("  ".join(f"{x:12.9f}" for x in row) for row in value)
        elif isinstance(value, list):
            value = ", ".join(f"{x:.9g}" for x in value)
        table.add_row(f"{name}{BODY_UNITS.get(name, '')}", Text(value if isinstance(value, str) else f"{value:.9g}"))
    out.print(table)
    for note in finding.get("notes", ()):
        out.print(Text(f"note  {note}"))
