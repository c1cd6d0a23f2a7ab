"""The parts of `Rotation` in NumPy: means, alignments, and modified Rodrigues parameters."""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Collection
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from .._core import InvalidInput
from .._core import attitude as _kernels

FloatArray = NDArray[np.float64]


def to_any(value: Any, name: str, kinds: str = "fiub") -> NDArray[Any]:
    """Return an array of real numbers of these kinds of types."""
    # Only who has imported numpy.ma has masked arrays. To import it here would cost 20 ms, and hang a process that is
    # forked meanwhile.
    masked = getattr(sys.modules.get("numpy.ma"), "MaskedArray", None)
    if masked is not None and isinstance(value, masked) and np.ma.is_masked(value):
        count = np.ma.getmaskarray(value).sum()
        raise InvalidInput(f"{name}: must be without masked entries, got {count} of them (leave them out, or give them "
                           "a value by .filled())")
    try:
        array = np.asarray(value)
    except MemoryError:
        raise
    except Exception:   # a ragged list, or an object that fails as an array
        array = np.empty(0, dtype=object)
    if array.dtype.kind not in kinds:
        raise InvalidInput(f"{name}: must be an array of real numbers, got dtype {array.dtype}")
    return array


def to_numbers(value: Any, name: str) -> FloatArray:
    """Return a float64 array; NaN and inf pass."""
    numbers = to_any(value, name).astype(np.float64, copy=False)
    if _core.flushes_to_zero():
        _core.require_kept(numbers, name)
    return numbers


def to_number(value: Any, name: str, what: str = "one number") -> float:
    """Return one number; NaN and inf pass."""
    array = to_numbers(value, name)
    if array.size != 1:
        raise InvalidInput(f"{name}: must be {what}, got an array of shape {array.shape}")
    return float(array.reshape(-1)[0])


def is_rotation(value: Any) -> bool:
    """Return True for an object that gives quaternions: polhode's Rotation, or SciPy's."""
    return hasattr(value, "as_quat") and not isinstance(value, type)


def require_bool(value: Any, name: str) -> bool:
    """Return a bool, also of 0 and 1; the truth of other objects may not be what was meant."""
    if not isinstance(value, (bool, np.bool_)) and not (is_whole(value) and value in (0, 1)):
        raise InvalidInput(f"{name}: must be True or False, got {type(value).__name__}")
    return bool(value)


def is_whole(value: Any) -> bool:
    """Return True for an integer; a bool is none, nor is a span of time, which NumPy derives from its integers."""
    return isinstance(value, (int, np.integer)) and not isinstance(value, (bool, np.timedelta64))


def is_one_of(value: Any, choices: Collection[str]) -> bool:
    """Return True for one of these texts. An array that is compared with a text has no truth value."""
    return isinstance(value, str) and value in choices


def to_items(value: Any, name: str, what: str) -> tuple[Any, ...]:
    """Return the items; a number, an array of no dimensions and a single rotation have none."""
    try:
        items = iter(value)
    except TypeError:
        raise InvalidInput(f"{name}: must be {what}, got {type(value).__name__}") from None
    return tuple(items)


def require_text(value: Any, name: str) -> None:
    """Refuse a text that the core cannot take: parts of file names may have no UTF-8."""
    if isinstance(value, str) and not value.isascii():
        raise InvalidInput(f"{name}: must be of ASCII letters, got {value!r}")


def to_vectors(value: Any, name: str) -> FloatArray:
    """Return a finite array of shape (..., 3)."""
    array = to_numbers(value, name)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise InvalidInput(f"{name}: must be an array of shape (..., 3), got shape {array.shape}")
    wrong = np.flatnonzero(~np.isfinite(array))
    if wrong.size:
        raise InvalidInput(f"{name}: must be finite, got {array.flat[wrong[0]]} at flat index {wrong[0]}")
    return array


def to_weights(value: Any, shape: tuple[int, ...]) -> FloatArray:
    """Return weights of this shape, relative to the largest finite one; inf passes."""
    weights = np.ones(shape) if value is None else to_numbers(value, "weights")
    try:
        weights = np.broadcast_to(weights, shape)
    except ValueError:
        raise InvalidInput(f"weights: must be of shape {shape}, got shape {weights.shape}") from None
    if not (weights >= 0).all():
        raise InvalidInput(f"weights: must be 0 or more, got {weights[~(weights >= 0)][0]}")
    if not weights.any():
        raise InvalidInput("weights: must hold one above 0, got none")
    return weights


def to_seed(rng: Any) -> Any:
    """Return what NumPy makes a generator of. It crashes on a list that holds itself."""
    if rng is None or isinstance(rng, (np.random.Generator, np.random.BitGenerator, np.random.SeedSequence)):
        return rng
    seed = to_any(rng, "rng", "iu")
    if (seed < 0).any():
        raise InvalidInput(f"rng: must be a generator or a seed >= 0, got {rng!r}")
    return seed.tolist()


def to_exponents(n: ArrayLike, shape: tuple[int, ...]) -> FloatArray:
    """Return finite exponents that broadcast with a shape; one in an array of shape (1,) is a number."""
    power = to_numbers(n, "exponent")
    if not np.isfinite(power).all():
        raise InvalidInput(f"exponent: must be finite, got {power[~np.isfinite(power)].flat[0] if power.ndim else n}")
    if power.shape == (1,):
        return power.reshape(())
    try:
        np.broadcast_shapes(power.shape, shape)
    except ValueError:
        raise InvalidInput(f"exponent: must be one number or broadcast to the shape {shape} of the rotations, got "
                           f"shape {power.shape}") from None
    return power


def to_shape(num: int | None, shape: int | tuple[int, ...] | None) -> tuple[int, ...]:
    """Return the shape of an array of rotations, given as a number or as itself."""
    if num is not None and shape is not None:
        raise InvalidInput("num: must be left out where shape is given, got both")
    sizes = num if num is not None else shape if shape is not None else ()
    sizes = sizes if isinstance(sizes, tuple) else (sizes,)
    if not all(is_whole(size) and size >= 0 for size in sizes):
        raise InvalidInput(f"{'shape' if num is None else 'num'}: must be whole numbers >= 0, got {sizes}")
    if math.prod(sizes) > sys.maxsize // 32:   # four numbers each
        raise MemoryError(f"{math.prod(sizes)} rotations need {32 * math.prod(sizes)} bytes")
    return sizes


def mean(quat: FloatArray, weights: ArrayLike | None) -> FloatArray:
    """Return the unit quaternion q with the largest weighted sum of (q . q_i)^2; its sign does not matter.

    Markley, Cheng, Crassidis and Oshman 2007, J. Guidance, Control, and Dynamics 30, 1193.
    """
    if quat.size == 0:
        raise InvalidInput("rotations: must be one or more for a mean, got none")
    scale = to_weights(weights, quat.shape[:-1]).reshape(-1, 1)
    if np.isinf(scale).any():
        raise InvalidInput("weights: must be finite for a mean, got inf")
    rows = quat.reshape(-1, 4)
    # By our own Jacobi: it errs less than LAPACK, whose last bits differ between the builds of NumPy.
    moments = ((scale / scale.max() * rows).T @ rows)[np.triu_indices(4)]
    found: FloatArray = _core._mean_attitude(moments)[0]
    return found


def spread(quat: FloatArray, weights: ArrayLike | None) -> float:
    """Return 2 asin of the root of the weighted mean of sin^2(angle / 2), of the angles from the mean rotation."""
    x, y, z, w = mean(quat, weights)
    scale = to_weights(weights, quat.shape[:-1]).reshape(-1)
    # The vector part of conj(mean) q, which keeps the digits of small angles.
    rows = np.array([[w, z, -y, -x], [-z, w, x, -y], [y, -x, w, -z]])
    square = ((quat.reshape(-1, 4) @ rows.T) ** 2).sum(axis=1)
    scale = scale / scale.max()
    return float(2 * np.arcsin(min(1.0, np.sqrt((scale * square).sum() / scale.sum()))))


def shortest(u: FloatArray, v: FloatArray) -> FloatArray:
    """Return the quaternion of the smallest rotation that takes unit vector u to v, or of some half turn."""
    apart, together = v - u, v + u
    # u x v without cancellation, whether v is next to u or to -u.
    axis = np.cross(u, apart if u @ v > 0 else together)
    length = np.linalg.norm(axis)
    if length == 0:
        axis = np.cross(u, np.eye(3)[np.argmin(np.abs(u))])
        length = np.linalg.norm(axis)
    return np.array([*(axis / length * (np.linalg.norm(apart) / 2)), np.linalg.norm(together) / 2])


def align(a: ArrayLike, b: ArrayLike, weights: ArrayLike | None) -> tuple[FloatArray, float]:
    """Return the quaternion that best takes vectors b to a, and the residual; see `Rotation.align_vectors`."""
    target, source = (np.atleast_2d(to_vectors(value, name)) for name, value in (("a", a), ("b", b)))
    if target.ndim > 2 or target.shape != source.shape or len(target) == 0:
        raise InvalidInput("a, b: must be one vector each, or equally many of shape (n, 3), got shapes "
                           f"{np.shape(a)} and {np.shape(b)}")
    weight = to_weights(weights, (len(target),))
    exact = np.isinf(weight) if len(target) > 1 else np.array([True])
    if exact.sum() > 1:
        raise InvalidInput(f"weights: must hold one inf at most, got {exact.sum()}")
    finite = np.where(np.isinf(weight), 0.0, weight)
    quat = _align_exactly(target, source, finite, exact) if exact.any() else _align_all(target, source, finite)
    left = target - _kernels.apply(quat, source, False)
    size = float(np.abs(left).max()) or 1.0
    return quat, size * float(np.sqrt(finite @ ((left / size) ** 2).sum(axis=1)))


def _scaled(rows: FloatArray) -> FloatArray:
    """Scale rows by the largest entry, so that nothing overflows."""
    return rows / (np.abs(rows).max() or 1.0)


OPEN = "a, b: these vectors leave the rotation open; one of the best is returned"


def _align_all(a: FloatArray, b: FloatArray, weights: FloatArray) -> FloatArray:
    """Kabsch 1978, Acta Crystallographica A34, 827: the rotation next to the weighted sum of a b^T."""
    u, s, vh = np.linalg.svd((weights[:, None] / weights.max() * _scaled(a)).T @ _scaled(b))
    sign = 1.0 if np.linalg.det(u) * np.linalg.det(vh) > 0 else -1.0
    if s[1] + sign * s[2] <= 8 * np.finfo(float).eps * s[0]:
        warnings.warn(OPEN, UserWarning, stacklevel=4)
    return _kernels.from_matrix(u * [1.0, 1.0, sign] @ vh)


def _align_exactly(a: FloatArray, b: FloatArray, weights: FloatArray, exact: Any) -> FloatArray:
    """Align one pair exactly; the other pairs determine the rotation about it."""
    first = int(np.flatnonzero(exact)[0])
    if not (a[first].any() and b[first].any()):
        raise InvalidInput(f"a, b: must not be zero where the alignment is exact, got it at {first}")
    u, v = (_scaled(row) / np.linalg.norm(_scaled(row)) for row in (b[first], a[first]))
    quat = _kernels.normalize(shortest(u, v), False)
    if not weights.any() or len(a) == 1:
        return quat
    weights, p, q = weights / weights.max(), _scaled(a), _kernels.apply(quat, _scaled(b), False)
    across = np.cross(q, p) @ v
    along = (p * q).sum(axis=1) - (p @ v) * (q @ v)
    sine, cosine = weights @ across, weights @ along
    # Rounding alone, as where other vectors lie along the exact one: all rotations are as good, and none is shortest.
    if np.hypot(sine, cosine) <= 8 * np.finfo(float).eps * float(weights @ (np.linalg.norm(p, axis=1) *
                                                                          np.linalg.norm(q, axis=1))):
        warnings.warn(OPEN, UserWarning, stacklevel=4)
        return quat
    return _kernels.multiply(_kernels.from_rotvec(np.arctan2(sine, cosine) * v, False), quat)


def as_mrp(quat: FloatArray) -> FloatArray:
    """Return e tan(angle / 4), of length 1 at most."""
    q = _kernels.canonical(quat)
    found: FloatArray = q[..., :3] / (1.0 + q[..., 3:])
    return found


def from_mrp(mrp: ArrayLike) -> FloatArray:
    """Return the quaternions of e tan(angle / 4); long ones by their shadows -p / |p|^2, so that nothing overflows."""
    p = to_vectors(mrp, "mrp")
    size = np.maximum(np.abs(p).max(axis=-1, keepdims=True), 1.0)
    n = p / size
    square = (n**2).sum(axis=-1, keepdims=True)
    p = np.where(square * size > 1 / size, -n / (np.where(square > 0, square, 1.0) * size), p)
    square = (p**2).sum(axis=-1, keepdims=True)
    found: FloatArray = np.concatenate([2 * p, 1 - square], axis=-1) / (1 + square)
    return found
