"""The entrants: the choice of `solve`, the closed forms, every method, torques as formulas, and Euler angles."""

from __future__ import annotations

from typing import Any, NamedTuple

from .._solve.solve import methods

TIGHT = 1e-14       # the tolerance of methods that choose their steps, where nothing else is swept
PER_TURN = 40       # steps a turn of those that do not


# The groups of the matrix, in this order, and what they are called.
KINDS = {"solve": "polhode decides", "exact": "polhode decides", "method": "steppers", "cheap": "engines' steps",
         "formula": "torques as formulas", "angles": "Euler angles", "witness": "without care"}
ANGLES = ("rk45", "dop853")   # general methods, which take Lagrange's equations


class Entrant(NamedTuple):
    """One row of the matrix."""

    name: str
    kind: str                # one of KINDS
    record: dict[str, Any]   # of the method; empty where none is named
    options: dict[str, Any]  # the options of `solve`

    @property
    def fixed(self) -> bool:
        """True for a fixed step, which the user must choose."""
        return bool(self.record) and not self.record["adaptive"]

    def setting(self, *, step: float, rtol: float = TIGHT, accuracy: float = 1e-9) -> dict[str, float]:
        """The one of these that it listens to."""
        if self.kind == "exact":
            return {}
        if self.kind == "solve":
            return {"accuracy": accuracy}
        return {"step": step} if self.fixed else {"rtol": rtol}


def entrants() -> list[Entrant]:
    """Return all entrants, in the order of the matrix."""
    records = methods()
    found = [Entrant("solve", "solve", {}, {}), Entrant("exact", "exact", {}, {"method": "exact"})]
    for cheap in (False, True):
        found += [Entrant(r["name"], "cheap" if cheap else "method", r, {"method": r["name"]})
                  for r in records if r["comparison"] == cheap]
    found.append(Entrant("formula", "formula", {}, {"method": "taylor"}))
    # Lagrange's equations in the textbook's angles, by the general method of the highest order that is not implicit.
    general = max((r for r in records if r["adaptive"] and not r["implicit"] and r["name"] in ANGLES),
                  key=lambda r: int(r["order"]))
    found.append(Entrant("angles", "angles", general, {"method": general["name"], "formulation": "lagrangian"}))
    return found


# A plain Runge-Kutta run without normalisation of the quaternion (family "norm").
WITNESS = Entrant("rk4 plain", "witness", {}, {})
