"""Results of a family as JSON: points and verdicts, with machine and versions."""

from __future__ import annotations

import json
import math
import pathlib
import time
from dataclasses import dataclass
from typing import Any

from .. import _files
from .._core import build_info
from .._harness.machine import machine, versions
from .entrants import KINDS, WITNESS, entrants
from .family import Family, Point, Verdict, from_json, to_json
from .jobs import find_family, rows_of

FORMAT = "polhode atlas 2"


@dataclass
class FamilyResult:
    """All points of a family, by entrant, and what they come to."""

    family: Family
    quick: bool
    limit: float              # seconds of CPU that a run might take
    rows: dict[str, list[Point]]
    kept: bool = False        # read from an earlier run
    made: str = ""            # when

    @property
    def cpu(self) -> dict[str, float]:
        """Seconds of CPU that each row took, the dearest first."""
        spent = {name: round(sum(p.cpu for p in points), 2) for name, points in self.rows.items()}
        return dict(sorted(spent.items(), key=lambda item: -item[1]))

    def verdict(self, entrant: str) -> Verdict:
        """The cell of the matrix; one without points is empty, and says why."""
        who = next((e for e in rows_of(self.family) if e.name == entrant), None)
        if who is None or entrant not in self.rows:
            known = {e.name: e for e in [*entrants(), WITNESS]}
            return Verdict("none", "", why=self.family.takes(known[entrant]) if entrant in known else "not there")
        points = self.rows[entrant]
        broken = [p for p in points if math.isnan(p.x)]   # a fault, a crash or a hang
        if broken:
            return Verdict("fails", "hung" if broken[0].why.startswith("hung") else "crashed", math.inf, broken[0].why)
        return self.family.judge(points)


def signature(family: Family, quick: bool, limit: float) -> dict[str, Any]:
    """Return the settings that an earlier result must share to be kept."""
    return {"format": FORMAT, "quick": quick, "limit": limit, "polhode": build_info()["version"],
            "rows": [e.name for e in rows_of(family)], "sweeps": family.sweeps, "holds": family.holds,
            "degrades": family.degrades}


def family_document(result: FamilyResult) -> dict[str, Any]:
    """Return the content of <family>.json."""
    family = result.family
    return {
        **signature(family, result.quick, result.limit), "family": family.name, "title": family.title,
        "truth": family.truth,
        "value": family.y, "value_means": family.y_label, "made": result.made, "cpu_seconds": result.cpu,
        "machine": machine(), "versions": versions(), "build": build_info(),
        "verdicts": {name: _verdict(result.verdict(name)) for name in result.rows},
        "points": {name: [to_json(p) for p in points] for name, points in result.rows.items()},
    }


def _verdict(verdict: Verdict) -> dict[str, Any]:
    number = verdict.number if math.isfinite(verdict.number) else None
    return {"level": verdict.level, "text": verdict.text, "number": number, "why": verdict.why}


def read_family(path: pathlib.Path, settings: tuple[bool, float] | None = None) -> FamilyResult | None:
    """Read a family's file; None when it is not there, not whole, or not of these settings (`quick`, `limit`)."""
    try:
        content = json.loads(_files.read(path, _files.TEXT))
        family = find_family(content["family"])
        if settings is not None and any(content.get(k) != v for k, v in signature(family, *settings).items()):
            return None
        rows = {name: [from_json(p) for p in points] for name, points in content["points"].items()}
        return FamilyResult(family, content["quick"], content["limit"], rows, True, content["made"])
    except (OSError, ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError):
        return None


def write_family(result: FamilyResult, folder: pathlib.Path) -> pathlib.Path:
    """Write a family's file whole or not at all."""
    path = folder / f"{result.family.name}.json"
    text = json.dumps(family_document(result), indent=1, allow_nan=False)
    _files.write(path, text + "\n", follow=False)
    return path


def matrix(results: list[FamilyResult]) -> dict[str, dict[str, Verdict]]:
    """Return {entrant: {family: verdict}}, in the order of the list, without rows that say nothing."""
    names = [e.name for e in [*entrants(), WITNESS]]
    table = {name: {r.family.name: r.verdict(name) for r in results} for name in names}
    return {name: row for name, row in table.items() if any(v.level != "none" for v in row.values())}


def document(results: list[FamilyResult], seconds: float, broken: list[str], files: list[str]) -> dict[str, Any]:
    """Return the content of atlas.json: the matrix and what stands behind its columns."""
    kinds = {e.name: e.kind for e in [*entrants(), WITNESS]}
    return {
        "format": FORMAT, "made": time.strftime("%Y-%m-%d %H:%M"), "quick": all(r.quick for r in results),
        "seconds": seconds, "cpu_seconds": round(sum(sum(r.cpu.values()) for r in results), 1), "polhode": build_info(),
        "machine": machine(), "versions": versions(),
        "families": {r.family.name: {"title": r.family.title, "about": r.family.about, "number": r.family.number,
                                     "sweeps": r.family.sweeps, "truth": r.family.truth, "holds": r.family.holds,
                                     "degrades": r.family.degrades, "cpu_seconds": r.cpu, "kept": r.kept}
                     for r in results},
        "matrix": {name: {"group": KINDS[kinds[name]], **{f: _verdict(v) for f, v in row.items()}}
                   for name, row in matrix(results).items()},
        "broken_claims": broken, "files": files,
    }
