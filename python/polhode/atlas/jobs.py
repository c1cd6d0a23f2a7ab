"""The jobs: every entrant on every family that accepts it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from .._core import InvalidInput
from .entrants import WITNESS, Entrant, entrants
from .families import FAMILIES
from .family import Family


class Job(NamedTuple):
    """One row of one family."""

    family: str
    entrant: str
    quick: bool
    limit: float   # seconds of CPU a point


def find_family(name: str) -> Family:
    """Return a family by its name."""
    for family in FAMILIES:
        if family.name == name:
            return family
    raise InvalidInput(f"family: must be one of {', '.join(f.name for f in FAMILIES)}; got {name!r}")


def find_families(names: Iterable[str]) -> list[Family]:
    """Return families by their names, in the order of the list; all of them when none is named."""
    wanted = [find_family(name) for name in names]
    return [family for family in FAMILIES if not wanted or family in wanted]


def rows_of(family: Family) -> list[Entrant]:
    """Return the entrants of a family, in the order of the matrix."""
    return [e for e in [*entrants(), WITNESS] if not family.takes(e)]


def find_entrant(name: str) -> Entrant:
    """Return an entrant by its name."""
    return next(e for e in [*entrants(), WITNESS] if e.name == name)
