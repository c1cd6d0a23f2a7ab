"""Fits of a rotating body to measurements."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .._attitude.arrays import is_one_of, is_whole, to_items, to_number
from .._core import IntegrationFailure, InvalidInput
from .._scene.scene import Scene
from ..measured import Attitudes, Measurement, Rates
from ..measured import __all__ as SENSORS
from . import robust, rotations
from .candidates import Pool
from .driven_problem import DrivenProblem, DrivenState
from .least_squares import LOSSES, Minimum, minimise
from .problem import GROUPS, Problem, State, ratios_of
from .result import FitResult, make_result
from .rotations import Array
from .start import fits
from .starts import SPANS, from_scene, grown, search_at_random, search_free


def _to_data(data: Any) -> list[Measurement]:
    found = [data] if isinstance(data, Measurement) else list(to_items(data, "data", "measurements"))
    if not found or not all(isinstance(m, Measurement) for m in found):
        names = ", ".join(name for name in SENSORS if name != "Measurement")
        raise InvalidInput(f"data: must be one or several of ph.measured.{names}")
    return found


def _to_groups(fit: str | Sequence[str], driven: bool) -> tuple[str, ...]:
    groups = (fit,) if isinstance(fit, str) else to_items(fit, "fit", "names of parameters")
    if not all(isinstance(group, str) for group in groups):
        raise InvalidInput(f"fit: must be names of parameters, got {fit!r}")
    numbers = {group for group in groups if driven and isinstance(group, str) and "." in group}
    known = set(GROUPS) - {"axes"} if driven else set(GROUPS)
    if not groups or len(set(groups)) != len(groups) or not set(groups) <= known | numbers:
        if driven:
            raise InvalidInput("fit: must be some of attitude, omega, inertia and names such as 'torques.0.weight', "
                               f"each once, got {fit!r}")
        raise InvalidInput(f"fit: must be some of {', '.join(GROUPS)}, each once, got {fit!r}")
    return groups


def _of_scene(scene: Scene | None, groups: Sequence[str], count: int) -> tuple[State, float]:
    """Return the state that a scene gives, and its largest moment."""
    bias = np.zeros(count)
    if scene is None:
        known = {"inertia", "omega"} - set(groups)
        if known:
            raise InvalidInput(f"scene: needed for {' and '.join(sorted(known))}, which `fit` does not hold")
        return State(np.array([0.0, 0, 0, 1]), np.zeros(3), np.zeros(2), np.array([0.0, 0, 0, 1]), bias), 1.0
    tensor = scene.inertia
    matrix = np.asarray(tensor.matrix)
    diagonal = not (matrix - np.diag(np.diag(matrix))).any()
    moments = np.diag(matrix) if diagonal else np.asarray(tensor.principal().moments)
    axes = np.array([0.0, 0, 0, 1]) if diagonal else rotations.of_matrix(np.asarray(tensor.principal().axes))
    attitude = np.asarray(scene.attitude.as_quat() if hasattr(scene.attitude, "as_quat") else scene.attitude)
    return State(attitude, np.asarray(scene.omega, dtype=float), ratios_of(moments), axes, bias), float(moments.max())


def _bounds(problem: Problem, bounds: Mapping[str, tuple[float, float]] | None) -> tuple[Array | None, Array | None]:
    if bounds is None:
        return None, None
    low, high = np.full(len(problem.names), -np.inf), np.full(len(problem.names), np.inf)
    for name, (least, most) in bounds.items():
        if name not in problem.names or name.startswith(("attitude", "axes")):
            possible = [n for n in problem.names if not n.startswith(("attitude", "axes"))]
            raise InvalidInput(f"bounds: must name some of {', '.join(possible)}, got {name!r}")
        if not least < most:
            raise InvalidInput(f"bounds: {name} must have a lower bound below the upper one, got {(least, most)}")
        low[problem.names.index(name)], high[problem.names.index(name)] = least, most
    return low, high


def _start_driven(problem: Problem, state: State, loss: str, scale: float) -> State:
    """Return the start of the last fit: the scene's numbers, the first samples, and windows that grow."""
    step = np.zeros(len(problem.names))
    for m in problem.data:
        if not len(m):
            continue
        first = int(np.argmin(np.abs(m.t)))
        if isinstance(m, Rates) and "omega" in problem.slices:
            step[problem.slices["omega"]] = m.y[first] - state.omega
        if isinstance(m, Attitudes) and "attitude" in problem.slices:
            error = rotations.product(m.y[first], rotations.conjugate(state.attitude))
            step[problem.slices["attitude"]] = rotations.log(error)
    spans = np.quantile(np.abs(problem.t), SPANS)
    best: Minimum | None = None
    for begin in (state.displaced(step, problem.slices), state):
        for windows in (spans, spans[2:], spans[-1:]):
            try:
                found = grown(problem, begin, windows, loss, scale)
            except IntegrationFailure:   # numbers that a short window hardly fixes may be far off in a longer one
                continue
            if best is None or found.cost < best.cost:
                best = found
            if fits(best):
                return best.state
    return state if best is None else best.state


def _set_up(data: list[Measurement], groups: Sequence[str], scene: Scene | None, driven: bool,
            ) -> tuple[State, float, Problem]:
    """Return the scene's state, its largest moment, and the problem."""
    count = sum(m.bias for m in data)
    if not driven or scene is None:
        state, largest = _of_scene(scene, groups, count)
        return state, largest, Problem(data, groups, state)
    if scene.t0 != 0:
        raise InvalidInput(f"scene: must start at t0 = 0, where the times of measurements start, got {scene.t0}")
    base = DrivenState.of(scene, groups, np.zeros(count))
    problem = DrivenProblem(data, groups, base)
    if problem.t.size:
        base.limit_steps(problem.t)
    return base, float(base.moments.max()), problem


def fit(
    data: Measurement | Sequence[Measurement],
    scene: Scene | None = None,
    fit: str | Sequence[str] = ("omega", "attitude", "inertia"),
    start: str | Sequence[float] | None = "search",
    bounds: Mapping[str, tuple[float, float]] | None = None,
    loss: str = "linear",
    f_scale: float = 1.0,
    seed: int = 0,
    fastest: float | None = None,
) -> FitResult:
    """Fit the start, the inertia and the axes of a free body, or numbers of a scene with torques, to measurements.

    Parameters
    ----------
    data : Measurement or sequence of them
        Of :mod:`polhode.measured`, in any mixture.
    scene : Scene, optional
        It gives what is not fitted, the start of the fit with start='scene', and the scale of the inertia, which no
        free motion fixes. With torques or rotors it starts at t0 = 0, and the fit starts from its numbers.
    fit : str or sequence of str
        Some of 'omega', 'attitude', 'inertia' (two ratios of second moments) and 'axes' (the principal axes in the
        body; without it the given axes are principal). With torques or rotors 'inertia' are three second moments about
        the scene's principal axes, and there are numbers such as 'torques.0.weight', 'damping.matrix' and
        'rotors.0.momentum'.
    start : {'search', 'scene'}
        'search' needs no start for a free body. With torques or rotors windows of the data grow from the scene's
        numbers. 'scene' starts at the scene's values with all data. Where that does not fit a free body, windows grow.
    bounds : dict, optional
        (least, most) of parameters by name, for 'omega_x' and so on, 'log_p1_p3', 'log_p2_p3', 'bias_x', and with
        torques or rotors 'log_p1' to 'log_p3' and 'torques.0.weight' or 'torques.0.arm_x'.
    loss : {'linear', 'soft_l1', 'huber', 'cauchy'}
        The loss of (residual / (sigma f_scale))^2, as for SciPy's `least_squares`. Where no motion fits under 'linear',
        'soft_l1' names the outliers, at most a tenth of the samples, and the others are fitted.
    f_scale : float
        The residual over sigma from which the loss counts it as an outlier.
    seed : int
        Of the search.
    fastest : float, optional
        The largest rate that scans over frequencies try [rad/s]. By default three quarters of a turn in the spacing of
        an even grid of times. For times at random the scans go on to a hundred turns in their mean spacing.

    Returns
    -------
    FitResult
        SciPy's names (`x`, `cost`, `fun`, `jac`, `nfev`, `status`, `message`, `success`), `omega`, `attitude`,
        `inertia`, `cov`, `stderr`, `correlation`, `parameters`, `chi2`, `dof`, `candidates`, `outliers`,
        `unobservable`, `twins`, `scene`, `problem`, and `predict(t)`.

    Raises
    ------
    InvalidInput
        Data of unequal lengths, sigma that is not positive, too few samples, or a Custom torque.

    Notes
    -----
    An offset of times is not fitted. See docs/fit.md.
    """
    if scene is not None and not isinstance(scene, Scene):
        raise InvalidInput(f"scene: must be a polhode.Scene, got {type(scene).__name__}")
    if scene is not None and (scene.changing is not None or scene.momentum is not None):
        raise InvalidInput("scene: must have a body of constant inertia and momentum, got one that changes")
    driven = scene is not None and bool(len(scene.torques) or len(scene.rotors) or len(scene.controllers))
    measurements, groups = _to_data(data), _to_groups(fit, driven)
    if not is_one_of(loss, LOSSES):
        raise InvalidInput(f"loss: must be one of {', '.join(LOSSES)}, got {loss!r}")
    f_scale = to_number(f_scale, "f_scale")
    if not is_whole(seed) or seed < 0:   # NumPy crashes on a list that holds itself
        raise InvalidInput(f"seed: must be a whole number >= 0, got {seed!r}")
    if fastest is not None and not (fastest := to_number(fastest, "fastest")) > 0:
        raise InvalidInput(f"fastest: must be positive, got {fastest}")
    if not f_scale > 0:
        raise InvalidInput(f"f_scale: must be positive, got {f_scale}")
    if not is_one_of(start, ("search", "scene")) or (start == "scene" and scene is None):
        raise InvalidInput(f"start: must be 'search', or 'scene' with a scene, got {start!r}")
    state, largest, problem = _set_up(measurements, groups, scene, driven)
    if any(m.accelerates for m in measurements) and (driven or "axes" in groups or problem.base.oblique):
        raise InvalidInput("data: Acceleration needs a free body whose given axes are principal")
    independent = sum(m.independent for m in measurements)
    if independent < len(problem.names) or problem.t.size < 2:
        raise InvalidInput(f"data: {independent} numbers cannot give {len(problem.names)} parameters; "
                           f"{sum(m.left_out for m in measurements)} samples were left out as NaN")
    how, pool, others = "the scene", Pool(problem), None
    if start == "search" and driven:
        state, how = _start_driven(problem, state, loss, f_scale), "growing windows from the scene"
    elif start == "search":
        rng = np.random.default_rng(seed)
        how = search_free(problem, state, rng, loss, f_scale, pool, fastest)
        others = robust.search(problem, pool) if loss == "linear" and bounds is None and not pool.fits else None
        if others is None and not robust.fits(problem, pool, loss):
            how = search_at_random(problem, state, rng, loss, f_scale, pool, how)
        state = state if pool.best is None else pool.best.state
    low, high = _bounds(problem, bounds)
    if start == "scene" and not driven:
        found = from_scene(problem, state, loss, f_scale, low, high)
    else:
        found = minimise(problem, state, loss=loss, scale=f_scale, low=low, high=high, most=1000)
    pool.add(found)
    if loss != "linear":
        places = robust.find_outliers(problem, found.residuals)
        return make_result(problem, found, scene, largest, how, pool, problem, places)
    if not pool.fits and bounds is None:   # some samples may be wrong
        others = others or robust.search(problem, pool)
        if others is not None:
            kept, found, places = others
            pool = Pool(kept)
            pool.add(found)
            return make_result(kept, found, scene, largest, how, pool, problem, places)
    return make_result(problem, found, scene, largest, how, pool)
