"""Closed forms for many bodies and many times, on arrays that broadcast."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy.typing as npt

from .. import _core
from .._attitude.arrays import is_one_of
from .._core import InertiaTensor, InvalidInput
from .broadcast import (
    Array,
    check_dtype,
    check_errors,
    check_threads,
    check_want,
    copy_out,
    evaluate,
    to_attitudes,
    to_rows,
)
from .progress import Report, reporter

BOTH, DOUBLE = ("omega", "attitude"), "float64"
FEW = 2048   # times whose states cost less to copy than `out` costs to compare with all other arrays


def _split(inertia: InertiaTensor | npt.ArrayLike) -> tuple[tuple[InertiaTensor, ...], list[tuple[Array, int]]]:
    """Return what all bodies share, a tensor, and what each has of its own, moments; one of the two is empty."""
    if isinstance(inertia, InertiaTensor):
        return (inertia,), []
    return (), [(to_rows(inertia, "inertia", 3), 1)]


def _evaluate(
    function: Callable[..., int],
    inertia: InertiaTensor | npt.ArrayLike,
    parameters: list[tuple[Array, int]],
    start: tuple[npt.ArrayLike, Any],
    t: npt.ArrayLike,
    out: Any,
    want: str | Sequence[str],
    axis: npt.ArrayLike | None,
    frame: str,
    dtype: Any,
    threads: int | None,
    errors: str,
    progress: bool | Report | None,
) -> Any:
    """Evaluate a closed form, whose C++ function gets the inertia, the parameters, the start, and what is wanted."""
    workers, refuse, report = check_threads(threads), check_errors(errors), reporter(progress)
    rows = [(to_rows(start[0], "omega", 3), 1), (to_attitudes(start[1], 4), 1)]
    times = to_rows(t, "t", None)
    common, own = _split(inertia)
    if not is_one_of(frame, ("body", "space")):
        raise InvalidInput(f"frame: must be 'body' or 'space', got {frame!r}")
    follows = "direction" in (want if isinstance(want, (str, tuple)) else check_want(want))
    if follows != (axis is not None):
        raise InvalidInput("axis: must be given with want='direction', and only with it")
    vectors = [(to_rows(axis, "axis", 3), 1)] if follows else []

    def kernel(*arguments: Any) -> int:
        *flat, times, results = arguments
        vector = flat.pop() if follows else None
        return function(*common, *flat, times, results, vector, frame == "space", workers, refuse, report)

    return evaluate([*own, *parameters, *rows, *vectors], times, out, want, kernel, refuse, check_dtype(dtype))


def free_motion(
    inertia: InertiaTensor | npt.ArrayLike,
    omega: npt.ArrayLike,
    attitude: Any,
    t: npt.ArrayLike,
    *,
    out: Any = None,
    want: str | Sequence[str] = BOTH,
    axis: npt.ArrayLike | None = None,
    frame: str = "body",
    dtype: Any = DOUBLE,
    threads: int | None = None,
    errors: str = "raise",
    progress: bool | Report | None = None,
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
        Where to write, of the `dtype`, one for each of `want`. Saves the cost of fresh memory, which exceeds that of
        the motion itself.
    want : str or sequence of str
        What is computed: 'omega', 'attitude', 'direction', or some of them. A single name gives a single array.
    axis : array_like, shape (..., 3)
        With 'direction': the vector that is followed. It need not be unit; its length stays.
    frame : str
        Where `axis` is fixed: in the 'body', and the direction is in space; or in 'space', and the direction is in body
        axes.
    dtype : str or numpy.dtype
        Of the results: 'float64', or 'float32' for errors below 1e-6 of the largest rate, and of the attitude [rad].
        The phases are reduced in float64 either way.
    threads : int, optional
        At most this many; by default as many as the machine has. The bits of the result do not depend on it.
    errors : {"raise", "nan"}
        With "nan" the rows of an impossible body become NaN, and a warning gives their count. By default it is refused.
    progress : True or callable, optional
        ``progress(states done, all states)`` is called about fifty times a second. What it raises ends the call. True
        writes a line with the time left to stderr.

    Returns
    -------
    omega : ndarray, shape (..., 3)
        In body axes [rad/s].
    attitude : ndarray, shape (..., 4)
        Body to space, unit, (x, y, z, w).
    direction : ndarray, shape (..., 3)
        The axis in the other frame, if it is wanted.

    Raises
    ------
    InvalidInput
        Shapes that do not broadcast, moments that no body has, attitudes that are not unit, abs(omega t) > 1e25 rad.
    MemoryError
        The result would not fit into this machine: before anything is computed, with the number of bytes.

    Warns
    -----
    RuntimeWarning
        Once, with their count, when rows came out NaN because their input is not finite, or because the least moment is
        below 1.5e-154 of the largest, or with errors="nan" because no body is like that.

    Notes
    -----
    The formulas of :class:`FreeMotion`; see docs/exact.md.
    """
    plain = want is BOTH and axis is None and dtype is DOUBLE and (out is None or getattr(t, "size", 0) <= FEW)
    if plain and check_errors(errors) and progress is None and check_threads(threads) >= 0:
        motion = _core._free_motion_of_one(inertia, omega, attitude, t)
        if motion is not None:
            return motion if out is None else copy_out(motion, out, BOTH)
    return _evaluate(_core._free_motion, inertia, [], (omega, attitude), t, out, want, axis, frame, dtype, threads,
                     errors, progress)


def gyrostat(
    inertia: InertiaTensor | npt.ArrayLike,
    momentum: npt.ArrayLike,
    omega: npt.ArrayLike,
    attitude: Any,
    t: npt.ArrayLike,
    *,
    out: Any = None,
    want: str | Sequence[str] = BOTH,
    axis: npt.ArrayLike | None = None,
    frame: str = "body",
    dtype: Any = DOUBLE,
    threads: int | None = None,
    errors: str = "raise",
    progress: bool | Report | None = None,
) -> Any:
    """Compute the torque-free motion of many gyrostats at many times; all arguments broadcast.

    Parameters
    ----------
    inertia : array_like, shape (..., 3), or InertiaTensor
        Principal moments in the body axes with the rotors locked, in any order [kg m^2]; or one tensor for all.
    momentum : array_like, shape (..., 3)
        The rotors' momentum in body axes [kg m^2/s].
    omega, attitude, t, out, want, axis, frame, dtype, threads, errors, progress
        As for :func:`free_motion`.

    Returns
    -------
    omega, attitude, direction : ndarray
        As :func:`free_motion`.

    Raises
    ------
    InvalidInput
        Shapes that do not broadcast, and what :class:`Gyrostat` refuses, with the number of the body.
    MemoryError
        As :func:`free_motion`.

    Warns
    -----
    RuntimeWarning
        As :func:`free_motion`.

    Notes
    -----
    The formulas of :class:`Gyrostat`; see docs/gyrostat.md.
    """
    own = [(to_rows(momentum, "momentum", 3), 1)]
    return _evaluate(_core._gyrostat, inertia, own, (omega, attitude), t, out, want, axis, frame, dtype, threads,
                     errors, progress)


def heavy_top(
    inertia: InertiaTensor | npt.ArrayLike,
    weight_arm: npt.ArrayLike,
    omega: npt.ArrayLike,
    attitude: Any,
    t: npt.ArrayLike,
    *,
    out: Any = None,
    want: str | Sequence[str] = BOTH,
    axis: npt.ArrayLike | None = None,
    frame: str = "body",
    dtype: Any = DOUBLE,
    threads: int | None = None,
    errors: str = "raise",
    progress: bool | Report | None = None,
) -> Any:
    """Compute the motion of many of Lagrange's tops at many times; all arguments broadcast.

    Parameters
    ----------
    inertia : array_like, shape (..., 3), or InertiaTensor
        Moments about the pivot in the body axes, two of them equal [kg m^2]; or one tensor for all. The axis is the
        body's z whenever the first two are equal.
    weight_arm : array_like, shape (...)
        Weight times the distance of the centre of mass from the pivot, signed along the axis [N m].
    omega, attitude, t, out, want, axis, frame, dtype, threads, errors, progress
        As for :func:`free_motion`.

    Returns
    -------
    omega, attitude, direction : ndarray
        As :func:`free_motion`.

    Raises
    ------
    InvalidInput
        Shapes that do not broadcast, and what :class:`HeavyTop` refuses, with the number of the body.
    MemoryError
        As :func:`free_motion`.

    Warns
    -----
    RuntimeWarning
        As :func:`free_motion`.

    Notes
    -----
    The formulas of :class:`HeavyTop`; see docs/heavy_top.md.
    """
    own = [(to_rows(weight_arm, "weight_arm", None), 0)]
    return _evaluate(_core._heavy_top, inertia, own, (omega, attitude), t, out, want, axis, frame, dtype, threads,
                     errors, progress)
