"""Where a fit of sparse data starts: candidates from two frequencies, ranked by all data, then fitted."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from .._spectrum import attitudes, axis, direction, rates
from ..measured import Attitudes, Axis, Direction, Measurement, Rates
from . import robust
from .candidates import WITHIN, Pool, in_one_valley, lattice
from .least_squares import minimise
from .problem import Problem, State, ratios_of
from .rotations import Array
from .start import costs_of

FITTED = 8         # candidates of a nutation that are fitted at most
NEAR = 4.0         # cost over the best one's beyond which a candidate is not fitted
FIRST = 40 * np.pi   # over the span: the rates of the first scan; each next one has four times as many
USUAL = 0.2       # of the median cost: where the best is above it, none is near
SHORT = 8          # evaluations of a first fit
WORK = 6e6         # samples times trials of the last scan
THIN = 200         # samples of a scan, at most


def thinned(data: Measurement, rng: np.random.Generator) -> Measurement:
    """Return at most THIN of the samples, at random."""
    if len(data) <= THIN:
        return data
    chosen = np.sort(rng.choice(len(data), THIN, replace=False))
    return data.taken(chosen)


def top_rate(t: Array, most: float) -> float:
    """Return the largest rate of the last scan: for times of a lattice three quarters of a turn in their spacing."""
    spacing = float(np.ptp(t)) / max(t.size - 1, 1)
    if lattice(t):
        return 1.5 * np.pi / spacing
    samples = min(t.size, THIN)
    return float(np.clip(0.8 * WORK / samples / np.ptp(t), 6 * np.pi / spacing, 2 * np.pi * most / spacing))


def _scans(t: Array, highest: float) -> Iterator[float]:
    rate = FIRST / float(np.ptp(t))
    while rate < highest:
        yield rate
        rate *= 4
    yield highest


def _fit(problem: Problem, state: State, moments: Array, omega: Array, pool: Pool, loss: str, scale: float,
         far: float = 0.0) -> None:
    """Fit the bodies that are the nearest to the data; `far` is the cost of one that has nothing to do with them."""
    rng = np.random.default_rng(0)
    if not len(omega):
        return
    if "inertia" not in problem.slices:
        moments = np.broadcast_to(state.moments, moments.shape)
    costs, attitude = costs_of(problem.data, omega, moments, np.inf, rng)
    usual = max(far, float(np.median(costs))) if len(costs) >= 4 else np.inf
    if costs.min() > USUAL * usual:
        return
    tried = []
    for k in np.argsort(costs, kind="stable")[:FITTED]:
        if costs[k] > NEAR * costs.min():
            break
        start = State(attitude[k], omega[k], ratios_of(moments[k]), state.axes, state.bias)
        tried.append(minimise(problem, start, loss=loss, scale=scale, most=SHORT, tolerance=1e-2))
    least = min(one.cost for one in tried)
    span = float(np.ptp(problem.t))
    for one in sorted(tried, key=lambda one: one.cost):
        if any(in_one_valley(one.state, other.state, span) for other in pool.found if pool.fits):
            continue
        if one.cost <= NEAR * max(least, 0.5 * pool.limit) and one.cost < max(30 * pool.limit, 0.02 * usual):
            pool.add(minimise(problem, one.state, loss=loss, scale=scale, most=300))


# of a kind: the least samples, and the turns in the mean spacing of samples at random times of the last scan
SCANS: dict[type[Measurement], tuple[Callable[..., Iterator[tuple[float, Array, Array]]], int, float]] = {
    Attitudes: (attitudes.candidates, 8, 96.0),
    Axis: (axis.candidates, 16, 12.0),
    Direction: (direction.candidates, 16, 12.0),
}


def search_lines(problem: Problem, state: State, kind: type[Measurement], pool: Pool, loss: str, scale: float,
                 fastest: float | None) -> None:
    """Fill the pool from the sensor of a kind that was read most often."""
    candidates, few_samples, most = SCANS[kind]
    data = max((m for m in problem.data if isinstance(m, kind)), key=len)
    if len(data) < few_samples or not np.ptp(data.t):
        return
    few = thinned(data, np.random.default_rng(1))
    highest = fastest if fastest is not None else top_rate(data.t, most)
    low = 0.3 / float(np.ptp(data.t))
    # bodies of one frequency are all near; vectors at random differ by sqrt(2) from the data, about
    far = 0.0
    if isinstance(data, (Axis, Direction)):
        far = 0.7 * float((data.whitener[:, 0, 0] ** 2).sum()) * float(data.known @ data.known)
    for high in _scans(data.t, highest):
        for top in attitudes.HARMONICS:
            if 3 * len(few) < 4 * top + 6:
                break
            least = np.inf
            for left, moments, omega in candidates(few, low, high, top):
                best = pool.best
                least = min(least, left)   # the series of harmonics are cut off: it may be above chi2
                if pool.fits and best is not None and left > least + 2 * best.cost + WITHIN:
                    break
                _fit(problem, state, moments, omega, pool, loss, scale, far)
            if pool.fits and (high >= 1.5 * np.pi * len(data) / np.ptp(data.t) or not lattice(data.t)):
                return
        if robust.fits(problem, pool, loss):   # faster bodies need not be tried for the sake of some wrong samples
            return


def is_coarse(gyro: Measurement) -> bool:
    """Return whether the body turns by half a turn or more between samples: another one may fit them too."""
    spacing = float(np.ptp(gyro.t)) / max(len(gyro) - 1, 1)
    return bool(np.linalg.norm(gyro.y, axis=1).max() * spacing > 0.9 * np.pi)


def search_rates(problem: Problem, state: State, gyro: Measurement, pool: Pool, loss: str, scale: float) -> None:
    """Fill the pool from the nutation's frequencies that the rates allow."""
    assert isinstance(gyro, Rates)
    few = thinned(gyro, np.random.default_rng(1))
    assert isinstance(few, Rates)
    for top in attitudes.HARMONICS:
        least = np.inf
        for left, moments, omega in rates.candidates(few, 0.3 / float(np.ptp(gyro.t)), top):
            best = pool.best
            least = min(least, left)
            if pool.fits and best is not None and left > least + 2 * best.cost + WITHIN:
                break
            _fit(problem, state, moments, omega, pool, loss, scale)
        if pool.fits:
            return
