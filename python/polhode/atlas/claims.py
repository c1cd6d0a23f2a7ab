"""Claims of polhode about its methods. A claim that does not hold is a finding of the atlas, and fails a test.

Each claim names the lowest level that a method must reach.
"""

from __future__ import annotations

from .entrants import entrants
from .family import LEVELS
from .results import FamilyResult

CLAIMS: dict[str, dict[str, str]] = {
    # The choice of `solve`.
    "solve": {"racket": "holds", "gimbal": "holds", "long": "holds", "near": "holds", "scales": "holds",
              "norm": "holds", "sleeping": "holds", "spin-up": "holds", "damping": "holds", "chaos": "holds",
              "wheel": "holds"},
    "exact": {"racket": "holds", "gimbal": "holds", "long": "holds", "near": "holds", "scales": "holds",
              "norm": "holds", "sleeping": "holds", "wheel": "holds"},
    "taylor": {"racket": "holds", "gimbal": "holds", "long": "holds", "near": "holds", "scales": "holds",
               "norm": "holds", "sleeping": "holds", "spin-up": "holds", "chaos": "holds", "damping": "degrades",
               "wheel": "holds"},
    "dop853": {"racket": "degrades", "gimbal": "holds", "scales": "holds", "norm": "holds", "near": "degrades",
               "sleeping": "holds"},
    "rk45": {"racket": "degrades", "gimbal": "holds", "scales": "holds", "norm": "holds", "near": "degrades",
             "sleeping": "holds"},
    "radau": {"racket": "holds", "damping": "holds", "gimbal": "holds", "scales": "holds", "norm": "holds",
              "spin-up": "degrades",
              "sleeping": "holds"},
    "symplectic": {"racket": "holds", "step": "holds", "gimbal": "holds", "long": "degrades", "near": "holds",
                   "scales": "holds",
                   "norm": "holds", "spin-up": "holds", "sleeping": "holds"},
    # The built-in torques as a user would write them.
    "formula": {"damping": "degrades", "spin-up": "holds", "chaos": "holds", "scales": "holds",
                "sleeping": "holds"},
    # The best cheap step of a free body.
    "dmv8": {"step": "holds", "gimbal": "holds", "long": "degrades", "near": "degrades", "scales": "holds",
             "norm": "holds"},
}
CONSERVED = ("energy", "L")   # conserved quantities of a record, and the invariant of `Motion.drift` that measures each
DRIFT = {"energy": "energy", "L": "angular_momentum"}
ROUNDING = 1e-9   # of a conserved invariant, after up to a million turns


def find_broken(results: list[FamilyResult]) -> list[str]:
    """Return a sentence for each claim that these results contradict."""
    broken = []
    for name, claims in CLAIMS.items():
        for result in results:
            least = claims.get(result.family.name)
            if least is None:
                continue
            verdict = result.verdict(name)
            if verdict.level not in LEVELS[:LEVELS.index(least) + 1]:
                broken.append(f"{name}, {result.family.name}: {verdict.level} ({verdict.text}), but should be at "
                              f"least {least}{': ' + verdict.why if verdict.why else ''}")
    return broken + _drifted(results) + _overclaimed(results)


def _overclaimed(results: list[FamilyResult]) -> list[str]:
    """Find stated errors below the true error, beyond the rounding of the stored truth."""
    broken = []
    for result in results:
        for name in ("solve", "exact"):
            for p in result.rows.get(name, []):
                stated, true = p.get("stated"), p.get("error")
                if p.status == "answered" and true > 1.1 * stated + 1e-15:
                    broken.append(f"{name}, {result.family.name}, at {p.x:g}{' ' + p.series if p.series else ''}: "
                                  f"states an error of {stated:.1e}, but the error is {true:.1e}")
    return broken


def _drifted(results: list[FamilyResult]) -> list[str]:
    """Find invariants that a record promises and the family of long times contradicts."""
    broken = []
    for result in results:
        if result.family.name != "long":
            continue
        for entrant in entrants():
            promised = [name.strip() for name in entrant.record.get("keeps", "").split(",")]
            for what in CONSERVED:
                # A method that conserves |L| alone may change the direction of L.
                if what not in promised:
                    continue
                worst = max((p.get(DRIFT[what]) for p in result.rows.get(entrant.name, []) if p.status == "answered"),
                            default=0.0)
                if worst > ROUNDING:
                    broken.append(f"{entrant.name}, long: its record says that it conserves {what}, which drifted by "
                                  f"{worst:.1e}")
    return broken
