"""The searches for the start of a fit of a free body, in their order."""

from __future__ import annotations

import numpy as np

from ..measured import Attitudes, Axis, Direction, Measurement, Rates
from . import curves, robust, rotations, sparse
from .candidates import Pool, limit
from .least_squares import Minimum, minimise
from .problem import Problem, State, ratios_of
from .rotations import Array
from .start import from_rates, grow, search, wahba

STARTS = 12     # other ratios that are tried where the linear start does not fit
THIN = 8.0      # log of a ratio of second moments beyond which other ratios are tried too
SPANS = (0.1, 0.2, 0.4, 0.7, 1.0)   # growing windows, of the whole span
GROWTH = 1.5    # of windows from a scene
ENOUGH = 2.0    # numbers in the first window, over the parameters


def _first_attitude(problem: Problem, state: State) -> State:
    """Return the state with the start attitude that fits the vectors and attitudes best."""
    pairs = []
    for m in problem.data:
        if not isinstance(m, (Attitudes, Axis, Direction)):
            continue
        motion = State(np.array([0.0, 0, 0, 1]), state.omega, state.ratios, state.axes, state.bias).motion()
        q = rotations.product(motion.at(m.t)[1], rotations.conjugate(state.axes))
        R = rotations.to_matrix(q)
        if isinstance(m, Attitudes):
            Y = rotations.to_matrix(m.y)
            pairs += [(R[None, :, :, k], Y[..., k], 1.0) for k in range(3)]
        elif isinstance(m, Axis):
            pairs.append(((R @ m.known)[None], m.y, 1.0))
        else:
            pairs.append((np.einsum("kij,kj->ki", R, m.y)[None], np.broadcast_to(m.known, m.y.shape), 1.0))
    if not pairs:
        return state
    return State(wahba(pairs)[1][0], state.omega, state.ratios, state.axes, state.bias)


def grown(problem: Problem, state: State, spans: Array, loss: str, scale: float) -> Minimum:
    """Return the minimum on all data, after windows that grow under a loss that bears outliers."""
    found, _ = grow(problem, state, spans, "soft_l1" if loss == "linear" else loss, scale)
    return minimise(problem, found.state, loss=loss, scale=scale)


def _from_rates(problem: Problem, state: State, gyro: Measurement, rng: np.random.Generator, loss: str, scale: float,
                pool: Pool) -> str:
    """Fit growing windows from the linear start, and from other ratios where that does not fit."""
    ratios, axes = state.ratios, state.axes
    if "inertia" in problem.slices:
        moments, axes = from_rates(gyro.t, gyro.y, "axes" in problem.slices)
        ratios = ratios_of(moments, 0.02)
    omega = state.omega
    if "omega" in problem.slices:
        omega = gyro.y[np.argmin(np.abs(gyro.t))]
    first = State(state.attitude, omega, ratios, axes, state.bias)
    if "attitude" in problem.slices:
        first = _first_attitude(problem, first)
    spans = np.quantile(np.abs(gyro.t), SPANS)
    found = grown(problem, first, spans, loss, scale)
    pool.add(found)
    how = "a linear start from the rates and growing windows"
    if (pool.fits and np.abs(found.state.ratios).max() < THIN) or "inertia" not in problem.slices:
        return how
    if sparse.is_coarse(gyro):
        return how
    for _ in range(STARTS):   # other ratios, the same windows
        P = rng.uniform(0.1, 1, 3) ** 2
        other = State(first.attitude, first.omega, ratios_of(P.sum() - P), axes, state.bias)
        other_found = grown(problem, other, spans, loss, scale)
        pool.add(other_found)
        if other_found.cost < 0.999 * found.cost:
            found, how = other_found, "growing windows from ratios at random"
    return how


def search_free(problem: Problem, state: State, rng: np.random.Generator, loss: str, scale: float, pool: Pool,
                fastest: float | None) -> str:
    """Fill the pool with minima of linear starts and of scans, and say in words how the best was found."""
    how = ""
    rates = [m for m in problem.data if isinstance(m, Rates) and len(m) >= 8]
    if rates:
        gyro = max(rates, key=len)
        how = _from_rates(problem, state, gyro, rng, loss, scale, pool)
        before = pool.best
        if "inertia" in problem.slices and "axes" not in problem.slices and sparse.is_coarse(gyro):
            sparse.search_rates(problem, state, gyro, pool, loss, scale)
            if pool.best is not before:
                how = "the nutation's frequency in the rates"
        if pool.fits or not any(isinstance(m, (Attitudes, Axis, Direction)) for m in problem.data):
            return how
    if float(np.abs(problem.t).max()) == 0:
        return how
    for kind in sparse.SCANS:
        if any(isinstance(m, kind) for m in problem.data) and {"omega", "attitude"} <= set(problem.slices):
            sparse.search_lines(problem, state, kind, pool, loss, scale, fastest)
            if robust.fits(problem, pool, loss):
                return "the frequencies of nutation and precession"
    if curves.suits(problem):
        curves.search_light(problem, state, pool, loss, scale, fastest)
        if pool.found:
            return "the two frequencies of a light curve"
    return how


def from_scene(problem: Problem, state: State, loss: str, scale: float, low: Array | None, high: Array | None,
               ) -> Minimum:
    """Return the better of two minima: from the scene's values with all data at once, and with windows that grow."""
    at_once = minimise(problem, state, loss=loss, scale=scale, low=low, high=high, most=1000)
    if loss == "linear" and 2 * at_once.cost <= limit(problem):
        return at_once
    spans = np.unique(np.abs(problem.t))
    first = int(ENOUGH * len(problem.names) * len(spans) / max(at_once.residuals.size, 1)) + 2
    span = spans[min(first, len(spans) - 1)]
    while span < spans[-1]:
        window = problem.with_data([part for m in problem.data if len(part := m.part(span)) or m.bias])
        state = minimise(window, state, loss=loss, scale=scale, low=low, high=high, most=40, tolerance=1e-4).state
        span *= GROWTH
    grown_up = minimise(problem, state, loss=loss, scale=scale, low=low, high=high, most=1000)
    return min(at_once, grown_up, key=lambda one: one.cost)


def search_at_random(problem: Problem, state: State, rng: np.random.Generator, loss: str, scale: float, pool: Pool,
                     how: str) -> str:
    """Fill the pool from motions at random where the scans found none that fits; rates have their own starts."""
    if float(np.abs(problem.t).max()) == 0 or all(isinstance(m, Rates) for m in problem.data):
        return how
    if curves.suits(problem):   # its scans are all there is: a search at random takes minutes
        return how or "nothing: no body with the frequencies of the light curve fits"
    before = pool.best
    search(problem, state, rng, loss, scale, pool)
    if pool.fits or pool.best is not before:
        return "a search through motions at random"
    return how or "nothing: the search found no motion that fits"
