"""The states of drawn bodies: closed forms for free bodies, `solve_many` for all others."""

from __future__ import annotations

import copy
import warnings
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .._batch.closed_forms import free_motion
from .._batch.solve_many import solve_many
from .._core import InertiaTensor, InvalidInput
from .._scene.files import make_scene
from .._scene.scene import Scene
from .._solve.solve import solve
from . import distributions
from .distributions import Floats
from .draw import Bodies
from .recipe import EnsembleRecipe, Point

STATUS = ("finished", "event", "max_steps", "stopped", "failed", "impossible", "sliding")
IMPOSSIBLE = STATUS.index("impossible")


class States(NamedTuple):
    """The states of bodies at all times, and what solving them said.

    Rows that a body did not reach are NaN. `error` is NaN where it is not estimated.
    """

    omega: Floats                        # (bodies, times, 3)
    attitude: Floats                     # (bodies, times, 4)
    status: npt.NDArray[np.int8]         # (bodies,), numbers of STATUS
    error: Floats                        # (bodies,)
    success: npt.NDArray[np.bool_]
    steps: npt.NDArray[np.int64]


def is_free(recipe: EnsembleRecipe, point: Point) -> bool:
    """Return True if the closed form of free bodies serves: no torque, no rotor, and no method asked of it."""
    nominal = point.nominal
    changes = nominal.changing is not None or nominal.momentum is not None
    acting = nominal.torques or nominal.rotors or nominal.controllers
    return not (acting or changes) and not set(recipe.options) - {"accuracy"}


def check_options(recipe: EnsembleRecipe) -> None:
    """Refuse options of `solve` that contradict each other or the scene, before any chunk."""
    for point in recipe.points[:1]:
        if not is_free(recipe, point):
            solve(point.nominal, **{**recipe.options, "max_steps": 1})


def start_of(point: Point, bodies: Bodies) -> tuple[Floats, Floats]:
    """Return omega and attitude of the bodies' starts, shapes (n, 3) and (n, 4)."""
    nominal, count = point.nominal, len(bodies)
    omega = bodies.values.get(("start", "omega"))
    if omega is None and ("start", "omega_deg") in bodies.values:
        omega = np.radians(bodies.values["start", "omega_deg"])
    if omega is None:
        omega = np.broadcast_to(nominal.omega, (count, 3))
    attitude = bodies.values.get(("start", "attitude"))
    if attitude is None:
        attitude = np.broadcast_to(nominal.attitude, (count, 4))
    return np.array(omega, order="C"), np.array(attitude, order="C")


def diagonal(bodies: Bodies) -> Floats | InertiaTensor | None:
    """Return moments about the body axes, or the tensor of all; None where the bodies have axes of their own."""
    if not isinstance(bodies.inertia, list):
        return bodies.inertia
    matrices = np.array([np.full((3, 3), np.nan) if tensor is None else tensor.matrix for tensor in bodies.inertia])
    off = matrices[:, [0, 0, 1], [1, 2, 2]]
    return None if (np.abs(off) > 0).any() else np.ascontiguousarray(np.diagonal(matrices, axis1=1, axis2=2))


def _free(point: Point, bodies: Bodies, inertia: Floats | InertiaTensor) -> States:
    omega, attitude = start_of(point, bodies)
    omega[bodies.impossible] = np.nan
    if not isinstance(inertia, InertiaTensor) and bodies.impossible.any():
        inertia = np.where(bodies.impossible[:, None], 1.0, inertia)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)   # rows that are NaN are counted
        if not isinstance(inertia, InertiaTensor):
            inertia = inertia[:, None]
        times = point.nominal.times - point.nominal.t0
        rates, attitudes = free_motion(inertia, omega[:, None], attitude[:, None], times, threads=1)
    bad = bodies.impossible
    count = len(bodies)
    return States(rates, attitudes, np.where(bad, IMPOSSIBLE, 0).astype(np.int8), np.full(count, np.nan), ~bad,
                  np.zeros(count, dtype=np.int64))


def _scene(point: Point, bodies: Bodies, i: int) -> Scene | None:
    """Return the scene of one body; None if no body can be so."""
    if bodies.impossible[i]:
        return None
    data = copy.deepcopy(point.data)
    for path, values in bodies.values.items():
        distributions.put(data, path, values[i].tolist())
    try:
        return make_scene(data)
    except InvalidInput:
        return None


def scenes(point: Point, bodies: Bodies) -> list[Scene | None]:
    """Return a scene for each body; None for a body that cannot exist."""
    return [_scene(point, bodies, i) for i in range(len(bodies))]


def _has_simple_starts(point: Point) -> bool:
    simple = {("body", "moments"), ("start", "omega"), ("start", "omega_deg"), ("start", "attitude")}
    return all(quantity.path in simple for quantity in point.quantities)


def _solved(recipe: EnsembleRecipe, point: Point, bodies: Bodies) -> States:
    count, times = len(bodies), point.nominal.times.size
    found = States(np.full((count, times, 3), np.nan), np.full((count, times, 4), np.nan),
                   np.full(count, IMPOSSIBLE, dtype=np.int8), np.full(count, np.nan), np.zeros(count, dtype=bool),
                   np.zeros(count, dtype=np.int64))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if _has_simple_starts(point):
            rows = np.flatnonzero(~bodies.impossible)
            omega, attitude = start_of(point, bodies)
            moments = None if isinstance(bodies.inertia, (InertiaTensor, list)) else bodies.inertia[rows]
            motions = solve_many(point.nominal, inertia=moments, omega=omega[rows], attitude=attitude[rows],
                                 threads=1, errors="nan", numbers=rows + bodies.first,
                                 **recipe.options) if rows.size else None
        else:
            made = scenes(point, bodies)
            rows = np.array([i for i, scene in enumerate(made) if scene is not None], dtype=np.int64)
            motions = solve_many([scene for scene in made if scene is not None], threads=1, errors="nan",
                                 numbers=rows + bodies.first, **recipe.options)
    if motions is not None:
        found.omega[rows], found.attitude[rows] = motions.omega, motions.attitude
        ends = [STATUS.index(status) for status in motions.status]
        found.status[rows] = np.where(motions.refused, IMPOSSIBLE, ends)
        found.error[rows], found.success[rows], found.steps[rows] = motions.error, motions.success, motions.steps
    return found


def compute(recipe: EnsembleRecipe, point: Point, bodies: Bodies) -> States:
    """Return the states of the bodies at the recipe's times. A body that fails fails alone."""
    if is_free(recipe, point) and (inertia := diagonal(bodies)) is not None:
        return _free(point, bodies, inertia)
    return _solved(recipe, point, bodies)


def nominal_attitude(recipe: EnsembleRecipe, point: Point) -> Any:
    """Return the attitudes of the undisturbed motion, shape (times, 4)."""
    nominal = point.nominal
    if is_free(recipe, point):
        return free_motion(nominal.inertia, nominal.omega, nominal.attitude, nominal.times - nominal.t0,
                           want="attitude", threads=1)
    return solve(nominal, **recipe.options).attitude
