"""Derivatives of many free bodies at many times, on arrays that broadcast."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core
from .._attitude.arrays import is_one_of
from .._batch import broadcast
from .._core import InertiaTensor, InvalidInput
from .sensitivity import Array, Sensitivity, name_columns, of_groups


def _targets(out: Any, shapes: list[tuple[int, ...]]) -> list[Any]:
    if out is None:
        return [None] * 4
    given = tuple(out) if isinstance(out, (tuple, list)) else (out,)
    if len(given) != 4:
        raise InvalidInput(f"out: must be (omega, attitude, d_omega, d_attitude), got {len(given)} arrays")
    for array, shape in zip(given, shapes, strict=True):
        if not (isinstance(array, np.ndarray) and array.dtype == np.float64 and array.shape == shape
                and array.flags.writeable):
            found = f"{array.dtype} of shape {array.shape}" if isinstance(array, np.ndarray) else type(array).__name__
            raise InvalidInput(f"out: must be a writeable float64 array of shape {shape}, got {found}")
    broadcast.require_apart(given)
    return list(given)


def free_sensitivity(
    inertia: InertiaTensor | npt.ArrayLike,
    omega: npt.ArrayLike,
    attitude: Any,
    t: npt.ArrayLike,
    *,
    wrt: str | Sequence[str] = ("omega", "inertia"),
    side: str = "space",
    out: Any = None,
    threads: int | None = None,
) -> Sensitivity:
    """Compute the torque-free motion of many bodies and its derivatives; all arguments broadcast.

    Parameters
    ----------
    inertia, omega, attitude, t, threads
        As for :func:`free_motion`.
    wrt, side
        As for :meth:`FreeMotion.sensitivity`.
    out : tuple of ndarray, optional
        Where to write omega, attitude, d_omega and d_attitude, float64.

    Returns
    -------
    Sensitivity
        With arrays of shapes (..., 3), (..., 4), (..., 3, n) and (..., 3, n).

    Raises
    ------
    InvalidInput
        What :func:`free_motion` and :meth:`FreeMotion.sensitivity` refuse.
    MemoryError
        The result would not fit into this machine.

    Warns
    -----
    RuntimeWarning
        As :func:`free_motion`, for rows that are NaN.

    Notes
    -----
    See docs/sensitivity.md for the formulas and the errors.
    """
    if not is_one_of(side, ("space", "body")):
        raise InvalidInput(f"side: must be 'space' or 'body', got {side!r}")
    workers = broadcast.check_threads(threads)
    speeds, attitudes = broadcast.to_rows(omega, "omega", 3), broadcast.to_attitudes(attitude, 3)
    times = broadcast.to_rows(t, "t", None)
    parameters = [] if isinstance(inertia, InertiaTensor) else [(broadcast.to_rows(inertia, "inertia", 3), 1)]
    parameters += [(speeds, 1), (attitudes, 1)]
    loops = [array.shape[: array.ndim - core] for array, core in parameters]
    try:
        shape = np.broadcast_shapes(*loops, times.shape)
    except ValueError:
        shapes = ", ".join(map(str, [*loops, times.shape]))
        raise InvalidInput(f"t: must broadcast with the bodies, got shapes {shapes}") from None
    count = len(name_columns(wrt))
    tails = [(3,), (4,), (3, count), (3, count)]
    targets = _targets(out, [(*shape, *tail) for tail in tails])
    broadcast.require_memory(math.prod(shape), 8 * sum(math.prod(tail) for tail in tails))
    bodies, inner = broadcast.split_axes(shape, loops)
    order = bodies + inner
    flat, flat_t = broadcast.flatten(parameters, times, shape, bodies, inner)

    spread = [shape[k] for k in order]
    inputs: list[Array] = [*(array for array, _ in parameters), times]
    results = [target if order == sorted(order) and broadcast.in_place(target, [*inputs, *targets])
               else np.empty((*spread, *tail)) for target, tail in zip(targets, tails, strict=True)]
    common = (inertia,) if isinstance(inertia, InertiaTensor) else ()
    arguments: tuple[Any, ...] = (*common, *flat, flat_t, wrt, side, *results, workers)
    failed = _core._free_sensitivity(*arguments) if all(shape) else 0
    if failed:
        broadcast.warn_failed(failed, 3)
    inverse = [int(k) for k in np.argsort(order)]
    for k, target in enumerate(targets):
        axes = [*inverse, *range(len(shape), results[k].ndim)]
        if target is None:
            results[k] = results[k].transpose(axes)
        elif results[k] is not target:
            target[...] = results[k].transpose(axes)
            results[k] = target
    w, q, d_omega, d_attitude = results
    return of_groups(w, q, d_omega, d_attitude, wrt, side)
