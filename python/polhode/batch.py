"""Many bodies, many times: closed forms on arrays that broadcast."""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._core import InertiaTensor, InvalidInput

__all__ = ["free_motion", "heavy_top"]

Array = npt.NDArray[np.float64]
WIDTHS = {"omega": 3, "attitude": 4}


def _numbers(value: Any, name: str, width: int | None) -> Array:
    """A float64 array whose last axis has the width asked for; NaN and inf may pass."""
    if hasattr(value, "as_quat"):
        value = value.as_quat()
    try:
        array = np.asarray(value)
    except ValueError:
        array = np.empty(0, dtype=object)
    if array.dtype.kind not in "fiub":
        raise InvalidInput(f"{name}: must be an array of real numbers, got dtype {array.dtype}")
    if width is not None and (array.ndim == 0 or array.shape[-1] != width):
        raise InvalidInput(f"{name}: must be an array of shape (..., {width}), got shape {array.shape}")
    return array.astype(np.float64, copy=False)


def _wanted(want: str | Sequence[str]) -> tuple[str, ...]:
    names = (want,) if isinstance(want, str) else tuple(want)
    if not names or any(name not in WIDTHS for name in names) or len(set(names)) != len(names):
        raise InvalidInput(f"want: must be one or both of 'omega' and 'attitude', got {want!r}")
    return names


def _require_memory(shape: tuple[int, ...], names: tuple[str, ...]) -> None:
    states = math.prod(shape)
    needed = states * sum(8 * WIDTHS[name] for name in names)
    if needed < 2**28:
        return
    try:
        there = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (ValueError, OSError, AttributeError):
        return
    if needed > there:
        raise MemoryError(f"{states} states need {needed} bytes; this machine has {there}")


def _axes(shape: tuple[int, ...], loops: Sequence[tuple[int, ...]]) -> tuple[list[int], list[int]]:
    """Which axes of the result belong to bodies (some parameter varies along them) and which to times alone."""
    padded = [(1,) * (len(shape) - len(loop)) + loop for loop in loops]
    bodies = [k for k in range(len(shape)) if any(loop[k] != 1 for loop in padded)]
    return bodies, [k for k in range(len(shape)) if k not in bodies]


def _targets(out: Any, names: tuple[str, ...], shape: tuple[int, ...]) -> dict[str, Any]:
    if out is None:
        return {}
    given = (out,) if isinstance(out, np.ndarray) else tuple(out)
    if len(given) != len(names):
        raise InvalidInput(f"out: must be one array for each of {names}, got {len(given)}")
    targets = {}
    for name, array in zip(names, given, strict=True):
        wanted = (*shape, WIDTHS[name])
        if not isinstance(array, np.ndarray) or array.dtype != np.float64 or array.shape != wanted or not array.flags.writeable:
            found = f"{array.dtype} of shape {array.shape}" if isinstance(array, np.ndarray) else type(array).__name__
            raise InvalidInput(f"out: must be a writeable float64 array of shape {wanted} for {name}, got {found}")
        targets[name] = array
    return targets


def _warn(poisoned: int, level: int) -> None:
    warnings.warn(f"{poisoned} rows are NaN because their input is not finite", RuntimeWarning, stacklevel=level)


def _evaluate_one(
    parameters: Sequence[Array],
    t: Array,
    targets: dict[str, Any],
    names: tuple[str, ...],
    want: str | Sequence[str],
    kernel: Callable[..., int],
) -> Any:
    """One body at all the times: nothing to broadcast, and a short call for short arrays."""
    _require_memory(t.shape, names)
    results: dict[str, Any] = {}
    for name in names:
        target = targets.get(name)
        fits = target is not None and target.flags.c_contiguous
        results[name] = target if fits else np.empty((*t.shape, WIDTHS[name]))
    poisoned = kernel(*(array[None] for array in parameters), t.reshape(-1), results.get("omega"), results.get("attitude"))
    if poisoned:
        _warn(poisoned, 5)
    for name, target in targets.items():
        if results[name] is not target:
            target[...] = results[name]
            results[name] = target
    return results[want] if isinstance(want, str) else tuple(results[name] for name in names)


def _evaluate(
    parameters: Sequence[tuple[Array, int]],
    t: Array,
    out: Any,
    want: str | Sequence[str],
    kernel: Callable[..., int],
) -> Any:
    """Broadcasts, calls kernel(*flat parameters, t, omega, attitude) and brings the results to the caller's shape.

    `parameters` are (array, how many of its last axes belong to one body).
    """
    names = _wanted(want)
    loops = [array.shape[: array.ndim - core] for array, core in parameters]
    if all(loop == () for loop in loops) and t.size:
        return _evaluate_one([array for array, _ in parameters], t, _targets(out, names, t.shape), names, want, kernel)
    try:
        shape = np.broadcast_shapes(*loops, t.shape)
    except ValueError:
        raise InvalidInput(f"t: must broadcast with the bodies, got shapes {', '.join(map(str, [*loops, t.shape]))}") from None
    targets = _targets(out, names, shape)
    _require_memory(shape, names)
    bodies, times = _axes(shape, loops)
    order = bodies + times
    body_shape, time_shape = [shape[k] for k in bodies], [shape[k] for k in times]

    flat = []
    for array, core in parameters:
        tail = array.shape[array.ndim - core :]
        spread = np.broadcast_to(array, (*shape, *tail))
        spread = spread.transpose(*order, *range(len(shape), len(shape) + core))
        spread = spread[(slice(None),) * len(bodies) + (0,) * len(times)] if all(time_shape) else spread.reshape(0, *tail)
        flat.append(np.ascontiguousarray(spread).reshape(-1, *tail))
    n_bodies, n_times = math.prod(body_shape), math.prod(time_shape)
    own_times = any(size != 1 for k, size in enumerate((1,) * (len(shape) - t.ndim) + t.shape) if k in bodies)
    spread_t = np.broadcast_to(t, shape).transpose(order)
    flat_t: Array
    if own_times or n_times == 0 or n_bodies == 0:
        flat_t = np.ascontiguousarray(spread_t).reshape(n_bodies, n_times)
    else:
        flat_t = np.ascontiguousarray(spread_t[(0,) * len(bodies)]).reshape(n_times)

    results: dict[str, Any] = {}
    in_place = order == sorted(order)
    for name in names:
        target = targets.get(name)
        if target is not None and in_place and target.flags.c_contiguous:
            results[name] = target
        else:
            results[name] = np.empty((*body_shape, *time_shape, WIDTHS[name]))
    poisoned = kernel(*flat, flat_t, results.get("omega"), results.get("attitude")) if n_bodies and n_times else 0
    if poisoned:
        _warn(poisoned, 4)

    inverse = [*np.argsort(order), len(shape)]
    for name in names:
        target = targets.get(name)
        if target is None:
            results[name] = results[name].transpose(inverse)
        elif results[name] is not target:
            target[...] = results[name].transpose(inverse)
            results[name] = target
    answer = tuple(results[name] for name in names)
    return answer[0] if isinstance(want, str) else answer


def _threads(threads: int | None) -> int:
    if threads is not None and (isinstance(threads, bool) or not isinstance(threads, int) or threads < 1):
        raise InvalidInput(f"threads: must be a positive whole number, got {threads!r}")
    return threads or 0


def _product(p: Array, q: Array) -> Array:
    """Hamilton's product of arrays of quaternions, which need not be unit to the last bit."""
    x, y, z, w = np.moveaxis(p, -1, 0)
    a, b, c, d = np.moveaxis(q, -1, 0)
    return np.stack([w * a + x * d + y * c - z * b, w * b - x * c + y * d + z * a,
                     w * c + x * b - y * a + z * d, w * d - x * a - y * b - z * c], axis=-1)


def free_motion(
    inertia: InertiaTensor | npt.ArrayLike,
    omega: npt.ArrayLike,
    attitude: Any,
    t: npt.ArrayLike,
    *,
    out: Any = None,
    want: str | Sequence[str] = ("omega", "attitude"),
    threads: int | None = None,
) -> Any:
    """Torque-free motion of many bodies at many times; everything broadcasts as in a NumPy gufunc.

    Parameters
    ----------
    inertia : array_like, shape (..., 3), or InertiaTensor
        Principal moments in the body axes, in any order [kg m^2]; or one tensor for all bodies.
    omega : array_like, shape (..., 3)
        Angular velocity at t = 0, in body axes [rad/s].
    attitude : array_like, shape (..., 4), or Rotation
        Attitude at t = 0, body to space, unit, (x, y, z, w).
    t : array_like, shape (...)
        Times [s]. Bodies (B, 1) and times (T,) give the full grid (B, T), each body set up once.
    out : ndarray or tuple of ndarray, optional
        Where to write, float64, one for each of `want`. Saves the cost of fresh memory, which exceeds that of the
        motion itself.
    want : str or sequence of str
        What is computed: 'omega', 'attitude' or both. A single name gives a single array.
    threads : int, optional
        At most this many; by default as many as the machine has. The bits of the result do not depend on it.

    Returns
    -------
    omega : ndarray, shape (..., 3)
        In body axes [rad/s].
    attitude : ndarray, shape (..., 4)
        Body to space, unit, (x, y, z, w).

    Raises
    ------
    InvalidInput
        Shapes that do not broadcast, moments that no body has, attitudes that are not unit, abs(omega t) > 1e25 rad.
    MemoryError
        The result would not fit into this machine: before anything is computed, with the number of bytes.

    Warns
    -----
    RuntimeWarning
        Once, with their count, when rows came out NaN because their input is not finite.

    Notes
    -----
    The formulas of :class:`FreeMotion`; see docs/exact.md.
    """
    team = _threads(threads)
    speeds, attitudes, times = _numbers(omega, "omega", 3), _numbers(attitude, "attitude", 4), _numbers(t, "t", None)
    if isinstance(inertia, InertiaTensor):
        matrix = inertia.matrix
        if np.count_nonzero(matrix - np.diag(np.diag(matrix))):
            from .attitude import Rotation

            def principal(w: Array, q: Array, names: tuple[str, ...]) -> Any:
                return free_motion(inertia.moments, w, q, times, want=names, threads=threads)

            return _turned(inertia.axes, Rotation.from_matrix(inertia.axes).as_quat(), speeds, attitudes, out, want, principal)
        moments = np.diag(matrix).copy()
    else:
        moments = _numbers(inertia, "inertia", 3)

    def kernel(*arguments: Any) -> int:
        return _core._free_motion(*(*arguments, team))

    return _evaluate([(moments, 1), (speeds, 1), (attitudes, 1)], times, out, want, kernel)


def heavy_top(
    inertia: InertiaTensor | npt.ArrayLike,
    weight_arm: npt.ArrayLike,
    omega: npt.ArrayLike,
    attitude: Any,
    t: npt.ArrayLike,
    *,
    out: Any = None,
    want: str | Sequence[str] = ("omega", "attitude"),
    threads: int | None = None,
) -> Any:
    """Lagrange's tops, many at many times; everything broadcasts as in a NumPy gufunc.

    Parameters
    ----------
    inertia : array_like, shape (..., 3), or InertiaTensor
        Moments about the pivot in the body axes, two of them equal [kg m^2]; or one tensor for all. The axis is the
        body's z whenever the first two are equal.
    weight_arm : array_like, shape (...)
        Weight times the distance of the centre of mass from the pivot, signed along the axis [N m].
    omega : array_like, shape (..., 3)
        Angular velocity at t = 0, in body axes [rad/s].
    attitude : array_like, shape (..., 4), or Rotation
        Attitude at t = 0, body to space, unit, (x, y, z, w).
    t : array_like, shape (...)
        Times [s]. Tops (B, 1) and times (T,) give the full grid (B, T), each top set up once.
    out, want, threads
        As for :func:`free_motion`.

    Returns
    -------
    omega : ndarray, shape (..., 3)
        In body axes [rad/s].
    attitude : ndarray, shape (..., 4)
        Body to space, unit, (x, y, z, w).

    Raises
    ------
    InvalidInput
        Shapes that do not broadcast, and what :class:`HeavyTop` refuses, with the number of the body.
    MemoryError
        The result would not fit into this machine: before anything is computed, with the number of bytes.

    Warns
    -----
    RuntimeWarning
        Once, with their count, when rows came out NaN because their input is not finite.

    Notes
    -----
    The formulas of :class:`HeavyTop`; see docs/heavy_top.md.
    """
    team = _threads(threads)
    speeds, attitudes, times = _numbers(omega, "omega", 3), _numbers(attitude, "attitude", 4), _numbers(t, "t", None)
    arms = _numbers(weight_arm, "weight_arm", None)

    def kernel(*arguments: Any) -> int:
        return _core._heavy_top(*(*arguments, team))

    def evaluate(moments: Array, w: Array, q: Array, target: Any, names: str | Sequence[str]) -> Any:
        return _evaluate([(moments, 1), (arms, 0), (w, 1), (q, 1)], times, target, names, kernel)

    if not isinstance(inertia, InertiaTensor):
        return evaluate(_numbers(inertia, "inertia", 3), speeds, attitudes, out, want)
    matrix = inertia.matrix
    if not np.count_nonzero(matrix - np.diag(np.diag(matrix))):
        return evaluate(np.diag(matrix).copy(), speeds, attitudes, out, want)
    # Products of inertia: the frame S has the symmetry axis for its z, as HeavyTop finds it.
    from .attitude import Rotation

    moments, axes = inertia.moments, inertia.axes
    lone = 2 if moments[1] - moments[0] <= moments[2] - moments[1] else 0
    first, second = [k for k in range(3) if k != lone]
    axis = axes[:, lone] * np.copysign(1.0, axes[np.argmax(np.abs(axes[:, lone])), lone])
    R_BS = np.stack([axes[:, first], np.cross(axis, axes[:, first]), axis], axis=1)
    equal = 0.5 * (moments[first] + moments[second])

    def top(w: Array, q: Array, names: tuple[str, ...]) -> Any:
        return evaluate(np.array([equal, equal, moments[lone]]), w, q, None, names)

    return _turned(R_BS, Rotation.from_matrix(R_BS).as_quat(), speeds, attitudes, out, want, top)


def _turned(
    R_BP: Array,
    q_BP: Array,
    omega: Array,
    attitude: Array,
    out: Any,
    want: str | Sequence[str],
    motion: Callable[[Array, Array, tuple[str, ...]], Any],
) -> Any:
    """A motion known in axes P, for a body whose own axes B are others."""
    names = _wanted(want)
    found = motion(omega @ R_BP, _product(attitude, q_BP), names)
    back: dict[str, Callable[[Array], Array]] = {
        "omega": lambda w: w @ R_BP.T, "attitude": lambda q: _product(q, q_BP * [-1, -1, -1, 1])}
    answer = [back[name](values) for name, values in zip(names, found, strict=True)]
    targets = _targets(out, names, answer[0].shape[:-1])
    for k, name in enumerate(names):
        if name in targets:
            targets[name][...] = answer[k]
            answer[k] = targets[name]
    return answer[0] if isinstance(want, str) else tuple(answer)
