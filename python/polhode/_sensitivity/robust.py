"""Samples that no motion fits together with the others: a loss that bears them, and their names."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .._core import IntegrationFailure
from ..measured import Attitudes, Axis, Direction, Rates
from .candidates import WITHIN, Pool, limit
from .least_squares import Minimum, minimise
from .problem import Problem
from .rotations import Array

SHARE = 0.1     # of the samples that may be outliers: with more there is no knowing which are wrong
STARTS = 4      # of the lowest minima
ROUNDS = 4      # of naming outliers and fitting the others
NAMED = 6       # times in a message

Places = tuple[npt.NDArray[np.intp], ...]


def find_outliers(problem: Problem, residuals: Array) -> Places:
    """Return the places of samples with a sum of squares above 25, for each measurement."""
    found, first = [], 0
    for m in problem.data:
        last = first + len(m) * m.residuals
        squares = (residuals[first:last].reshape(len(m), m.residuals) ** 2).sum(axis=1)
        found.append(np.flatnonzero(squares > WITHIN))
        first = last
    return tuple(found)


def fits_without(problem: Problem, residuals: Array, places: Places) -> bool:
    """Return whether chi2 of the other samples is within its limit, and the outliers are few."""
    if not _few(problem, places):
        return False
    kept, first, squares = _without(problem, places), 0, 0.0
    for m, out in zip(problem.data, places, strict=True):
        last = first + len(m) * m.residuals
        squares += float((np.delete(residuals[first:last].reshape(len(m), m.residuals), out, axis=0) ** 2).sum())
        first = last
    return squares <= limit(kept)


def in_words(problem: Problem, places: Places) -> str:
    """Return the outliers in words."""
    parts = []
    for m, out in zip(problem.data, places, strict=True):
        if out.size:
            times = ", ".join(f"{t:.6g}" for t in m.t[out[:NAMED]])
            more = f" and {out.size - NAMED} more" if out.size > NAMED else ""
            parts.append(f"{type(m).__name__} at t = {times}{more}")
    return "; ".join(parts)


def fits(problem: Problem, pool: Pool, loss: str) -> bool:
    """Return whether the best of the pool fits, or fits without some outliers."""
    if pool.best is None or pool.fits:
        return pool.fits
    if loss == "linear":
        return search(problem, pool) is not None
    return fits_without(problem, pool.best.residuals, find_outliers(problem, pool.best.residuals))


def _few(problem: Problem, places: Places) -> bool:
    count = sum(out.size for out in places)
    return 0 < count <= SHARE * problem.t.size


def _without(problem: Problem, places: Places) -> Problem:
    data = []
    for m, out in zip(problem.data, places, strict=True):
        kept = np.ones(len(m), dtype=bool)
        kept[out] = False
        data.append(m.taken(kept))
    return problem.with_data(data)


def _alone(problem: Problem, pool: Pool) -> list[Minimum]:
    """Return minima of the sensors that give a motion of their own, each alone."""
    found = []
    for m in problem.data if len(problem.data) > 1 else ():
        if not isinstance(m, (Attitudes, Axis, Direction, Rates)) or len(m) < 8 or m.own:
            continue
        one = problem.with_data([m])
        for start in pool.found[:STARTS]:
            found.append(minimise(one, start.state, most=100))
    return found


def search(problem: Problem, pool: Pool) -> tuple[Problem, Minimum, Places] | None:
    """Return the other samples, the minimum for them, and the outliers; None where that does not fit either."""
    best: tuple[Problem, Minimum, Places] | None = None
    for start in [*pool.found[:STARTS], *_alone(problem, pool)]:
        try:
            found = minimise(problem, start.state, loss="soft_l1", most=200)
            places = find_outliers(problem, found.residuals)
            for _ in range(ROUNDS):
                if not _few(problem, places):
                    break
                kept = _without(problem, places)
                here = minimise(kept, found.state, most=200)
                now = find_outliers(problem, problem.residuals(here.state))
                if all(np.array_equal(a, b) for a, b in zip(now, places, strict=True)):
                    fewer = best is None or here.residuals.size > best[1].residuals.size
                    if 2 * here.cost <= limit(kept) and fewer:
                        best = kept, here, places
                    break
                found, places = here, now
        except IntegrationFailure:
            continue
    return best
