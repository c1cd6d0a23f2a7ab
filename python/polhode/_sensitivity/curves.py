"""Where a fit of a light curve starts: bodies of two frequencies, ranked by all samples, then fitted."""

from __future__ import annotations

import itertools

import numpy as np

from .._batch.closed_forms import free_motion
from .._spectrum import light
from ..measured import Brightness, Scalar
from .candidates import WITHIN, Pool
from .least_squares import minimise
from .problem import Problem, State, ratios_of

FEW = 60           # samples below which there are too few for the lines
RANKED = 400       # bodies whose cost is computed with the full light
THIN = 100         # samples for that, about
FITTED = 40        # of them that are fitted
SHORT = 12         # evaluations of a first fit
FOLLOWED = 12      # first fits that are followed, each another body
NEAR = 3.0         # cost over the best one's beyond which a first fit is not followed
SPARE = 0.2        # of the limit of chi2, by which the cheaper model may be wrong
ALL = tuple(itertools.permutations(range(3)))


def orders_of(data: Brightness | Scalar) -> list[tuple[tuple[light.Order, ...], tuple[light.Order, ...]]]:
    """Return the labels that are tried: those of a body of even density first, where its axes are known; then all."""
    rest = (ALL, ALL)
    axes = getattr(data, "semi_axes", None)
    if axes is None:
        return [rest]
    least, middle, most = (int(k) for k in np.argsort(axes))
    return [(((most, middle, least),), ((least, middle, most),)), rest]


def suits(problem: Problem) -> bool:
    """Return whether the data are light curves alone, long enough for a spectrum, of a body that may be searched."""
    return (all(isinstance(m, (Brightness, Scalar)) for m in problem.data)
            and {"omega", "attitude"} <= set(problem.slices) and "axes" not in problem.slices
            and not problem.base.oblique and max(map(len, problem.data)) >= FEW
            and light.light_of(_longest(problem)) is not None)


def _longest(problem: Problem) -> Brightness | Scalar:
    data = max(problem.data, key=len)
    assert isinstance(data, (Brightness, Scalar))
    return data


def search_light(problem: Problem, state: State, pool: Pool, loss: str, scale: float, fastest: float | None) -> None:
    """Fill the pool with bodies of the two frequencies of a light curve."""
    data = _longest(problem)
    made = light.light_of(data)
    if made is None or not np.ptp(data.t):
        return
    samples, middle = made
    high = np.pi * len(data) / float(np.ptp(data.t)) / 2
    found = light.pairs(samples, high if fastest is None else min(high, 4 * fastest))
    rough = problem.with_data([m.rough() for m in problem.data if isinstance(m, (Brightness, Scalar))])
    for orders in orders_of(data):
        moments, omega, attitude = light.bodies(samples, found, orders, RANKED)
        if not len(omega):
            continue
        omega, attitude = free_motion(moments, omega, attitude, np.array(-middle))
        if "inertia" not in problem.slices:
            moments = np.broadcast_to(state.moments, moments.shape)
        costs = np.zeros(len(omega))
        for m in (part.taken(slice(None, None, len(part) // THIN + 1)) for part in rough.data):
            assert isinstance(m, (Brightness, Scalar))
            costs += m.costs(free_motion(moments[:, None], omega[:, None], attitude[:, None], m.t, want="attitude"))
        tried = Pool(rough, 1e300)
        for k in np.argsort(costs, kind="stable")[:FITTED]:
            start = State(attitude[k], omega[k], ratios_of(moments[k], 1e-3), state.axes, state.bias)
            tried.add(minimise(rough, start, loss=loss, scale=scale, most=SHORT, tolerance=1e-2))
        ends = Pool(rough, WITHIN + SPARE * pool.limit)
        for one in tried.found[:FOLLOWED]:
            if one.cost <= NEAR * max(tried.found[0].cost, 0.5 * pool.limit):
                ends.add(minimise(rough, one.state, loss=loss, scale=scale, most=100))
        for one in ends.found:
            pool.add(minimise(problem, one.state, loss=loss, scale=scale, most=100))
        if pool.fits:
            return
