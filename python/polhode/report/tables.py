"""Tables of a report from results.json: the fastest candidates, the scenes, and the machine."""

from __future__ import annotations

import math
from typing import Any

from .._plot.text import to_error, to_time

LEVELS = (1e-3, 1e-6, 1e-9, 1e-12)
OWN = ("method", "cheap", "plan", "exact")
Row = list[str]


def fastest(scene: dict[str, Any], level: float, families: tuple[str, ...]) -> dict[str, Any] | None:
    """Return the point of these families that reaches an error first."""
    reaching = [p for p in scene["points"] if p["status"] == "answered" and p["family"] in families
                and p["error"] <= level]
    return min(reaching, key=lambda p: float(p["seconds"]), default=None)


def _cut(point: dict[str, Any]) -> bool:
    """Whether the budget, and not the candidate, left this setting without an answer."""
    status, why = str(point["status"]), str(point.get("why", ""))
    return status == "left out" or (status == "failed" and why.startswith("not done"))


def stopped(points: list[dict[str, Any]]) -> str | None:
    """Return the last setting that was answered, where the budget left out one after it; the tightest is last."""
    answered = [i for i, p in enumerate(points) if p["status"] == "answered"]
    if not answered or not any(_cut(p) for p in points[answered[-1] + 1:]):
        return None
    setting: str = points[answered[-1]]["setting"]
    return setting if setting.endswith(" s") else f"rtol {to_error(float(setting))}"


def _cell(scene: dict[str, Any], level: float, families: tuple[str, ...]) -> str:
    point = fastest(scene, level, families)
    if point is not None:
        return f"{point['candidate']} {to_time(point['seconds'])}"
    return "not in the budget" if any(_cut(p) for p in scene["points"] if p["family"] in families) else "never"


def winners(content: dict[str, Any]) -> tuple[Row, list[Row]]:
    """Return, for each scene and error, polhode's fastest and that of other programs."""
    rows = []
    with_peers = any(p["family"] == "peer" for s in content["scenes"] for p in s["points"])
    for scene in content["scenes"]:
        rows.append([f"{scene['name']} {scene['title']}", "polhode",
                     *(_cell(scene, level, OWN) for level in LEVELS)])
        if with_peers:
            rows.append(["", "others", *(_cell(scene, level, ("peer",)) for level in LEVELS)])
    return ["scene", "", *(f"error ≤ {to_error(level)}" for level in LEVELS)], rows


def best(content: dict[str, Any]) -> tuple[Row, list[Row]]:
    """Return each candidate's smallest error on each scene, and where the budget stopped its settings."""
    names = list(dict.fromkeys(p["candidate"] for s in content["scenes"] for p in s["points"]))
    rows = []
    for name in names:
        row = [name]
        for scene in content["scenes"]:
            points = [p for p in scene["points"] if p["candidate"] == name]
            errors = [p["error"] for p in points if p["status"] == "answered"]
            failed = any(p["status"] == "failed" and not _cut(p) for p in points)
            cell = to_error(min(errors)) if errors else "failed" if failed else "too slow" if points else "–"
            last = stopped(points)
            row.append(cell if last is None else f"{cell}, stopped at {last}")
        rows.append(row)
    return ["smallest error", *(scene["name"] for scene in content["scenes"])], rows


def against(content: dict[str, Any], count: int = 5) -> tuple[Row, list[Row]]:
    """Return the comparisons that are worst for polhode's integrators: at an error, the time over another program's.

    Closed forms stand in a column of their own, and do not count. An error that polhode's integrators do not reach and
    another program does comes first.
    """
    found: list[tuple[float, Row]] = []
    for scene in content["scenes"]:
        for level in LEVELS:
            peer = fastest(scene, level, ("peer",))
            if peer is None:
                continue
            own, exact = fastest(scene, level, ("method", "cheap")), fastest(scene, level, ("exact",))
            ratio = math.inf if own is None else float(own["seconds"]) / float(peer["seconds"])
            found.append((ratio, [
                f"{scene['name']} {scene['title']}", to_error(level), f"{peer['candidate']} {to_time(peer['seconds'])}",
                "not reached" if own is None else f"{own['candidate']} {to_time(own['seconds'])}",
                "-" if own is None else f"{ratio:.2g}", "-" if exact is None else to_time(exact["seconds"])]))
    found.sort(key=lambda item: -item[0])
    return (["scene", "error", "other program", "polhode's integrators", "times as long", "closed form"],
            [row for _, row in found[:count]])


def failures(content: dict[str, Any]) -> tuple[Row, list[Row]]:
    """Return every run that failed and every one that was left out, with the reason."""
    found: dict[tuple[str, str, str], list[str]] = {}
    for scene in content["scenes"]:
        for point in scene["points"]:
            if point["status"] != "answered":
                key = (scene["name"], point["candidate"], f"{point['status']}: {point['why']}")
                found.setdefault(key, []).append(point["setting"])
    return ["scene", "who", "settings", "what"], [[s, c, _span(settings), why]
                                                  for (s, c, why), settings in found.items()]


def _span(settings: list[str]) -> str:
    return settings[0] if len(settings) == 1 else f"{settings[0]} to {settings[-1]}"


def scenes(content: dict[str, Any]) -> tuple[Row, list[Row]]:
    """Return what each scene is, and how well its truth is known."""
    rows = []
    for scene in content["scenes"]:
        what, reference = scene["scene"], scene["reference"]
        known = reference["floor"] if reference["floor"] is not None else reference["uncertainty"]
        rows.append([f"{scene['name']} {scene['title']}", _numbers(what["moments"]), _numbers(what["omega"]),
                     what["torques"] or "none", f"{scene['span']:g} s, {scene['samples']}",
                     f"{reference['kind']}, {to_error(known)}"])
    return ["scene", "moments [kg m²]", "ω at the start [rad/s]", "torque", "span, samples", "truth, known to"], rows


def _numbers(values: list[float]) -> str:
    return ", ".join(f"{v:.4g}" for v in values)


def machine(content: dict[str, Any]) -> list[Row]:
    """Return machine, build and versions, a pair a row."""
    here, build = content["machine"], content["polhode"]
    rows = [["processor", f"{here['processor']}, {here['cores']} cores"], ["system", here["system"]],
            ["Python", here["python"]]]
    rows += [[f"polhode {key}", str(value)] for key, value in build.items()]
    rows += [[name, version] for name, version in content["versions"].items()]
    rows += [[f"{name}, not installed", how] for name, how in content["missing"].items()]
    return rows


def how_they_ran(content: dict[str, Any]) -> str:
    """Return the variables and the right-hand side of each candidate; of older results what is known of them."""
    about: dict[str, set[tuple[str, str]]] = {}
    for scene in content["scenes"]:
        for name, one in scene.get("candidates", {}).items():
            about.setdefault(name, set()).add((one["variables"], one["right_hand_side"]))
    if not about:
        return ("taylor, radau and symplectic stepped u, v on triaxial bodies in this run. All other methods and "
                "programs stepped Euler's rates. SciPy and SUNDIALS called a right-hand side in Python.")
    rows = [[name, " or ".join(sorted({v for v, _ in found})), " or ".join(sorted({w for _, w in found}))]
            for name, found in about.items()]
    return markdown((["candidate", "variables", "right-hand side"], rows))


def startups(content: dict[str, Any]) -> tuple[Row, list[Row]]:
    """Return the longest start of each candidate that takes more than a hundredth of a second."""
    longest: dict[str, float] = {}
    for scene in content["scenes"]:
        for name, seconds in scene["startups"].items():
            longest[name] = max(longest.get(name, 0.0), seconds)
    rows = [[name, to_time(seconds)] for name, seconds in sorted(longest.items(),
                                                                 key=lambda item: -item[1]) if seconds > 0.01]
    return ["before the first answer", "longest"], rows


def markdown(table: tuple[Row, list[Row]]) -> str:
    """Return a table as Markdown."""
    head, rows = table
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines) + "\n"


LARGE = ("error_omega", "error_attitude", "drift", "counts", "value", "fastest", "slowest", "swept")   # of a point


def compact(content: dict[str, Any]) -> dict[str, Any]:
    """Return results with numbers to three digits and without what no table needs, small enough for the sources."""
    def short(value: Any) -> Any:
        if isinstance(value, float):
            return float(f"{value:.3g}") if math.isfinite(value) else None
        if isinstance(value, dict):
            return {key: short(item) for key, item in value.items()}
        return [short(item) for item in value] if isinstance(value, list) else value

    def point(full: dict[str, Any]) -> dict[str, Any]:
        return {key: value for key, value in full.items() if key not in LARGE and value not in (None, "", 0)}

    scenes_ = [{**scene, "points": [point(p) for p in scene["points"]]} for scene in content["scenes"]]
    found: dict[str, Any] = short({**content, "scenes": scenes_})
    return found
