"""Closed forms for many bodies and many times, on arrays that broadcast."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core
from .._attitude.rotation import Rotation
from .._core import InertiaTensor
from .broadcast import Array, check_out, check_threads, check_want, evaluate, to_rows


def _product(p: Array, q: Array) -> Array:
    """Return Hamilton's product of arrays of quaternions."""
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
    """Compute the torque-free motion of many bodies at many times; all arguments broadcast.

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
    workers = check_threads(threads)
    speeds, attitudes = to_rows(omega, "omega", 3), to_rows(attitude, "attitude", 4)
    times = to_rows(t, "t", None)
    if isinstance(inertia, InertiaTensor):
        matrix = inertia.matrix
        if np.count_nonzero(matrix - np.diag(np.diag(matrix))):
            def in_principal_axes(w: Array, q: Array, names: tuple[str, ...]) -> Any:
                return free_motion(inertia.moments, w, q, times, want=names, threads=threads)

            q_BP = Rotation.from_matrix(inertia.axes).as_quat()
            return _rotated(inertia.axes, q_BP, speeds, attitudes, out, want, in_principal_axes)
        moments = np.diag(matrix).copy()
    else:
        moments = to_rows(inertia, "inertia", 3)

    def kernel(*arguments: Any) -> int:
        return _core._free_motion(*(*arguments, workers))

    return evaluate([(moments, 1), (speeds, 1), (attitudes, 1)], times, out, want, kernel)


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
    """Compute the motion of many of Lagrange's tops at many times; all arguments broadcast.

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
    workers = check_threads(threads)
    speeds, attitudes = to_rows(omega, "omega", 3), to_rows(attitude, "attitude", 4)
    times = to_rows(t, "t", None)
    arms = to_rows(weight_arm, "weight_arm", None)

    def kernel(*arguments: Any) -> int:
        return _core._heavy_top(*(*arguments, workers))

    def evaluate_tops(moments: Array, w: Array, q: Array, target: Any, names: str | Sequence[str]) -> Any:
        return evaluate([(moments, 1), (arms, 0), (w, 1), (q, 1)], times, target, names, kernel)

    if not isinstance(inertia, InertiaTensor):
        return evaluate_tops(to_rows(inertia, "inertia", 3), speeds, attitudes, out, want)
    matrix = inertia.matrix
    if not np.count_nonzero(matrix - np.diag(np.diag(matrix))):
        return evaluate_tops(np.diag(matrix).copy(), speeds, attitudes, out, want)
    # Products of inertia: the frame S has the symmetry axis for its z, as HeavyTop finds it.
    moments, axes = inertia.moments, inertia.axes
    lone = 2 if moments[1] - moments[0] <= moments[2] - moments[1] else 0
    first, second = [k for k in range(3) if k != lone]
    axis = axes[:, lone] * np.copysign(1.0, axes[np.argmax(np.abs(axes[:, lone])), lone])
    R_BS = np.stack([axes[:, first], np.cross(axis, axes[:, first]), axis], axis=1)
    equal = 0.5 * (moments[first] + moments[second])

    def top(w: Array, q: Array, names: tuple[str, ...]) -> Any:
        return evaluate_tops(np.array([equal, equal, moments[lone]]), w, q, None, names)

    return _rotated(R_BS, Rotation.from_matrix(R_BS).as_quat(), speeds, attitudes, out, want, top)


def _rotated(
    R_BP: Array,
    q_BP: Array,
    omega: Array,
    attitude: Array,
    out: Any,
    want: str | Sequence[str],
    motion: Callable[[Array, Array, tuple[str, ...]], Any],
) -> Any:
    """Convert a motion from principal axes P to the body axes B."""
    names = check_want(want)
    found = motion(omega @ R_BP, _product(attitude, q_BP), names)
    back: dict[str, Callable[[Array], Array]] = {
        "omega": lambda w: w @ R_BP.T, "attitude": lambda q: _product(q, q_BP * [-1, -1, -1, 1])}
    answer = [back[name](values) for name, values in zip(names, found, strict=True)]
    targets = check_out(out, names, answer[0].shape[:-1])
    for k, name in enumerate(names):
        if name in targets:
            targets[name][...] = answer[k]
            answer[k] = targets[name]
    return answer[0] if isinstance(want, str) else tuple(answer)
