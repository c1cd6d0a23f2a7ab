"""What a measured scene shows, in words made from its numbers."""

from __future__ import annotations

import math

from .measure import Point, SceneResult


def to_time(seconds: float) -> str:
    """Three digits with a unit that fits: 0.000246 -> '246 µs'."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= 0.9995 * size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds * 1e9:.3g} ns"


def to_error(error: float) -> str:
    """One digit: 2e-5, and 0.2 rather than 2e-1."""
    if not math.isfinite(error) or error == 0:
        return f"{error:g}"
    if error >= 0.1:
        return f"{error:.1g}" if error < 1 else f"{error:.2g}"
    mantissa, _, exponent = f"{error:.0e}".partition("e")
    return f"{mantissa}e{int(exponent)}"


def to_count(number: float) -> str:
    """1234567 -> '1.2 million'; 65432 -> '65 thousand'."""
    for word, size in (("million", 1e6), ("thousand", 1e3)):
        if number >= 9.95 * size or (size == 1e6 and number >= size):
            return f"{number / size:.2g} {word}"
    return f"{number:.0f}"


def front(points: list[Point]) -> list[Point]:
    """Return the points no other one beats in both error and time, from loose to tight."""
    best: list[Point] = []
    for point in sorted(points, key=lambda p: (p.seconds, p.error)):
        if not best or point.error < best[-1].error:
            best.append(point)
    return best


def time_to_reach(points: list[Point], error: float) -> float:
    """Seconds to an error, along the front (log-log between its points); NaN beyond its ends."""
    best = front(points)
    if not best or error < best[-1].error or error > best[0].error:
        return math.nan
    for loose, tight in zip(best, best[1:]):
        if tight.error <= error <= loose.error:
            share = math.log(loose.error / error) / math.log(loose.error / tight.error)
            return math.exp(math.log(loose.seconds) * (1 - share) + math.log(tight.seconds) * share)
    return best[0].seconds


def stalls(result: SceneResult, name: str) -> bool:
    """Whether tighter tolerances stop helping long before float64's floor."""
    points = result.of(name)
    if len(points) < 6:
        return False
    early = [p.error for p in points if p.value >= 1e3 * points[-1].value]
    best = min(p.error for p in points)
    floor = max(result.truth.floor or 1e-12, result.truth.uncertainty)
    return bool(early) and points[-1].error > 0.3 * min(early) and best > max(30 * floor, 1e-9)


def held_by_stability(result: SceneResult, name: str) -> bool:
    """Whether the number of steps hardly depends on the tolerance."""
    points = result.of(name)
    steps = [p.stats.get("steps", 0) for p in points]
    return len(points) >= 4 and points[0].value >= 1e4 * points[-1].value and 0 < max(steps) < 2 * min(steps)


def _time_ratios(result: SceneResult, name: str, peer: str) -> list[float]:
    """Times of a peer over a method's at equal error, at each error of the peer below 0.1 that the method reaches."""
    points = result.of(name)
    ratios = [p.seconds / time_to_reach(points, p.error) for p in result.of(peer) if p.error < 0.1]
    return [ratio for ratio in ratios if ratio == ratio]


def all_ratios(results: list[SceneResult], peer: str) -> list[float]:
    """Times of a peer over those of the first method at equal error, on all scenes where tolerances help that one."""
    found = []
    for result in results:
        names = result.names("method")
        if names and not stalls(result, names[0]):
            found += _time_ratios(result, names[0], peer)
    return found


def fastest(result: SceneResult) -> tuple[str, float, float] | None:
    """Who is first at the tightest of 1e-12, 1e-9, 1e-6, 1e-3 any stepping method reaches: name, error, seconds."""
    for error in (1e-12, 1e-9, 1e-6, 1e-3):
        times = {}
        for name in result.names("method"):
            reaching = [p.seconds for p in result.of(name) if p.error <= error]
            if reaching:
                times[name] = min(reaching)
        if times:
            name = min(times, key=lambda n: times[n])
            return name, error, times[name]
    return None


def headline(result: SceneResult) -> str:
    """The one thing a scene's picture shows."""
    exact = [p for name in result.names("exact") for p in result.of(name)]
    closed = f"the closed form has {to_error(exact[0].error)} in {to_time(exact[0].seconds)}" if exact else ""
    steppers = result.names("method")
    if not steppers:
        return closed[:1].upper() + closed[1:] if closed else "No method answered"
    stalled = [name for name in steppers if stalls(result, name)]
    held = [name for name in steppers if held_by_stability(result, name)]
    if stalled and len(stalled) == len(steppers):
        best = min(p.error for name in stalled for p in result.of(name))
        text = f"No tolerance takes {' or '.join(stalled)} below {to_error(best)}"
        return f"{text}; {closed}" if closed else text
    if held and len(held) == len(steppers):
        points = result.of(held[0])
        return (f"Stability holds {held[0]} to {to_count(min(p.stats['steps'] for p in points))} steps and "
                f"{to_time(min(p.seconds for p in points))} at every tolerance")
    first = fastest(result)
    stepping = f"{steppers[0]} never reaches 1e-3"
    if first:
        stepping = f"{first[0]} reaches {to_error(first[1])} in {to_time(first[2])}"
    if closed:
        return f"{closed[:1].upper()}{closed[1:]}; {stepping}"
    ratios = [r for peer in result.names("peer") for r in _time_ratios(result, first[0], peer)] if first else []
    return f"{stepping}; SciPy takes {to_range(ratios)} times as long at equal error" if ratios else stepping


def to_ratio(ratio: float) -> str:
    """Two digits: 1234 -> '1,200'."""
    rounded = float(f"{ratio:.2g}")
    return f"{rounded:,.0f}" if rounded >= 10 else f"{rounded:g}"


def to_range(ratios: list[float]) -> str:
    """The smallest and the largest, or one where they round alike."""
    low, high = to_ratio(min(ratios)), to_ratio(max(ratios))
    return low if low == high else f"{low} to {high}"


def under_headline(result: SceneResult) -> str:
    """What was measured, each peer's time at equal error, and who never answered."""
    scene = result.scene
    span = abs(scene.times[-1] - scene.t0)
    text = f"{scene.name or 'scene'} {result.title}: {scene.times.size} samples over {span:g} s"
    first = fastest(result)
    parts = []
    for peer in result.names("peer"):
        ratios = _time_ratios(result, first[0], peer) if first and not stalls(result, first[0]) else []
        if ratios:
            parts.append(f"{peer} {to_range(ratios)}")
    if parts and first:
        text += f". Times as long as {first[0]} at equal error: {', '.join(parts)}"
    for name, why in without_answer(result).items():
        text += f". {name}: {why}"
    return text


def without_answer(result: SceneResult) -> dict[str, str]:
    """Who took part and never answered, and why."""
    answered = {p.candidate for p in result.points if p.answered}
    return {p.candidate: p.why for p in reversed(result.points) if p.candidate not in answered and not p.left_out}
