"""Where a fit starts: from rates by a linear problem, else by a search through many motions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from .._batch.closed_forms import free_motion
from . import rotations
from .least_squares import Minimum, minimise
from .problem import Problem, State, ratios_of
from .rotations import Array

if TYPE_CHECKING:
    from ..measured import Measurement
    from .candidates import Pool

GOOD = 4.0          # chi^2 a residual: above it a start is wrong
STAGES = ((40_000, 5), (100_000, 4), (400_000, 8), (400_000, 6))        # bodies, epochs: attitudes
AXIS_STAGES = ((100_000, 10), (300_000, 14), (400_000, 18))             # unit vectors
OTHERS = 8          # further candidates after one that fits, where there may be false minima: vectors and scalars
BLOCK = 20_000      # bodies at once: some megabytes


def from_rates(t: Array, y: Array, axes: bool) -> tuple[Array, Array]:
    """Return (moments, principal axes as a quaternion) from rates alone.

    Euler's equations integrated once, J (omega - mean) + (int omega x J omega - mean) = 0 by trapezia, are linear and
    homogeneous in J: the smallest singular vector. No derivative of the data is needed.
    """
    def integral(values: Array) -> Array:
        steps = 0.5 * (values[1:] + values[:-1]) * np.diff(t)[:, None]
        total = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(steps, axis=0)])
        out: Array = total - total.mean(axis=0)
        return out

    units = [np.diag(row) for row in np.eye(3)]
    if axes:
        for a, b in ((0, 1), (0, 2), (1, 2)):
            unit = np.zeros((3, 3))
            unit[a, b] = unit[b, a] = 1
            units.append(unit)
    columns = [((y - y.mean(axis=0)) @ unit + integral(np.cross(y, y @ unit))).ravel() for unit in units]
    _, _, right = np.linalg.svd(np.stack(columns, axis=1), full_matrices=False)
    J = np.einsum("k,kij->ij", right[-1], np.array(units))
    J = J if np.trace(J) > 0 else -J
    if not axes:
        return np.maximum(np.diag(J), 1e-3 * np.trace(J)), np.array([0.0, 0, 0, 1])
    moments, vectors = np.linalg.eigh(J)
    if np.linalg.det(vectors) < 0:
        vectors[:, 0] *= -1
    return np.maximum(moments, 1e-3 * np.trace(J)), rotations.of_matrix(vectors)


def grow(problem: Problem, state: State, spans: Sequence[float] | Array, loss: str, scale: float,
         ) -> tuple[Minimum, bool]:
    """Fit growing windows of the data, each from the last; False where one does not fit."""
    found = None
    for span in spans:
        data = [measurement.part(span) for measurement in problem.data]
        window = problem.with_data([m for m in data if len(m) or m.bias])
        if window.t.size == 0:
            continue
        found = minimise(window, state, most=40, loss=loss, scale=scale, tolerance=1e-4)
        state = found.state
        if 2 * found.cost > GOOD * max(found.residuals.size, 1) and loss == "linear":
            return found, False
    assert found is not None
    return found, True


def wahba(pairs: list[tuple[Array, Array, float]]) -> tuple[Array, Array]:
    """Return (cost, quaternion) of the best rotation Q of each body: Q x = y for pairs (x (B, k, 3), y (k, 3), weight).

    Davenport's quadratic form: the largest eigenvalue gives the cost (Davenport 1968; Wahba 1965).
    """
    B = sum(weight * np.einsum("ki,bkj->bij", y, x) for x, y, weight in pairs)
    total = sum(weight * (0.5 * (y**2).sum() + 0.5 * (x**2).sum(axis=(1, 2))) for x, y, weight in pairs)
    trace = np.trace(B, axis1=1, axis2=2)
    K = np.zeros((len(B), 4, 4))
    K[:, :3, :3] = B + B.transpose(0, 2, 1) - trace[:, None, None] * np.eye(3)
    K[:, :3, 3] = K[:, 3, :3] = np.stack([B[:, 2, 1] - B[:, 1, 2], B[:, 0, 2] - B[:, 2, 0], B[:, 1, 0] - B[:, 0, 1]],
                                         axis=1)
    K[:, 3, 3] = trace
    values, vectors = np.linalg.eigh(K)
    return total - values[:, -1], vectors[:, :, -1]


def _epochs(data: Sequence[Measurement], count: int) -> Array:
    times = np.unique(np.concatenate([m.t for m in data]))
    return times[np.argsort(np.abs(times), kind="stable")[:count]]


def costs_of(data: Sequence[Measurement], omega: Array, moments: Array, until: float, rng: np.random.Generator,
             ) -> tuple[Array, Array]:
    """Return the cost of each body's motion on the first samples, and the best start attitude."""
    from ..measured import Attitudes, Axis, Brightness, Direction, Scalar

    pairs: list[tuple[Array, Array, float]] = []
    others = []
    for measurement in data:
        part = measurement.part(until)
        if not len(part) or part.accelerates:
            continue
        weight = float(np.mean(part.whitener[:, 0, 0] ** 2))
        if isinstance(part, (Attitudes, Axis, Direction)):
            q = free_motion(moments[:, None], omega[:, None], (0, 0, 0, 1), part.t, want="attitude")
            R = rotations.to_matrix(q)
            if isinstance(part, Attitudes):
                Y = rotations.to_matrix(part.y)
                pairs += [(R[..., k], Y[..., k], weight) for k in range(3)]
            elif isinstance(part, Axis):
                pairs.append((R @ part.known, part.y, weight))
            else:
                pairs.append((np.einsum("bkij,kj->bki", R, part.y), np.broadcast_to(part.known, part.y.shape), weight))
        else:
            others.append(part)
    if pairs:
        costs, attitude = wahba(pairs)
    else:
        attitude = rng.normal(size=(len(omega), 4))
        attitude /= np.linalg.norm(attitude, axis=1, keepdims=True)
        costs = np.zeros(len(omega))
    for part in others:
        w, q = free_motion(moments[:, None], omega[:, None], attitude[:, None], part.t)
        if isinstance(part, (Brightness, Scalar)):
            costs += part.costs(q)
            continue
        for k in range(len(omega)):
            r = part.whiten(part.residual(w[k], q[k], np.zeros(part.bias)))
            costs[k] += 0.5 * float((r * r).sum())
    return costs, attitude


def fastest_rate(data: Sequence[Measurement]) -> float:
    """Return the largest rate that the search tries: three quarters of a turn in the mean spacing of the samples."""
    times = np.unique(np.concatenate([m.t for m in data]))
    return 1.5 * np.pi / float(np.diff(times).mean())


def fits(found: Minimum) -> bool:
    """Return whether chi^2 is what noise gives, within six of its standard deviations."""
    count = found.residuals.size
    return bool(2 * found.cost <= count + 6 * (2 * count) ** 0.5)


def search(problem: Problem, state: State, rng: np.random.Generator, loss: str, scale: float, pool: Pool) -> None:
    """Draw bodies at random, keep the best on the first epochs, and let their windows grow until one takes all data."""
    from ..measured import Attitudes

    data = problem.data
    rich = any(isinstance(m, Attitudes) for m in data)
    last = float(np.abs(problem.t).max())
    speed = fastest_rate(data)
    for bodies, epochs in STAGES if rich else AXIS_STAGES:
        chosen = np.abs(_epochs(data, epochs))
        until = float(chosen.max())
        kept: list[tuple[float, Array, Array, Array]] = []
        for _ in range(0, bodies, BLOCK):
            direction = rng.normal(size=(BLOCK, 3))
            direction /= np.linalg.norm(direction, axis=1, keepdims=True)
            omega = direction * (speed * rng.uniform(0, 1, (BLOCK, 1)))
            P = rng.uniform(0.08, 1, (BLOCK, 3)) ** 2
            if "inertia" not in problem.slices:
                moments = np.broadcast_to(state.moments, (BLOCK, 3))
            else:
                moments = P.sum(axis=1, keepdims=True) - P
            costs, attitude = costs_of(data, omega, moments, until, rng)
            for k in np.argpartition(costs, 40)[:40]:
                kept.append((float(costs[k]), omega[k], moments[k], attitude[k]))
        kept.sort(key=lambda item: item[0])
        more = OTHERS
        spans = [until]
        while spans[-1] < last:
            spans.append(min(1.5 * spans[-1], last))
        for _, omega_k, moments_k, attitude_k in kept[:60]:
            start = State(attitude_k, omega_k, ratios_of(moments_k), state.axes, state.bias)
            found, good = grow(problem, start, spans, loss, scale)
            if not good:
                continue
            found = minimise(problem, found.state, loss=loss, scale=scale)
            pool.add(found)
            more -= pool.fits
            if pool.fits and (rich or more == 0):
                return
        if pool.best is not None and 2 * pool.best.cost <= GOOD * pool.best.residuals.size:
            return
