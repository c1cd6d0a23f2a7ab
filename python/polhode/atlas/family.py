"""A family of failures: a sweep, a truth, a threshold, and a verdict for each entrant."""

from __future__ import annotations

import contextlib
import math
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

from .case import Case, truth_of, turn_of
from .entrants import PER_TURN, Entrant
from .run import Failed, Refused, run, values_of

LEVELS = ("holds", "degrades", "fails", "unknown", "none")
WRONG = 0.1   # rad: an attitude off by more is lost
SURE = 1.2   # times the limit: what is foreseen to take longer is not tried
CLEAR = 0.1  # seconds: from less no time is foreseen
LATE = ("not done within", "the one before", "would take")   # reasons


@dataclass
class Point:
    """One entrant at one value of the swept quantity. `why` is empty if it gave a result."""

    x: float
    series: str = ""
    values: dict[str, Any] = field(default_factory=dict)
    why: str = ""
    status: str = "answered"   # "failed" | "refused" | "left out"
    cpu: float = 0.0           # seconds it took, with everything around the answer

    @property
    def late(self) -> bool:
        """True if it was left out because of the time limit."""
        return self.status == "left out" and self.why.startswith(LATE)

    def get(self, name: str) -> float:
        """A value; infinite where the run failed, NaN where it was not made."""
        if self.status == "failed":
            return math.inf
        value = self.values.get(name)
        return math.nan if value is None else float(value)

    @contextlib.contextmanager
    def trying(self, failed: str = "failed") -> Iterator[None]:
        """Write down why a run was refused or broke off, `failed` where it was not for want of time, and go on."""
        try:
            yield
        except Refused as why:
            self.status, self.why = "refused", str(why)
        except Failed as why:
            self.status, self.why = ("left out" if why.late else failed), str(why)


def to_json(point: Point) -> dict[str, Any]:
    """Return a point as JSON has it: what is not a finite number is null."""
    def finite(value: Any) -> Any:
        return None if isinstance(value, float) and not math.isfinite(value) else value

    return {"x": finite(point.x), "series": point.series, "status": point.status, "why": point.why,
            "cpu": point.cpu, "values": {name: finite(value) for name, value in point.values.items()}}


def from_json(content: dict[str, Any]) -> Point:
    """Read a point back: null is NaN."""
    def number(value: Any) -> Any:
        return math.nan if value is None else value

    values = {name: number(value) for name, value in content["values"].items()}
    return Point(number(content["x"]), content["series"], values, content["why"], content["status"],
                 content["cpu"])


@dataclass
class Verdict:
    """What the matrix says: a level, and the number behind it in a few characters."""

    level: str
    text: str
    number: float = math.nan
    why: str = ""


@dataclass(frozen=True)
class Family:
    """One family of the atlas.

    `measure(entrant, quick, limit)` yields points; `judge(points)` reads them. `takes(entrant)` says why someone
    does not take part, or "". What a scene itself refuses needs no line there.
    """

    name: str
    title: str
    sweeps: str          # what is swept, in a few words
    truth: str
    holds: str           # the threshold, in words
    degrades: str
    number: str          # what the cells of the matrix say
    about: str           # two sentences for a reader
    measure: Callable[[Entrant, bool, float], Iterator[Point]]
    judge: Callable[[list[Point]], Verdict]
    x_label: str
    y_label: str
    y: str               # the value that the picture and the table show
    takes: Callable[[Entrant], str] = lambda entrant: "" if entrant.kind != "witness" else "only for the norm"
    also: tuple[tuple[str, str, tuple[float, float]], ...] = ()   # further panels: value, label, limits
    series: tuple[tuple[str, str], ...] = (("", ""),)   # (name, title of its panel)
    x_labels: tuple[tuple[str, str], ...] = ()           # of series that have one of their own
    lines: tuple[tuple[float, str], ...] = ()            # thresholds to be drawn
    x_inverted: bool = False
    y_log: bool = True
    x_scale: str = "log"         # "log" | "symlog" | "linear" | "list" (one place for each value)
    y_limits: tuple[float, float] | None = None
    tick_names: tuple[tuple[float, str], ...] = ()   # values that are called something else
    failed_below: bool = False   # a run that broke off is drawn at the bottom: where more is better
    cost: float = 1.0            # seconds of CPU that the whole sweep takes, about: long ones are begun first
    summary: str = ""            # what the column of the matrix is headed by, in two lines at most


def fixed_only(entrant: Entrant) -> str:
    """For families about the length of a step."""
    return "" if entrant.fixed else "chooses its own steps"


def too_long(clock: list[tuple[float, float]], x: float, limit: float) -> str:
    """Why a run that costs more than those before it need not be tried, or "".

    `clock` has (x, CPU seconds) of those; a power law through the last two foresees this one.
    """
    if not clock or clock[-1][1] < CLEAR:
        return ""
    if math.isinf(clock[-1][1]):
        return "the one before was not done in time"
    if len(clock) < 2:
        return ""
    (x0, c0), (x1, c1) = clock[-2:]
    seconds = c1 * (x / x1) ** max(0.0, math.log(c1 / max(c0, 1e-4)) / math.log(x1 / x0))
    return f"would take about {seconds:.0f} s" if seconds > SURE * limit else ""


def measure_cases(
    family: str,
    cases: Iterable[Case],
    entrant: Entrant,
    limit: float,
    setting: Callable[[Case], dict[str, float]] | None = None,
    more: Callable[[Any, Any], dict[str, float]] | None = None,
) -> Iterator[Point]:
    """Run one case after another and compare each with its truth; leave out cases that would take too long."""
    clocks: dict[str, list[tuple[float, float]]] = {}
    for case in cases:
        point, clock = Point(case.x, case.series), clocks.setdefault(case.series, [])
        if case.grows and (why := too_long(clock, case.x, limit)):
            point.status, point.why = "left out", why
            yield point
            continue
        options = setting(case) if setting else entrant.setting(step=turn_of(case.scene) / PER_TURN)
        begin = time.thread_time()
        with point.trying():
            truth = truth_of(family, case)
            start = time.thread_time()
            motion = run(entrant, case.scene, options, limit)
            point.values = values_of(motion, truth) | {"took": time.thread_time() - start}
            point.values |= more(motion, truth) if more else {}
        clock.append((case.x, math.inf if point.status == "left out" else time.thread_time() - begin))
        yield point


def tried_points(points: list[Point]) -> list[Point]:
    """Those that were tried and not refused: answers and failures."""
    return [p for p in points if p.status in ("answered", "failed")]


def judge_no_answer(points: list[Point]) -> Verdict | None:
    """The verdict where nothing was tried."""
    if tried_points(points):
        return None
    if points and all(p.status == "refused" for p in points):
        return Verdict("none", "", why=points[0].why)
    return Verdict("unknown", "too slow", why=points[0].why if points else "no point")


def to_short(value: float) -> str:
    """A number in as few characters as a cell has: 2e-5, 0.3, 40, 1e4."""
    if math.isnan(value):
        return "-"
    if math.isinf(value):
        return "inf"
    if value == 0:
        return "0"
    if 0.095 <= abs(value) < 999.5:
        return f"{value:.1g}" if abs(value) < 9.5 else f"{value:.0f}"
    mantissa, _, exponent = f"{value:.0e}".partition("e")
    return f"{mantissa}e{int(exponent)}"
