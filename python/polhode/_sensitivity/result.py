"""What a fit found, and how sure it is."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np

from .._attitude.rotation import Rotation
from .._core import InertiaTensor
from .._scene.scene import Scene
from ..measured import Axis, Rates, Scalar
from . import robust, rotations
from .candidates import Candidate, Pool, aliases
from .driven_problem import DrivenState
from .least_squares import Minimum
from .problem import Problem, State
from .rotations import Array

if TYPE_CHECKING:
    import numpy.typing as npt
    from matplotlib.figure import Figure

HIDDEN = 1e-10     # a singular value below this part of the largest is not observable
FREE = 0.999       # of the square of a parameter's share in directions that are not observable: it is free itself


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Prediction:
    """A fitted motion at some times with its covariance.

    Attributes
    ----------
    t : ndarray, shape (n,)
        Times [s].
    omega : ndarray, shape (n, 3)
        In body axes [rad/s].
    attitude : ndarray, shape (n, 4)
        Body to space, (x, y, z, w).
    cov_omega, cov_attitude : ndarray, shape (n, 3, 3)
        Covariances of omega in body axes and of the small rotation in space axes [rad^2].
    spread : ndarray, shape (n,)
        The largest standard deviation of the attitude [rad]. Above about 1 the attitude is unknown.
    """

    t: Array
    omega: Array
    attitude: Array
    cov_omega: Array
    cov_attitude: Array

    @property
    def spread(self) -> Array:
        """The largest standard deviation of the attitude [rad]."""
        out: Array = np.sqrt(np.maximum(np.linalg.eigvalsh(self.cov_attitude)[..., -1], 0))
        return out

    def unknown_after(self, limit: float = 1.0) -> float:
        """Return the first of the times at which the spread exceeds `limit`; inf if none does."""
        beyond = np.flatnonzero(self.spread > limit)
        return float(self.t[beyond[0]]) if beyond.size else float("inf")


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class FitResult:
    """The result of :func:`polhode.fit`, with SciPy's names.

    Attributes
    ----------
    x : ndarray, shape (p,)
        The parameters in the order of `parameters`: rotation vectors of the start attitude and of the axes, omega,
        log(P1 / P3) and log(P2 / P3) of the second moments of mass, biases.
    cost : float
        Half the sum of the loss of the residuals over sigma.
    fun, jac : ndarray
        Residuals over sigma, shape (m,), and their derivatives by steps of the parameters, shape (m, p).
    nfev, status, message, success
        As for SciPy's `least_squares`. `success` is False where chi2 is above dof + 4 sqrt(2 dof), without outliers.
    omega : ndarray, shape (3,)
        Angular velocity at t = 0, body axes [rad/s].
    attitude : Rotation
        Attitude at t = 0, body to space.
    inertia : ndarray, shape (3,), or InertiaTensor
        As :class:`FreeMotion` takes it; the largest moment is 1, or that of the scene. A tensor where axes were fitted.
    moments : ndarray, shape (3,)
        The moments of `inertia`: about the body axes in their order, or of a tensor the principal ones, ascending.
    cov, stderr, correlation
        Of the parameters; small rotations stand for attitude and axes. Where a combination of numbers of one kind is
        not observable, as a turn about one line, they are those of what is across it. What is not observable has inf.
    chi2, dof : float, int
        The sum of squared residuals over sigma, and how many independent numbers exceed the parameters.
    candidates : tuple of Candidate
        The minima that were met with a chi2 within 25 of the best, which is the first: `omega`, `inertia`, the periods
        `nutation` and `precession` [s], and `chi2`.
    unobservable, twins : tuple of str
        In words: what these data cannot tell, and which other bodies fit as well.
    left_out : int
        Samples with a NaN.
    outliers : tuple of ndarray
        The places of outliers in the arrays of each measurement, empty where all samples were fitted. Under
        loss='linear' they were left out, and `fun`, `chi2` and `dof` are without them.
    numbers : dict
        The fitted numbers of torques and rotors, by their names.
    scene : Scene
        What was fitted, with the times of the data.
    problem : object
        `problem.fun` and `problem.jac` for SciPy's `least_squares`, from problem.base.
    """

    x: Array
    cost: float
    fun: Array
    jac: Array
    nfev: int
    status: int
    message: str
    success: bool
    omega: Array
    attitude: Rotation
    inertia: Array | InertiaTensor
    cov: Array
    stderr: Array
    correlation: Array
    parameters: tuple[str, ...]
    chi2: float
    dof: int
    candidates: tuple[Candidate, ...]
    unobservable: tuple[str, ...]
    twins: tuple[str, ...]
    left_out: int
    outliers: tuple[npt.NDArray[np.intp], ...]
    bias: Array
    scene: Scene
    problem: Problem
    state: State
    numbers: dict[str, Array]

    @property
    def moments(self) -> Array:
        """The moments of `inertia`."""
        return np.asarray(self.inertia.moments if isinstance(self.inertia, InertiaTensor) else self.inertia)

    def predict(self, t: npt.ArrayLike) -> Prediction:
        """Return the fitted motion with its covariance at times t, shape (n,)."""
        times = np.atleast_1d(np.asarray(t, dtype=float))
        problem = self.problem.with_data([], self.state)
        problem.t = times
        omega, attitude, d_omega, d_attitude = problem.columns(self.state)
        cov = np.where(np.isfinite(self.cov), self.cov, 0.0)[: len(problem.names), : len(problem.names)]
        return Prediction(times, omega, attitude, d_omega @ cov @ d_omega.transpose(0, 2, 1),
                          d_attitude @ cov @ d_attitude.transpose(0, 2, 1))

    def plot(self) -> Figure:
        """Draw the motion over the data, the residuals, the correlations and the spread of the prediction."""
        from .._plot.fit import draw

        return draw(self)

    def _repr_html_(self) -> str:
        from .._plot.tables import of_fit

        return of_fit(self)

    def interval(self, level: float = 1.96) -> dict[str, tuple[float, float]]:
        """Return value - level stderr and value + level stderr of each parameter."""
        return {name: (float(v - level * s), float(v + level * s))
                for name, v, s in zip(self.parameters, self.x, self.stderr, strict=True)}

    def _moments(self) -> list[str]:
        """Return the moments over the largest with their standard errors, in words."""
        if isinstance(self.state, DrivenState) or "inertia" not in self.problem.slices:
            return []
        here = self.problem.slices["inertia"]
        moments, errors = self.state.moments, moment_errors(self.state.ratios, self.cov[here, here])
        parts = ", ".join(f"{v:.6g} +- {e:.2g}" for v, e in zip(moments / moments.max(), errors, strict=True))
        return [f"  moments over the largest: {parts}"]

    def __repr__(self) -> str:
        lines = [f"FitResult: {self.message}", f"  chi2 {self.chi2:.6g} for {self.dof} degrees of freedom"]
        lines += [f"  {name} = {value:.9g} +- {error:.2g}"
                  for name, value, error in zip(self.parameters, self.x, self.stderr, strict=True)]
        lines += self._moments()
        for one in self.candidates[:10] if len(self.candidates) > 1 else ():
            moments = ", ".join(f"{v:.4g}" for v in one.inertia)
            lines.append(f"  candidate: moments {moments}, periods {one.nutation:.6g} s and {one.precession:.6g} s, "
                         f"chi2 {one.chi2:.6g}")
        lines += [f"  not observable: {text}" for text in self.unobservable]
        lines += [f"  twin: {text}" for text in self.twins]
        return "\n".join(lines)


def moment_errors(ratios: Array, cov: Array) -> Array:
    """Return the standard errors of the moments over the largest, from the covariance of log(P1 / P3), log(P2 / P3)."""
    if not np.isfinite(cov).all():
        return np.full(3, np.inf)
    a, b = np.exp(np.clip(ratios, -80, 80))
    J, d = np.array([b + 1, a + 1, a + b]), np.array([[0, b], [a, 0], [a, b]])
    k = int(J.argmax())
    rows = d / J[k] - np.outer(J, d[k]) / J[k] ** 2
    out: Array = np.sqrt(np.maximum(np.einsum("ki,ij,kj->k", rows, cov, rows), 0))
    return out


def covariance(jacobian: Array, names: tuple[str, ...]) -> tuple[Array, list[str]]:
    """Return the covariance from the singular values of the column-scaled Jacobian, and what it does not see.

    Where a direction within numbers of one kind is not seen, as a turn about one line, the covariance is that of the
    components across it. Numbers of several kinds that are not seen together have the variance inf.
    """
    count = jacobian.shape[1]
    size = np.linalg.norm(jacobian, axis=0)
    hidden = [f"{name}: the data do not depend on it" for name, s in zip(names, size, strict=True) if s == 0]
    seen = np.flatnonzero(size > 0)
    cov = np.zeros((count, count))
    cov[size == 0, size == 0] = np.inf
    if not seen.size:
        return cov, hidden
    _, values, right = np.linalg.svd(jacobian[:, seen] / size[seen], full_matrices=False)
    keep = values > HIDDEN * values[0]
    inverse = right[keep].T / values[keep] / size[seen][:, None]
    found = inverse @ inverse.T
    for row in right[~keep]:
        direction = row / size[seen]
        direction /= np.linalg.norm(direction)
        involved = np.flatnonzero(np.abs(row) > 0.05)
        text = "a combination of " + ", ".join(names[k] for k in seen[involved])
        free = np.abs(row) > 0.05
        if len({names[k].rsplit("_", 1)[0] for k in seen[involved]}) == 1:   # of one kind, with one unit
            across = np.eye(seen.size) - np.outer(direction, direction)
            found = across @ found @ across
            free = direction**2 > FREE
            parts = " ".join(f"{direction[k]:+.3g} {names[seen[k]]}" for k in involved)
            text += f": {parts.removeprefix('+')}; the standard errors are those of what is across it"
        hidden.append(text)
        found[free], found[:, free] = 0.0, 0.0
        found[free, free] = np.inf
    cov[np.ix_(seen, seen)] = found
    return cov, hidden


def _find_twins(problem: Problem, moments: Array) -> tuple[str, ...]:
    kinds = {type(m) for m in problem.data}
    found = []
    if kinds == {Axis} and "inertia" in problem.slices:
        axis = np.asarray(problem.data[0].known) if isinstance(problem.data[0], Axis) else np.zeros(3)
        if np.count_nonzero(axis) == 1:
            one, other = (str(k + 1) for k in range(3) if not axis[k])
            found.append(f"axis {int(np.argmax(np.abs(axis))) + 1} alone is seen: the body with moments {one} and "
                         f"{other} exchanged, and each turned by half a turn or a quarter about that axis, fit as well")
    if kinds == {Scalar}:
        found.append("a scalar does not tell a motion from its image under the symmetries of the function")
    if "axes" in problem.slices:
        found.append("the principal axes may be relabelled and reversed: the tensor is the same")
    return tuple(found)


def _symmetry(problem: Problem, state: State, cov: Array) -> list[str]:
    """Say which two moments do not differ beyond two standard deviations."""
    if "inertia" not in problem.slices:
        return []
    here = problem.slices["inertia"]
    found = []
    for pair, direction in (("1 and 2", (1, -1)), ("1 and 3", (1, 0)), ("2 and 3", (0, 1))):
        d = np.array(direction)   # J1 = J3 where log(P1 / P3) = 0, and so on
        if abs(d @ state.ratios) <= 2 * np.sqrt(d @ cov[here, here] @ d):
            found.append(f"whether moments {pair} differ; the directions of their axes in a symmetric body")
    return found


def make_result(problem: Problem, found: Minimum, scene: Scene | None, largest: float, how: str, pool: Pool,
                whole: Problem | None = None, places: robust.Places = ()) -> FitResult:
    """Make the result from a minimum; `places` are outliers of the `whole` problem."""
    state = found.state
    cov, hidden = covariance(found.jacobian, problem.names)
    stderr = np.sqrt(np.diag(cov))
    sized = np.where(np.isfinite(stderr) & (stderr > 0), stderr, 1.0)
    correlation = np.where(np.isfinite(cov), cov, 0.0) / sized / sized[:, None]
    np.fill_diagonal(correlation, 1.0)
    moments = state.moments / state.moments.max() * largest
    E = rotations.to_matrix(state.axes)
    oblique = "axes" in problem.slices or bool(np.abs(state.axes[:3]).any())
    inertia: Any = InertiaTensor(E @ np.diag(moments) @ E.T, physical=False) if oblique else moments
    unobservable = [] if scene is not None else ["the scale of the inertia: a free motion does not depend on it"]
    if "attitude" in problem.slices and all(isinstance(m, Rates) for m in problem.data):
        hidden = [text for text in hidden if not text.startswith("attitude")]
        hidden.insert(0, "the attitude: rates alone do not depend on it")
    if not isinstance(state, DrivenState):
        hidden += _symmetry(problem, state, cov)
    x = np.zeros(len(problem.names))
    for group, value in state.values().items():
        if group in problem.slices:
            x[problem.slices[group]] = value
    chi2 = float(found.residuals @ found.residuals)
    dof = sum(m.independent for m in problem.data) - len(problem.names)
    good = chi2 <= pool.limit
    if whole is problem and not good:   # a loss that bears outliers
        good = robust.fits_without(problem, found.residuals, places)
    left_out = sum(m.left_out for m in problem.data)
    message = ("converged" if found.status else "the most evaluations were made") + f"; the start was {how}"
    if not good:
        message = f"chi2 is {chi2 / max(dof, 1):.3g} for each degree of freedom: the model does not fit; {message}"
    if whole is not None and any(out.size for out in places):
        count = sum(out.size for out in places)
        if good:
            message = f"fits without {count} outliers: {robust.in_words(whole, places)}; {message}"
    if left_out:
        message += f"; {left_out} samples were left out as NaN"
    named = tuple(m.index[out] for m, out in zip(whole.data, places, strict=True)) if whole else ()
    attitude = Rotation.from_quat(state.attitude)
    times = np.unique(problem.t)
    if isinstance(state, DrivenState):
        scene_out = state.make_scene(times, "inertia" in problem.slices)
        inertia, numbers = state.moments, {group: state.numbers[group] for group in state.numbers}
    else:
        scene_out = Scene(inertia=inertia if oblique else tuple(moments), omega=tuple(state.omega),
                          attitude=attitude, times=times, name=scene.name if scene is not None else "fit")
        numbers = {}
    return FitResult(x, found.cost, found.residuals, found.jacobian, found.nfev, found.status, message,
                     bool(found.status > 0 and good), state.omega, attitude, inertia, cov, stderr, correlation,
                     problem.names, chi2, dof, pool.candidates(), tuple(unobservable + hidden),
                     _find_twins(problem, moments) + aliases(problem, pool), left_out,
                     named, state.bias, scene_out, problem.with_data(problem.data, state), state, numbers)
