"""The free step of many bodies: kicks by torques, and the exact free motion between them."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core
from .._attitude.arrays import is_one_of, is_rotation, is_whole, to_any, to_number
from .._attitude.rotation import Rotation
from .._core import InertiaTensor, InvalidInput
from .broadcast import check_threads, require_apart

Floats = npt.NDArray[Any]
Torque = npt.ArrayLike | Callable[[Floats, Floats], npt.ArrayLike]
SINGLE, DOUBLE = np.dtype(np.float32), np.dtype(np.float64)


def _find_dtype(given: dict[str, Any]) -> np.dtype[Any]:
    """Return the type that the caller's arrays share; plain numbers take that of the arrays."""
    types = {name: value.dtype for name, value in given.items() if isinstance(value, np.ndarray)}
    for name, dtype in types.items():
        if dtype not in (SINGLE, DOUBLE):
            raise InvalidInput(f"{name}: must be an array of float32 or float64, got dtype {dtype}")
    if len(set(types.values())) > 1:
        found = ", ".join(f"{name} {dtype}" for name, dtype in types.items())
        raise InvalidInput(f"momentum: must have the dtype of attitude and of out, got {found}")
    return next(iter(types.values()), DOUBLE)


def _to_rows(value: Any, name: str, width: int, dtype: np.dtype[Any]) -> Floats:
    """Return an array of shape (..., width); NaN and inf pass."""
    array = to_any(value.as_quat() if is_rotation(value) else value, name, "fiu")
    if array.ndim == 0 or array.shape[-1] != width:
        raise InvalidInput(f"{name}: must be an array of shape (..., {width}), got shape {array.shape}")
    return array.astype(dtype, copy=False)


def _to_attitudes(value: Any, dtype: np.dtype[Any]) -> Floats:
    array = _to_rows(value, "attitude", 4, dtype)
    if not is_rotation(value) and array.size and (array.reshape(-1, 4)[0] == (1, 0, 0, 0)).all() and (
            array == (1, 0, 0, 0)).all():
        warnings.warn("attitude: (1, 0, 0, 0) is a half turn about x, as quaternions are (x, y, z, w) here. A Rotation "
                      "gives no warning", UserWarning, stacklevel=3)
    return array


def _to_principal(inertia: Any, dtype: np.dtype[Any]) -> tuple[Floats, Floats | None]:
    """Return principal moments, and the quaternions from principal to body axes; None where these agree."""
    if isinstance(inertia, InertiaTensor):
        moments, axes = inertia.moments, inertia.axes
    elif isinstance(inertia, Sequence) and inertia and all(isinstance(one, InertiaTensor) for one in inertia):
        moments, axes = np.array([one.moments for one in inertia]), np.array([one.axes for one in inertia])
    else:
        return _to_rows(inertia, "inertia", 3, dtype), None
    if (axes == np.eye(3)).all():
        return moments.astype(dtype), None
    return moments.astype(dtype), Rotation.from_matrix(axes).as_quat()


def _multiply(p: Floats, q: Floats) -> Floats:
    """Return p q of quaternions (..., 4), as many as p has."""
    kernel = _core._multiply_f if p.dtype == SINGLE else _core._multiply_d
    return kernel(p, q if q.ndim == 1 else np.broadcast_to(q, p.shape))


def _rotate(q: Floats, v: Floats) -> Floats:
    """Return R(q) v."""
    t = 2 * np.cross(q[..., :3], v)
    return np.asarray(v + q[..., 3:] * t + np.cross(q[..., :3], t))


def _conjugate(q: Floats) -> Floats:
    return np.asarray(q * np.array((-1, -1, -1, 1), q.dtype))


def _check_out(out: Any, shape: tuple[int, ...], dtype: np.dtype[Any]) -> tuple[Floats, Floats]:
    given = tuple(out) if isinstance(out, (tuple, list)) else (out,)
    if len(given) != 2:
        raise InvalidInput(f"out: must be two arrays, for momentum and attitude, got {len(given)}")
    for name, array, width in (("momentum", given[0], 3), ("attitude", given[1], 4)):
        if not (isinstance(array, np.ndarray) and array.dtype == dtype and array.shape == (*shape, width)
                and array.flags.writeable):
            found = f"{array.dtype} of shape {array.shape}" if isinstance(array, np.ndarray) else type(array).__name__
            raise InvalidInput(f"out: must be a writeable {dtype} array of shape {(*shape, width)} for {name}, got "
                               f"{found}")
    require_apart(given)
    return given[0], given[1]


def _is_plain(array: Floats) -> bool:
    return bool(array.flags.c_contiguous and array.flags.aligned)


def _copy(array: Floats, shape: tuple[int, ...]) -> Floats:
    return np.array(np.broadcast_to(array, shape), order="C")


def _to_flat(array: Floats, shape: tuple[int, ...]) -> Floats:
    """Return rows (bodies, 3), or (3) where all bodies share them."""
    if array.ndim == 1:
        return np.ascontiguousarray(array)
    flat = np.broadcast_to(array, (*shape, 3))
    return np.require(flat.reshape(-1, 3), requirements=["C", "A"])


def _call(torque: Callable[[Floats, Floats], npt.ArrayLike], L: Floats, q: Floats, shape: tuple[int, ...],
          dtype: np.dtype[Any]) -> Floats:
    tau = _to_rows(torque(L, q), "torque", 3, dtype)
    try:
        np.broadcast_to(tau, (*shape, 3))
    except ValueError:
        raise InvalidInput(f"torque: must return an array that broadcasts to shape {(*shape, 3)}, got {tau.shape}"
                           ) from None
    return tau


class _Axes:
    """Between body axes and principal axes, for bodies with a full tensor."""

    def __init__(self, q_BP: Floats | None, frame: str, dtype: np.dtype[Any]) -> None:
        self._q_BP = None if q_BP is None else q_BP.astype(dtype)
        self._body = frame == "body"

    def enter(self, L: Floats, q: Floats) -> None:
        """Convert to principal axes, in place."""
        if self._q_BP is not None:
            q[...] = _multiply(q, self._q_BP)
            L[...] = self.torque(L)

    def torque(self, vectors: Floats) -> Floats:
        """Return vectors of `frame` in the axes that the core takes."""
        if self._q_BP is None or not self._body:
            return vectors
        return _rotate(_conjugate(self._q_BP), vectors)

    def leave(self, L: Floats, q: Floats) -> tuple[Floats, Floats]:
        """Return the state in body axes."""
        if self._q_BP is None:
            return L, q
        return _rotate(self._q_BP, L) if self._body else L, _multiply(q, _conjugate(self._q_BP))


def _count(count: Any) -> int:
    if not is_whole(count) or not 0 <= count < 2**62:
        raise InvalidInput(f"count: must be a whole number of steps >= 0, got {count!r}")
    return int(count)


def step(
    inertia: InertiaTensor | Sequence[InertiaTensor] | npt.ArrayLike,
    momentum: npt.ArrayLike,
    attitude: Any,
    h: float,
    *,
    torque: Torque | None = None,
    frame: str = "space",
    count: int = 1,
    out: Any = None,
    threads: int | None = None,
) -> tuple[Floats, Floats]:
    """Step many bodies by a fixed step: half a kick, the exact free motion, half a kick.

    The free motion keeps energy and angular momentum to rounding at any step. With torques the step is of order 2 and
    symplectic where they have a potential. All arrays broadcast over the bodies.

    Parameters
    ----------
    inertia : array_like, shape (..., 3), or InertiaTensor, or a sequence of them
        Principal moments in the body axes, in any order [kg m^2]; or one full tensor for all bodies, or one for each.
    momentum : array_like, shape (..., 3)
        Angular momentum about the centre of mass or the pivot, in `frame` [N m s]. float32 or float64.
    attitude : array_like, shape (..., 4), or Rotation
        Attitude, body to space, unit, (x, y, z, w). Of the same dtype.
    h : float
        Time step [s], of either sign. Use steps below 5 rad: beyond, the phase of the nutation is wrong.
    torque : array_like, shape (..., 3), or callable, optional
        Torque in `frame` [N m], constant over the call. Or ``torque(momentum, attitude)``, called before each free
        motion and after the last one, which returns such an array.
    frame : {'space', 'body'}
        Axes of momentum and torque.
    count : int
        Number of steps.
    out : tuple of two ndarray, optional
        Where momentum and attitude are written. They may be the arrays given: then the bodies are stepped in place.
    threads : int, optional
        At most this many; by default as many as the machine has. The bits of the result do not depend on it.

    Returns
    -------
    momentum : ndarray, shape (..., 3)
        In `frame` [N m s].
    attitude : ndarray, shape (..., 4)
        Body to space, unit, (x, y, z, w).

    Raises
    ------
    InvalidInput
        Shapes that do not broadcast, a dtype other than float32 or float64, moments that no body has, attitudes that
        are not unit, h that is not finite, or a body that may rotate by more than 1e25 rad in a step (1e10 rad in
        float32). Nothing is written then.

    Notes
    -----
    A body whose momentum or torque is not finite comes out as NaN, and no other does. The bits are the same for AVX2
    and AVX-512. See docs/step.md for the formulas and their errors.
    """
    workers, steps, size = check_threads(threads), _count(count), to_number(h, "h", "one time step [s]")
    if not is_one_of(frame, ("space", "body")):
        raise InvalidInput(f"frame: must be 'space' or 'body', got {frame!r}")
    given = {"momentum": momentum, "attitude": attitude}
    dtype = _find_dtype(given)
    moments, q_BP = _to_principal(inertia, dtype)
    L, q = _to_rows(momentum, "momentum", 3, dtype), _to_attitudes(attitude, dtype)
    fixed = None if torque is None or callable(torque) else _to_rows(torque, "torque", 3, dtype)
    loops = [array.shape[:-1] for array in (moments, L, q, fixed) if array is not None]
    try:
        shape = np.broadcast_shapes(*loops)
    except ValueError:
        raise InvalidInput(f"momentum: must broadcast with inertia, attitude and torque, got shapes "
                           f"{', '.join(map(str, loops))}") from None
    targets = None if out is None else _check_out(out, shape, dtype)

    # The core works in place, on plain arrays in principal axes.
    in_place = targets is not None and q_BP is None and targets[0] is L and targets[1] is q and all(
        map(_is_plain, targets)) and not any(
        np.may_share_memory(target, other) for target in targets for other in (moments, fixed) if other is not None)
    if in_place:
        new_L, new_q = L, q
    else:
        new_L, new_q = _copy(L, (*shape, 3)), _copy(q, (*shape, 4))
    axes = _Axes(q_BP, frame, dtype)
    axes.enter(new_L, new_q)

    kernel = _core._step_f if dtype == SINGLE else _core._step_d
    rows_L, rows_q = new_L.reshape(-1, 3), new_q.reshape(-1, 4)
    rows_I = _to_flat(moments, shape)

    def advance(tau: Floats | None, number: int, first: float, last: float) -> None:
        flat = None if tau is None else _to_flat(axes.torque(tau), shape)
        kernel(rows_I, rows_L, rows_q, size, flat, frame == "space", number, first, last, workers)

    if callable(torque):
        advance(None, 0, 0.0, 0.0)   # refuses bad values before the first call
        for number in range(steps):
            advance(_call(torque, *axes.leave(new_L, new_q), shape, dtype), 1, 0.5 if number == 0 else 1.0, 0.0)
        if steps:
            tau = _call(torque, *axes.leave(new_L, new_q), shape, dtype)
            new_L += dtype.type(0.5 * size) * axes.torque(tau)
    else:
        advance(fixed, steps, 0.5, 0.5)
    new_L, new_q = axes.leave(new_L, new_q)
    if targets is None or in_place:
        return new_L, new_q
    targets[0][...], targets[1][...] = new_L, new_q
    return targets
