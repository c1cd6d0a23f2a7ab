"""Where a fit of sparse data starts: candidates from two frequencies, ranked by all data, then fitted."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .._spectrum import attitudes, rates
from ..measured import Attitudes, Measurement, Rates
from .candidates import WITHIN, Pool, lattice
from .least_squares import minimise
from .problem import Problem, State, ratios_of
from .rotations import Array
from .start import costs_of

FITTED = 6         # candidates of a nutation that are fitted at most
NEAR = 4.0         # cost over the best one's beyond which a candidate is not fitted
FIRST = 40 * np.pi   # over the span: the rates of the first scan; each next one has four times as many
USUAL = 0.2       # of the median cost: where the best is above it, none is near
SHORT = 8          # evaluations of a first fit
WORK = 6e6         # samples times trials of the last scan
MOST = 96.0        # turns in the mean spacing of samples at random times: the last scan
THIN = 200         # samples of a scan, at most


def thinned(data: Measurement, rng: np.random.Generator) -> Measurement:
    """Return at most THIN of the samples, at random."""
    if len(data) <= THIN:
        return data
    chosen = np.sort(rng.choice(len(data), THIN, replace=False))
    return data.taken(chosen)


def top_rate(t: Array) -> float:
    """Return the largest rate of the last scan: for times of a lattice three quarters of a turn in their spacing."""
    spacing = float(np.ptp(t)) / max(t.size - 1, 1)
    if lattice(t):
        return 1.5 * np.pi / spacing
    samples = min(t.size, THIN)
    return float(np.clip(0.8 * WORK / samples / np.ptp(t), 6 * np.pi / spacing, 2 * np.pi * MOST / spacing))


def _scans(t: Array, highest: float) -> Iterator[float]:
    rate = FIRST / float(np.ptp(t))
    while rate < highest:
        yield rate
        rate *= 4
    yield highest


def _fit(problem: Problem, state: State, moments: Array, omega: Array, pool: Pool, loss: str, scale: float) -> None:
    """Fit the bodies that are the nearest to the data."""
    rng = np.random.default_rng(0)
    if not len(omega):
        return
    if "inertia" not in problem.slices:
        moments = np.broadcast_to(state.moments, moments.shape)
    costs, attitude = costs_of(problem.data, omega, moments, np.inf, rng)
    usual = float(np.median(costs)) if len(costs) >= 4 else np.inf
    if costs.min() > USUAL * usual:
        return
    tried = []
    for k in np.argsort(costs, kind="stable")[:FITTED]:
        if costs[k] > NEAR * costs.min():
            break
        start = State(attitude[k], omega[k], ratios_of(moments[k]), state.axes, state.bias)
        tried.append(minimise(problem, start, loss=loss, scale=scale, most=SHORT, tolerance=1e-2))
    least = min(one.cost for one in tried)
    for one in tried:
        if one.cost <= NEAR * max(least, 0.5 * pool.limit) and one.cost < max(30 * pool.limit, 0.02 * usual):
            pool.add(minimise(problem, one.state, loss=loss, scale=scale, most=300))


def search_attitudes(problem: Problem, state: State, pool: Pool, loss: str, scale: float, fastest: float | None,
                     ) -> None:
    """Fill the pool from the attitudes that were measured most often."""
    rng = np.random.default_rng(1)
    data = max((m for m in problem.data if isinstance(m, Attitudes)), key=len)
    if len(data) < 8 or not np.ptp(data.t):
        return
    few = thinned(data, rng)
    assert isinstance(few, Attitudes)
    highest = fastest if fastest is not None else top_rate(data.t)
    for top in attitudes.HARMONICS:
        if 3 * len(few) < 4 * top + 6:
            return
        low = 0.3 / float(np.ptp(data.t))
        for high in _scans(data.t, highest):
            least = np.inf
            for left, moments, omega in attitudes.candidates(few, low, high, top):
                best = pool.best
                least = min(least, left)   # the series of harmonics are cut off: it may be above chi2
                if pool.fits and best is not None and left > least + 2 * best.cost + WITHIN:
                    break
                _fit(problem, state, moments, omega, pool, loss, scale)
            if pool.fits and (high >= 1.5 * np.pi * len(data) / np.ptp(data.t) or not lattice(data.t)):
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
