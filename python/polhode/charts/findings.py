"""Findings about a measured scene, in words made from its numbers."""

from __future__ import annotations

import math
import re
import statistics

from .._plot.text import to_count, to_error, to_time
from .candidate import CLOSED, OWN
from .measure import Point, SceneResult


def front(points: list[Point]) -> list[Point]:
    """Return the points no other one beats in both error and time, from loose to tight."""
    best: list[Point] = []
    for point in sorted(points, key=lambda p: (p.seconds, p.error)):
        if not best or point.error < best[-1].error:
            best.append(point)
    return best


def time_to_reach(points: list[Point], error: float) -> float:
    """Seconds to an error, along the front (log-log between its points); its quickest point where that errs less; NaN
    where
    none is so good."""
    best = front(points)
    if not best or error < best[-1].error:
        return math.nan
    for loose, tight in zip(best, best[1:]):
        if tight.error <= error <= loose.error:
            share = math.log(loose.error / error) / math.log(loose.error / tight.error)
            return math.exp(math.log(loose.seconds) * (1 - share) + math.log(tight.seconds) * share)
    return best[0].seconds


def own(result: SceneResult) -> list[Point]:
    """Return the points of all of polhode's steppers."""
    return [p for name in result.names("method", "cheap") for p in result.of(name)]


def dominated(result: SceneResult) -> set[str]:
    """Return the steppers, polhode's and others', of which another one beats every point, in error and by a quarter in
    time.

    A point with an error above 0.3 answers nothing and is always beaten.
    """
    names = result.names("method", "cheap", "peer")
    rivals = {name: [p for other in names if other != name for p in result.of(other)] for name in names}

    def beaten(point: Point) -> bool:
        return point.error > 0.3 or any(r.error <= point.error and 1.25 * r.seconds <= point.seconds
                                        for r in rivals[point.candidate])

    return {name for name in names if all(beaten(p) for p in result.of(name))}


def adaptive(result: SceneResult) -> list[str]:
    """Return polhode's methods with a tolerance that answered."""
    return [name for name in result.names("method") if result.of(name)[0].swept == "rtol"]


def stalls(result: SceneResult, name: str) -> bool:
    """Whether tighter tolerances stop helping long before float64's floor."""
    points = result.of(name)
    if len(points) < 6 or points[0].swept != "rtol":
        return False
    early = [p.error for p in points if p.value >= 1e3 * points[-1].value]
    best = min(p.error for p in points)
    floor = max(result.truth.floor or 1e-12, result.truth.uncertainty)
    return bool(early) and points[-1].error > 0.3 * min(early) and best > max(30 * floor, 1e-9)


def held_by_stability(result: SceneResult, name: str) -> bool:
    """Whether the number of steps hardly depends on the tolerance, and gives far more than the loosest one asks for.

    (A method that adapts its order takes about the same steps at every tolerance too, but no more than each asks for.)
    """
    points = result.of(name)
    steps = [p.stats.get("steps", 0) for p in points]
    return (len(points) >= 4 and points[0].swept == "rtol" and points[0].value >= 1e4 * points[-1].value
            and 0 < max(steps) < 2 * min(steps) and points[0].error < 0.01 * points[0].value)


def time_ratios(result: SceneResult, names: list[str]) -> list[float]:
    """Times of a program's best candidates over those of polhode's fastest stepper at equal error, at each error of
    theirs
    below 0.1 that one reaches; none on a scene where no tolerance helps."""
    points = own(result)
    if any(stalls(result, name) for name in adaptive(result)):
        return []
    best = front([p for name in names for p in result.of(name) if p.error < 0.1 and p.swept])
    ratios = [p.seconds / time_to_reach(points, p.error) for p in best]
    return [ratio for ratio in ratios if ratio == ratio]


def programs(results: list[SceneResult]) -> dict[str, list[str]]:
    """Return other programs, each with its candidates that answered: the first word of a candidate is its program."""
    found: dict[str, list[str]] = {}
    for name in dict.fromkeys(n for r in results for n in r.names("peer")):
        found.setdefault(name.split()[0], []).append(name)
    return found


def program_ratios(results: list[SceneResult]) -> dict[str, list[float]]:
    """Return each program's ratios over all scenes, by whichever of its candidates is fastest at each error."""
    found = {program: [ratio for result in results for ratio in time_ratios(result, names)]
             for program, names in programs(results).items()}
    answered = [item for item in found.items() if item[1]]
    return dict(sorted(answered, key=lambda item: statistics.median(item[1])))


def fastest(result: SceneResult) -> tuple[str, float, float] | None:
    """Return name, error and seconds of the fastest method at the tightest of 1e-12, 1e-9, 1e-6, 1e-3 reached."""
    for error in (1e-12, 1e-9, 1e-6, 1e-3):
        times = {}
        for name in result.names("method", "cheap"):
            reaching = [p.seconds for p in result.of(name) if p.error <= error]
            if reaching:
                times[name] = min(reaching)
        if times:
            name = min(times, key=lambda n: times[n])
            return name, error, times[name]
    return None


def headline(result: SceneResult) -> str:
    """Return the headline of a scene's picture."""
    exact = [p for name in result.names("exact") for p in result.of(name)]
    closed = f"the closed form has {to_error(exact[0].error)} in {to_time(exact[0].seconds)}" if exact else ""
    steppers = adaptive(result)
    if not result.names("method", "cheap"):
        return closed[:1].upper() + closed[1:] if closed else "No method answered"
    stalled = [name for name in steppers if stalls(result, name)]
    held = [name for name in steppers if held_by_stability(result, name)]
    if stalled and len(stalled) == len(steppers):
        best = min(p.error for name in stalled for p in result.of(name))
        who = stalled[0] if len(stalled) == 1 else "any stepper"
        text = f"No tolerance takes {who} below {to_error(best)}"
        return f"{text}; {closed}" if closed else text
    first = fastest(result)
    if held and not (first and first[0] not in held):
        points = result.of(held[0])
        return (f"Stability holds {held[0]} to {to_count(min(p.stats['steps'] for p in points))} steps and "
                f"{to_time(min(p.seconds for p in points))} at every tolerance")
    stepping = "No stepper reaches 1e-3"
    if first:
        stepping = f"{first[0]} reaches {to_error(first[1])} in {to_time(first[2])}"
    if held and first:
        points = result.of(held[0])
        return f"{stepping}; stability holds {held[0]} to {to_time(min(p.seconds for p in points))} at every tolerance"
    if closed:
        return f"{closed[:1].upper()}{closed[1:]}; {stepping}"
    ratios = next(iter(program_ratios([result]).items()), None)
    return f"{stepping}; {ratios[0]} takes {to_range(ratios[1])} times as long at equal error" if ratios else stepping


def to_ratio(ratio: float) -> str:
    """Two digits: 1234 -> '1,200'."""
    rounded = float(f"{ratio:.2g}")
    return f"{rounded:,.0f}" if rounded >= 10 else f"{rounded:g}"


def to_range(ratios: list[float]) -> str:
    """The smallest and the largest, or one where they round alike."""
    low, high = to_ratio(min(ratios)), to_ratio(max(ratios))
    return low if low == high else f"{low} to {high}"


LONG = r"\d+\.\d{6,}"   # numbers with too many digits to print


def under_headline(result: SceneResult) -> str:
    """Return what was measured, each peer's time at equal error, and the candidates without a result."""
    scene = result.scene
    span = abs(scene.times[-1] - scene.t0)
    text = f"{scene.name or 'scene'} {result.title}: {scene.times.size} samples over {span:g} s"
    parts = [f"{program} {to_range(ratios)}" for program, ratios in program_ratios([result]).items()]
    if parts:
        text += f". Times as long as polhode's fastest stepper at equal error: {', '.join(parts)}"
    silent = without_answer(result)
    late = [name for name, why in silent.items() if why.startswith("not done")]
    for name, why in silent.items():
        if name not in late:
            text += f". {name}: {re.sub(LONG, lambda number: f'{float(number[0]):.4g}', why)}"
    return f"{text}. Not done in time: {', '.join(late)}" if late else text


def without_answer(result: SceneResult) -> dict[str, str]:
    """Return the candidates without a result, with reasons; steps of engines fail too often to be listed."""
    answered = {p.candidate for p in result.points if p.answered}
    silent = [p for p in result.points if p.candidate not in answered and not p.left_out and p.family != "cheap"]
    return {p.candidate: p.why for p in reversed(silent)}


def stopped(result: SceneResult, name: str) -> str | None:
    """Return the tightest setting that a candidate answered, where the budget left out one after it."""
    points = [p for p in result.points if p.candidate == name]
    answered = [i for i, p in enumerate(points) if p.answered]
    cut = answered and any(p.left_out or p.why.startswith("not done") for p in points[answered[-1] + 1:])
    return points[answered[-1]].setting if cut else None


def how_it_ran(result: SceneResult) -> list[str]:
    """Return what a picture says of its curves: the variables, the right-hand sides, and where the budget ended."""
    shown = result.names("method", "cheap", "formula", "peer", "exact", "plan")
    variables: dict[str, list[str]] = {}
    places: dict[str, list[str]] = {}
    for name in shown:
        if name in result.about:
            stepped, place = result.about[name]
            variables.setdefault(stepped, []).append(name)
            if place != OWN:
                places.setdefault(place, []).append(name)
    lines = [f"In {stepped}: {', '.join(names)}" for stepped, names in variables.items() if stepped != CLOSED]
    if places:
        parts = [f"{place}: {', '.join(names)}" for place, names in places.items()]
        lines.append(f"Right-hand side {'; '.join(parts)}")
    ends = {name: setting for name in shown if (setting := stopped(result, name))}
    if ends:
        lines.append("The budget stopped " + ", ".join(f"{name} at {setting}" for name, setting in ends.items()))
    return [f"{line}." for line in lines]
