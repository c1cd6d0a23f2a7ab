"""The minima that a fit met: which of them fit as well as the best."""

from __future__ import annotations

import dataclasses

import numpy as np

from .._core import InvalidInput
from .least_squares import Minimum
from .problem import Problem, State
from .rotations import Array

WITHIN = 25.0    # of the best chi2: five standard deviations
LIMIT = 4.0      # standard deviations of chi2 above its mean that a motion that fits may have


def limit(problem: Problem) -> float:
    """Return the chi2 up to which a motion fits: dof + 4 sqrt(2 dof)."""
    dof = max(sum(m.independent for m in problem.data) - len(problem.names), 1)
    return dof + LIMIT * float((2 * dof) ** 0.5)


@dataclasses.dataclass(frozen=True, eq=False)
class Candidate:
    """A body that fits about as well as the best.

    Attributes
    ----------
    omega : ndarray, shape (3,)
        Angular velocity at t = 0, body axes [rad/s].
    inertia : ndarray, shape (3,)
        Principal moments; the largest is 1.
    nutation, precession : float
        Periods [s]: of omega in the body, and of the mean rotation about the angular momentum. inf where there is none.
    chi2 : float
        The sum of squared residuals over sigma.
    """

    omega: Array
    inertia: Array
    nutation: float
    precession: float
    chi2: float


def rates_of(state: State) -> tuple[float, float]:
    """Return the frequency of the nutation and the mean rate about the angular momentum of a free body [rad/s]."""
    if not state.free:
        return 0.0, 0.0
    try:
        motion = state.motion()
        period = abs(float(motion.period))
    except InvalidInput:
        return 0.0, 0.0
    if not 0 < period < np.inf:
        return 0.0, float(np.linalg.norm(state.omega))
    omega, J = motion.at(period * np.arange(64) / 64)[0], state.moments
    m = J * omega
    across = [k for k in range(3) if k != int(np.argmax(np.abs(m.mean(axis=0))))]   # the encircled axis is left out
    squares = m[:, across] ** 2
    about = (squares / J[across]).sum(axis=1) / np.maximum(squares.sum(axis=1), 1e-300)
    return 2 * np.pi / period, float(np.linalg.norm(m[0]) * about.mean())


class Pool:
    """Minima, each once, as long as they are near the best."""

    def __init__(self, problem: Problem, within: float = WITHIN) -> None:
        self.limit, self.within = limit(problem), within
        self.found: list[Minimum] = []

    def add(self, found: Minimum) -> None:
        """Keep a minimum, unless it is known."""
        for k, other in enumerate(self.found):
            if _same(found.state, other.state):
                if found.cost < other.cost:
                    self.found[k] = found
                break
        else:
            self.found.append(found)
        self.found.sort(key=lambda one: one.cost)
        self.found = [one for one in self.found if 2 * (one.cost - self.found[0].cost) <= self.within][:64]

    @property
    def best(self) -> Minimum | None:
        """The lowest minimum."""
        return self.found[0] if self.found else None

    @property
    def fits(self) -> bool:
        """Whether the best is a motion that fits."""
        return bool(self.found) and 2 * self.found[0].cost <= self.limit

    def candidates(self) -> tuple[Candidate, ...]:
        """Return the bodies, the best first."""
        out = []
        for one in self.found:
            nutation, precession = (2 * np.pi / abs(rate) if rate else np.inf for rate in rates_of(one.state))
            moments = one.state.moments
            out.append(Candidate(one.state.omega, moments / moments.max(), nutation, precession, 2 * one.cost))
        return tuple(out)


def lattice(t: Array) -> float:
    """Return the spacing of which all times are multiples, or 0 where there is none."""
    gaps = np.diff(np.unique(t))
    if not gaps.size:
        return 0.0
    step = float(gaps.min())
    counts = gaps / step
    return step if np.abs(counts - np.round(counts)).max() < 0.01 else 0.0


def aliases(problem: Problem, pool: Pool) -> tuple[str, ...]:
    """Return the candidates of other frequencies in words, and the sampling that would tell them apart."""
    if not pool.found or not pool.found[0].state.free:
        return ()
    span, step = float(np.ptp(problem.t)), lattice(problem.t)
    best, *others = pool.found
    pair = np.array(rates_of(best.state))
    found = []
    for one in others:
        rates = np.array(rates_of(one.state))
        if span and np.abs(rates - pair).max() * span > np.pi:
            nutation, precession = 2 * np.pi / np.maximum(np.abs(rates), 1e-300)
            found.append(f"a body with periods of {nutation:.6g} s and {precession:.6g} s fits with "
                         f"chi2 {2 * one.cost:.6g}")
    shortest = 2 * np.pi / max(float(np.linalg.norm(best.state.omega)), 1e-300)
    if step and (found or 2 * step > shortest):
        found.append(f"all times are multiples of {step:.6g} s, so frequencies that differ by {2 * np.pi / step:.6g} "
                     f"rad/s may look the same: samples at random times, or {0.25 * shortest:.3g} s apart, tell "
                     "such bodies apart")
    return tuple(found)


def _same(one: State, other: State) -> bool:
    size = max(float(np.linalg.norm(one.omega)), 1e-300)
    a, b = one.moments / one.moments.max(), other.moments / other.moments.max()
    return bool(np.abs(one.omega - other.omega).max() <= 1e-3 * size and np.abs(a - b).max() <= 1e-3)


def in_one_valley(one: State, other: State, span: float) -> bool:
    """Return whether two bodies have the same frequencies over a span, and nearly the same moments."""
    a, b = one.moments / one.moments.max(), other.moments / other.moments.max()
    if np.abs(a - b).max() > 0.05:
        return False
    return bool(np.abs(np.array(rates_of(one)) - rates_of(other)).max() * span < 1)
