"""Levenberg and Marquardt's method for the parameters of a rotating body, with losses as SciPy's."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np

from .._core import IntegrationFailure, InvalidInput
from .rotations import Array

if TYPE_CHECKING:
    from .problem import Problem, State

LOSSES = ("linear", "soft_l1", "huber", "cauchy")
PATIENT = 25    # steps after which a slow way along a flat valley may end
LAST = 10       # steps that gained less than LITTLE together: some hundredths of a standard deviation are left
LITTLE = 1e-3


def rho(squares: Array, loss: str) -> tuple[Array, Array, Array]:
    """Return a loss of z = (residual / f_scale)^2 and its two derivatives."""
    z = squares
    if loss == "soft_l1":
        root = np.sqrt(1 + z)
        return 2 * (root - 1), 1 / root, -0.5 / root**3
    if loss == "huber":
        far = z > 1
        root = np.sqrt(np.where(far, z, 1.0))
        return np.where(far, 2 * root - 1, z), np.where(far, 1 / root, 1.0), np.where(far, -0.5 / root**3, 0.0)
    if loss == "cauchy":
        return np.log1p(z), 1 / (1 + z), -1 / (1 + z) ** 2
    return z, np.ones_like(z), np.zeros_like(z)


def cost_of(residuals: Array, loss: str, scale: float) -> float:
    """Half the sum of the loss."""
    if loss == "linear":
        return 0.5 * float(residuals @ residuals)
    return 0.5 * scale**2 * float(rho((residuals / scale) ** 2, loss)[0].sum())


def weighted(residuals: Array, jacobian: Array, loss: str, scale: float) -> tuple[Array, Array]:
    """Return residuals and Jacobian whose Gauss-Newton step is that of the loss (Triggs et al. 2000)."""
    if loss == "linear":
        return residuals, jacobian
    _, first, second = rho((residuals / scale) ** 2, loss)
    size = np.sqrt(np.maximum(first + 2 * second * (residuals / scale) ** 2, np.finfo(float).eps))
    return residuals * first / size, jacobian * size[:, None]


@dataclasses.dataclass
class Minimum:
    """Where the method stopped."""

    state: State
    cost: float
    residuals: Array
    jacobian: Array
    nfev: int
    status: int


def minimise(problem: Problem, state: State, *, loss: str = "linear", scale: float = 1.0, most: int = 60,
             low: Array | None = None, high: Array | None = None, tolerance: float = 1e-8) -> Minimum:
    """Find a minimum from a start. `low` and `high` bound the parameters that are no rotations, as values."""
    if low is not None and high is not None:
        now = values_of(problem, state)
        state = state.displaced(np.where(np.isnan(now), 0.0, np.clip(now, low, high) - now), problem.slices)
    residuals, jacobian = problem.residuals_and_jacobian(state)
    cost, nfev, damping, status = cost_of(residuals, loss, scale), 1, 1e-4, 0
    costs = [cost]
    while nfev < most:
        r, J = weighted(residuals, jacobian, loss, scale)
        normal, gradient = J.T @ J, J.T @ r
        size = np.sqrt(np.maximum(np.diag(normal), 1e-300))
        normal, gradient = normal / size / size[:, None], gradient / size
        if np.abs(gradient).max(initial=0.0) <= 1e-14 * max(np.sqrt(2 * cost), 1e-300):
            status = 1
            break
        accepted = False
        while nfev < most and damping < 1e14:
            if low is None or high is None:
                step = np.linalg.solve(normal + damping * np.eye(len(size)), -gradient) / size
            else:
                now = values_of(problem, state)
                step = bounded_step(normal + damping * np.eye(len(size)), gradient, (low - now) * size,
                                    (high - now) * size) / size
            other = state.displaced(step, problem.slices)
            nfev += 1
            try:
                tried = problem.residuals_and_jacobian(other)
                trial = cost_of(tried[0], loss, scale)
            except (IntegrationFailure, InvalidInput):   # too far: no such motion
                trial = np.inf
            if trial <= cost:
                accepted = True
                break
            damping *= 8
        if not accepted:
            status = 2
            break
        gain = cost - trial
        state, cost, damping = other, trial, max(damping / 10, 1e-12)
        residuals, jacobian = tried
        costs.append(cost)
        if len(costs) > PATIENT and costs[-1 - LAST] - cost < LITTLE:
            status = 2
            break
        if gain <= tolerance * cost or np.abs(step * size).max() <= 1e-9:
            status = 2
            break
    return Minimum(state, cost, residuals, jacobian, nfev, status)


def values_of(problem: Problem, state: State) -> Array:
    """Return the parameters as numbers; rotations as NaN."""
    out = np.full(len(problem.names), np.nan)
    for group, value in state.values().items():
        if group in problem.slices and group not in ("attitude", "axes"):
            out[problem.slices[group]] = value
    return out


def bounded_step(normal: Array, gradient: Array, low: Array, high: Array) -> Array:
    """Return the step of Newton's equations within bounds: those that it would leave are fixed there, one by one."""
    step, free = np.zeros(len(gradient)), np.ones(len(gradient), dtype=bool)
    for _ in range(len(gradient)):
        rest = gradient + normal[:, ~free] @ step[~free]
        step[free] = np.linalg.solve(normal[np.ix_(free, free)], -rest[free])
        beyond = np.fmax(np.where(free, low - step, 0), np.where(free, step - high, 0))   # NaN: no bound
        worst = int(np.argmax(beyond))
        if not beyond[worst] > 0:
            return step
        step[worst], free[worst] = low[worst] if step[worst] < low[worst] else high[worst], False
        if not free.any():
            break
    return step
