"""Checks and broadcasting of arrays of bodies and of times."""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .._attitude.arrays import is_one_of, is_rotation, is_whole, to_items, to_numbers
from .._core import InvalidInput

Array = npt.NDArray[np.float64]
_DTYPES = {name: np.dtype(name) for name in ("float64", "float32")}
WIDTHS = {"omega": 3, "attitude": 4, "direction": 3}


def to_rows(value: Any, name: str, width: int | None) -> Array:
    """Return a float64 array whose last axis has this width; NaN and inf pass."""
    array = to_numbers(value.as_quat() if is_rotation(value) else value, name)
    if width is not None and (array.ndim == 0 or array.shape[-1] != width):
        raise InvalidInput(f"{name}: must be an array of shape (..., {width}), got shape {array.shape}")
    return array


def to_attitudes(value: Any, level: int) -> Array:
    """Return attitudes of shape (..., 4); warn if they look like (w, x, y, z)."""
    array = to_rows(value, "attitude", 4)
    if not is_rotation(value) and array.size and (array == (1.0, 0.0, 0.0, 0.0)).all():
        warnings.warn("attitude: (1, 0, 0, 0) is a half turn about x, as quaternions are (x, y, z, w) here. "
                      "Rotation.from_quat(..., scalar_first=True) reads (w, x, y, z); a Rotation gives no warning",
                      UserWarning, stacklevel=level)
    return array


def check_want(want: str | Sequence[str]) -> tuple[str, ...]:
    """Return the requested names, in the caller's order."""
    names = (want,) if isinstance(want, str) else to_items(want, "want", "one or more names")
    known = all(isinstance(name, str) and name in WIDTHS for name in names)
    if not names or not known or len(set(names)) != len(names):
        raise InvalidInput(f"want: must be one or more of 'omega', 'attitude' and 'direction', got {want!r}")
    return names


def require_memory(states: int, bytes_each: int) -> None:
    """Raise MemoryError if results of this size cannot fit into this machine."""
    needed = states * bytes_each
    if needed < 2**28:
        return
    try:
        there = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (ValueError, OSError, AttributeError):
        return
    if needed > there:
        raise MemoryError(f"{states} states need {needed} bytes; this machine has {there}")


def _require_memory(shape: tuple[int, ...], names: tuple[str, ...], dtype: np.dtype[Any]) -> None:
    require_memory(math.prod(shape), sum(dtype.itemsize * WIDTHS[name] for name in names))


def check_dtype(dtype: Any) -> np.dtype[Any]:
    """Return float64 or float32."""
    for name, kind in _DTYPES.items():
        if dtype is kind.type or (isinstance(dtype, (str, np.dtype)) and dtype in (name, kind)):
            return kind
    raise InvalidInput(f"dtype: must be 'float64' or 'float32', got {dtype!r}")


def split_axes(shape: tuple[int, ...], loops: Sequence[tuple[int, ...]]) -> tuple[list[int], list[int]]:
    """Return the axes of the result along which parameters vary, and the axes of times alone."""
    padded = [(1,) * (len(shape) - len(loop)) + loop for loop in loops]
    bodies = [k for k in range(len(shape)) if any(loop[k] != 1 for loop in padded)]
    return bodies, [k for k in range(len(shape)) if k not in bodies]


def require_apart(arrays: Sequence[Any]) -> None:
    """Refuse outputs that share memory: one would be written over the other. Views that interleave share none."""
    for k, one in enumerate(arrays):
        for other in arrays[:k]:
            if not np.may_share_memory(one, other):
                continue
            try:
                shared = np.shares_memory(one, other, 100_000)  # type: ignore[arg-type]
            except Exception:   # TooHardError, whose place differs between versions of NumPy: no shape is known
                shared = True
            if shared:
                raise InvalidInput("out: must be arrays apart, got two that share memory")


def check_out(out: Any, names: tuple[str, ...], shape: tuple[int, ...],
              dtype: np.dtype[Any] = np.dtype(np.float64)) -> dict[str, Any]:
    """Return the caller's arrays by name; none if `out` is not given."""
    if out is None:
        return {}
    given = tuple(out) if isinstance(out, (tuple, list)) else (out,)
    if len(given) != len(names):
        raise InvalidInput(f"out: must be one array for each of {names}, got {len(given)}")
    targets = {}
    for name, array in zip(names, given, strict=True):
        wanted = (*shape, WIDTHS[name])
        if not (isinstance(array, np.ndarray) and array.dtype == dtype and array.shape == wanted
                and array.flags.writeable):
            found = f"{array.dtype} of shape {array.shape}" if isinstance(array, np.ndarray) else type(array).__name__
            raise InvalidInput(f"out: must be a writeable {dtype} array of shape {wanted} for {name}, got {found}")
        targets[name] = array
    require_apart(given)
    return targets


def copy_out(results: Sequence[Array], out: Any, names: tuple[str, ...]) -> tuple[Any, ...]:
    """Write results that were computed apart into the caller's arrays, and return those."""
    targets = check_out(out, names, results[0].shape[:-1])
    for target, values in zip(targets.values(), results, strict=True):
        target[...] = values
    return tuple(targets.values())


def in_place(target: Any, others: Iterable[Any]) -> bool:
    """Return True if results can be written into `target` while the other arrays are read and written.

    As in NumPy, an output that overlaps an input or another output gets a copy of results computed apart.
    """
    if target is None or not (target.flags.c_contiguous and target.flags.aligned):
        return False
    return not any(other is not target and np.may_share_memory(target, other) for other in others)


def warn_failed(failed: int, level: int, refuse: bool = True) -> None:
    """Warn that so many rows are NaN."""
    why = "not finite or beyond float64" if refuse else "not finite, beyond float64, or of no possible body"
    warnings.warn(f"{failed} rows are NaN because their input is {why}", RuntimeWarning, stacklevel=level)


def _evaluate_one(
    parameters: Sequence[Array],
    t: Array,
    targets: dict[str, Any],
    names: tuple[str, ...],
    want: str | Sequence[str],
    kernel: Callable[..., int],
    refuse: bool,
    dtype: np.dtype[Any],
) -> Any:
    """Evaluate one body at all times, without the cost of broadcasting."""
    _require_memory(t.shape, names, dtype)
    results: dict[str, Any] = {}
    for name in names:
        target = targets.get(name)
        fits = in_place(target, [*parameters, t, *targets.values()])
        results[name] = target if fits else np.empty((*t.shape, WIDTHS[name]), dtype)
    flat = [array[None] for array in parameters]
    failed = kernel(*flat, t.reshape(-1), results)
    if failed:
        warn_failed(failed, 6, refuse)
    for name, target in targets.items():
        if results[name] is not target:
            target[...] = results[name]
            results[name] = target
    return results[want] if isinstance(want, str) else tuple(results[name] for name in names)


def flatten(
    parameters: Sequence[tuple[Array, int]],
    t: Array,
    shape: tuple[int, ...],
    bodies: list[int],
    times: list[int],
) -> tuple[list[Array], Array]:
    """Return the parameters as (bodies, ...) and the times as (times,) or (bodies, times), C-contiguous."""
    order = bodies + times
    n_bodies, n_times = math.prod(shape[k] for k in bodies), math.prod(shape[k] for k in times)
    flat = []
    for array, core in parameters:
        tail = array.shape[array.ndim - core :]
        expanded = np.broadcast_to(array, (*shape, *tail))
        expanded = expanded.transpose(*order, *range(len(shape), len(shape) + core))
        first = (slice(None),) * len(bodies) + (0,) * len(times)   # the parameters are the same at all times
        expanded = expanded[first] if all(shape[k] for k in times) else expanded.reshape(0, *tail)
        flat.append(np.ascontiguousarray(expanded).reshape(-1, *tail))
    own_times = any(size != 1 for k, size in enumerate((1,) * (len(shape) - t.ndim) + t.shape) if k in bodies)
    expanded_t = np.broadcast_to(t, shape).transpose(order)
    if own_times or n_times == 0 or n_bodies == 0:
        return flat, np.ascontiguousarray(expanded_t).reshape(n_bodies, n_times)
    return flat, np.ascontiguousarray(expanded_t[(0,) * len(bodies)]).reshape(n_times)


def evaluate(
    parameters: Sequence[tuple[Array, int]],
    t: Array,
    out: Any,
    want: str | Sequence[str],
    kernel: Callable[..., int],
    refuse: bool = True,
    dtype: np.dtype[Any] = np.dtype(np.float64),
) -> Any:
    """Broadcast, call kernel(*flat parameters, t, results by name), and return results in the caller's shape.

    `parameters` are (array, how many of its last axes belong to one body).
    """
    names = check_want(want)
    loops = [array.shape[: array.ndim - core] for array, core in parameters]
    if all(loop == () for loop in loops) and t.size:
        targets, arrays = check_out(out, names, t.shape, dtype), [array for array, _ in parameters]
        return _evaluate_one(arrays, t, targets, names, want, kernel, refuse, dtype)
    try:
        shape = np.broadcast_shapes(*loops, t.shape)
    except ValueError:
        shapes = ", ".join(map(str, [*loops, t.shape]))
        raise InvalidInput(f"t: must broadcast with the bodies, got shapes {shapes}") from None
    targets = check_out(out, names, shape, dtype)
    _require_memory(shape, names, dtype)
    bodies, times = split_axes(shape, loops)
    order = bodies + times
    body_shape, time_shape = [shape[k] for k in bodies], [shape[k] for k in times]
    flat, flat_t = flatten(parameters, t, shape, bodies, times)
    n_bodies, n_times = math.prod(body_shape), math.prod(time_shape)

    results: dict[str, Any] = {}
    others = [*(array for array, _ in parameters), t, *targets.values()]
    for name in names:
        target = targets.get(name)
        if order == sorted(order) and in_place(target, others):
            results[name] = target
        else:
            results[name] = np.empty((*body_shape, *time_shape, WIDTHS[name]), dtype)
    failed = kernel(*flat, flat_t, results) if n_bodies and n_times else 0
    if failed:
        warn_failed(failed, 5, refuse)

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


def check_errors(errors: str) -> bool:
    """Return True if an impossible body is to be refused."""
    if not is_one_of(errors, ("raise", "nan")):
        raise InvalidInput(f"errors: must be 'raise' or 'nan', got {errors!r}")
    return errors == "raise"


def check_threads(threads: int | None) -> int:
    """Return the number of threads; 0 means all of the machine."""
    if threads is None:
        return 0
    if not is_whole(threads) or not 1 <= threads < 2**31:
        raise InvalidInput(f"threads: must be a positive whole number below 2^31, got {threads!r}")
    return int(threads)
