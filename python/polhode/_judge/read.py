"""Samples as they were given: checks, norms, signs, and how many digits they have."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from .._attitude.rotation import Rotation
from .._core import InvalidInput
from .findings import Finding
from .states import Array

SEQUENCES = tuple(a + b + c for a in "XYZ" for b in "XYZ" for c in "XYZ" if a != b != c)


@dataclasses.dataclass(eq=False)
class Samples:
    """Samples in polhode's conventions as far as they are known. `angles` are Euler angles as they were given [rad]."""

    t: Array
    omega: Array | None
    attitude: Array | None
    angles: Array | None = None
    euler: str = ""
    space: bool = False
    floor: tuple[float, float] = (0.0, 0.0)  # of the rates [rad/s] and the attitude [rad]
    norm_off: Array | None = None

    def take(self, which: slice) -> Samples:
        """Return these samples alone."""
        t, omega, attitude, angles, norm_off = (
            None if array is None else array[which]
            for array in (self.t, self.omega, self.attitude, self.angles, self.norm_off)
        )
        assert t is not None
        return dataclasses.replace(self, t=t, omega=omega, attitude=attitude, angles=angles, norm_off=norm_off)


def numbers(value: Any, name: str, width: tuple[int, ...]) -> Array:
    """Return an array of samples, or refuse its shape or type."""
    if isinstance(value, type) or callable(value):
        raise InvalidInput(f"{name}: must be an array of numbers, got {type(value).__name__}")
    try:
        array = np.asarray(value)
        array = array.astype(float) if array.dtype.kind in "fiub" else np.zeros(())
        masked = np.ma.is_masked(value)
    except MemoryError:
        raise
    except Exception:  # a ragged list, or an object that fails as an array
        array, masked = np.zeros(()), False
    if not array.ndim:
        raise InvalidInput(f"{name}: must be an array of numbers, got {type(value).__name__}")
    if masked:
        raise InvalidInput(f"{name}: must be without masked entries; leave them out, or give them a value")
    if array.shape[1:] != width or array.ndim != 1 + len(width):
        shape = ", ".join(map(str, ("n", *width)))
        raise InvalidInput(f"{name}: must be of shape ({shape}{',' if not width else ''}), got {array.shape}")
    return array


def read(
    t: Any, attitude: Any, omega: Any, order: str, frame: str, euler: str | None, degrees: bool
) -> tuple[Samples | None, list[Finding]]:
    """Return the samples and what is wrong with them as data. None stands for samples that cannot be judged."""
    if attitude is None and omega is None:
        raise InvalidInput("attitude: must be given, or omega, or both; got neither")
    if not (isinstance(order, str) and order in ("xyzw", "wxyz")):
        raise InvalidInput(f"order: must be 'xyzw' or 'wxyz', got {order!r}")
    if not (isinstance(frame, str) and frame in ("body", "space")):
        raise InvalidInput(f"frame: must be 'body' or 'space', got {frame!r}")
    if euler is not None and (
        not isinstance(euler, str) or euler.upper() not in SEQUENCES or euler not in (euler.upper(), euler.lower())
    ):
        raise InvalidInput(f"euler: must be one of the 24 sequences such as 'ZYX' or 'zyx', got {euler!r}")
    if not isinstance(degrees, (bool, np.bool_)):
        raise InvalidInput(f"degrees: must be True or False, got {degrees!r}")
    times = numbers(t, "t", ())
    quats, angles = _attitudes(attitude, euler)
    rates = None if omega is None else numbers(omega, "omega", (3,))
    given = {"attitude": quats, "omega": rates, "attitude ": angles}
    for name, array in given.items():
        if array is not None and len(array) != len(times):
            raise InvalidInput(f"{name.strip()}: must have a row for each of the {len(times)} times, got {len(array)}")
    if len(times) < 2:
        raise InvalidInput(f"t: must have at least 2 times, got {len(times)}")
    findings: list[Finding] = []
    everything = [a.reshape(len(times), -1) for a in (times, quats, rates, angles) if a is not None]
    bad = np.flatnonzero(~np.all([np.all(np.isfinite(a), axis=1) for a in everything], axis=0))
    if len(bad):
        findings.append(
            Finding(
                "finite",
                f"{len(bad)} of {len(times)} samples have NaN or inf, the first in sample {bad[0]}",
                size=len(bad),
                where=tuple(map(int, bad[:100])),
                cure="leave them out",
            )
        )
    still = np.flatnonzero(np.diff(times) <= 0)
    if len(still) and not len(bad):
        equal = int(np.sum(np.diff(times) == 0))
        words = "equal" if equal == len(still) else "not ascending"
        findings.append(
            Finding(
                "time",
                f"{len(still)} times are {words}, the first at sample {still[0] + 1}",
                size=len(still),
                where=tuple(int(k) + 1 for k in still[:100]),
                cure="sort the samples, or give each its own time",
            )
        )
    if findings:
        return None, findings
    unit = np.pi / 180 if degrees else 1.0
    steps = [
        _step(quats) if quats is not None else _step(angles) * unit if angles is not None else 0.0,
        _step(rates) * unit if rates is not None else 0.0,
    ]
    single = [_is_single(quats if quats is not None else angles), _is_single(rates)]
    if any(single):
        words = " and ".join(what for what, yes in zip(("attitudes", "rates"), single, strict=True) if yes)
        findings.append(Finding("float32", f"{words} are in single precision", size=6e-8))
    samples = Samples(
        times, rates * unit if rates is not None else None, quats, euler=euler or "", space=frame == "space"
    )
    if angles is not None:
        samples.angles = angles * unit
        samples.attitude = Rotation.from_euler(euler or "ZYX", samples.angles).as_quat()
        jumps = np.flatnonzero(np.any(np.abs(np.diff(samples.angles, axis=0)) > 5.0, axis=1))
        if len(jumps):
            findings.append(
                Finding(
                    "wraps",
                    f"angles jump by whole turns at {len(jumps)} samples",
                    size=len(jumps),
                    where=tuple(int(k) + 1 for k in jumps[:100]),
                )
            )
    elif quats is not None:
        if order == "wxyz":
            samples.attitude = quats = np.roll(quats, -1, axis=1)
        wrong = _norms(samples, quats, findings, _step(quats))
        if wrong is not None:
            return None, [*findings, wrong]
    _floors(samples, steps, single, findings, rates, unit)
    return samples, findings


def _attitudes(attitude: Any, euler: str | None) -> tuple[Array | None, Array | None]:
    """Return quaternions as given, or Euler angles."""
    if attitude is None:
        return None, None
    if hasattr(attitude, "as_quat") and not isinstance(attitude, type):  # a Rotation, also SciPy's
        attitude = np.atleast_2d(attitude.as_quat())
    try:
        shape = np.asarray(attitude).shape
    except MemoryError:
        raise
    except Exception:  # an object that fails as an array
        shape = ()
    if euler is not None:
        return None, numbers(attitude, "attitude", (3,))
    if len(shape) == 3:
        return _from_matrices(numbers(attitude, "attitude", (3, 3))), None
    if len(shape) == 2 and shape[1] == 3:
        raise InvalidInput(
            "attitude: three numbers a sample are Euler angles: give their sequence, such as euler='ZYX'"
        )
    return numbers(attitude, "attitude", (4,)), None


def _from_matrices(matrices: Array) -> Array:
    """Return quaternions of matrices; one that is no rotation becomes a quaternion of length 0."""
    finite = np.all(np.isfinite(matrices), axis=(1, 2))
    off = np.full(len(matrices), np.inf)
    good = matrices[finite]
    off[finite] = np.abs(good @ np.swapaxes(good, 1, 2) - np.eye(3)).max(axis=(1, 2))
    mirrored = np.zeros(len(matrices), bool)
    mirrored[finite] = np.linalg.det(good) < 0
    fine = (off < 0.2) & ~mirrored
    out = np.where(finite[:, None], 0.0, np.nan) * np.ones((1, 4))
    if fine.any():
        u, _, v = np.linalg.svd(matrices[fine])
        out[fine] = (
            Rotation.from_matrix(u @ v).as_quat() * (1 + 0.5 * np.where(off[fine] > 1e-6, off[fine], 0))[:, None]
        )
    return out


def _norms(samples: Samples, quats: Array, findings: list[Finding], digit: float) -> Finding | None:
    size = np.linalg.norm(quats, axis=1)
    off = np.abs(size - 1)
    worst = int(np.argmax(off))
    if off[worst] > 0.1:
        wrong = np.flatnonzero(off > 0.1)
        return Finding(
            "no rotation",
            f"{len(wrong)} attitudes are no rotation, the first in sample {wrong[0]}: a "
            f"quaternion of length {size[wrong[0]]:.3g}, or a matrix that is mirrored or not orthogonal",
            size=float(off[worst]),
            where=tuple(map(int, wrong[:100])),
            cure="give unit quaternions, or orthogonal matrices with determinant 1",
        )
    if off[worst] > max(1e-6, 2 * digit):
        findings.append(
            Finding(
                "norm",
                f"quaternions are off unit length by up to {off[worst]:.3g}, most in sample {worst}",
                size=float(off[worst]),
                where=(worst,),
                effect=float(off[worst]),
                cure="normalise the quaternion after each step",
            )
        )
    samples.norm_off = off
    unit = quats / size[:, None]
    flips = np.sum(unit[1:] * unit[:-1], axis=1) < 0
    if flips.any():
        findings.append(
            Finding(
                "sign flips",
                f"quaternions change sign at {int(flips.sum())} samples, which changes no rotation",
                size=int(flips.sum()),
                where=tuple(int(k) + 1 for k in np.flatnonzero(flips)[:100]),
            )
        )
        unit = unit * np.concatenate([[1.0], np.cumprod(np.where(flips, -1.0, 1.0))])[:, None]
    samples.attitude = unit
    return None


def _step(values: Array | None) -> float:
    """Return the decimal step of numbers with few digits, 0 for full precision. Columns of few values tell nothing."""
    if values is None:
        return 0.0
    some = values.reshape(len(values), -1)[:: max(1, len(values) // 1000)]
    some = np.concatenate([np.zeros(0), *(column for column in some.T if len(np.unique(column)) > 0.3 * len(column))])
    top = float(np.max(np.abs(some), initial=0.0))
    if top == 0:
        return 0.0
    for digits in range(10):
        step = 10.0 ** (np.floor(np.log10(top)) - digits)
        if np.all(np.abs(some / step - np.round(some / step)) < 1e-4):
            return float(step)
    significant = _significant(some)
    return float(top * 10.0 ** (1 - significant) / 2) if significant <= 12 else 0.0


def _has_few_values(values: Array) -> bool:
    """Return True if all columns have few values, so that they do not show how many digits there are."""
    some = values[:: max(1, len(values) // 1000)]
    return all(len(np.unique(column)) <= 0.3 * len(column) for column in some.T)


def _significant(values: Array) -> int:
    """Return how many decimal digits the numbers have, up to 17."""
    some = values[values != 0][:400]
    return next((digits for digits in range(3, 13) if all(float(f"{x:.{digits - 1}e}") == x for x in some)), 17)


def _floors(
    samples: Samples, steps: list[float], single: list[bool], findings: list[Finding], rates: Array | None, unit: float
) -> None:
    """Set how far off the samples may be by their digits alone, and say that they are few."""
    attitude, omega = steps
    if rates is not None and not omega and attitude and _has_few_values(rates):
        omega = attitude  # of the same file, with as many decimals
    coarse = [(step, what) for step, what in ((attitude, "in the attitude"), (omega, "rad/s")) if step]
    if coarse:
        findings.append(
            Finding(
                "digits",
                "numbers have few digits: steps of " + " and ".join(f"{step:.0e} {what}" for step, what in coarse),
                size=max(step for step, _ in coarse),
            )
        )
    if single[0]:
        attitude = max(attitude, 6e-8)
    if single[1] and rates is not None:
        omega = max(omega, 6e-8 * float(np.max(np.abs(rates))) * unit)
    samples.floor = 0.6 * omega, 1.2 * attitude


def _is_single(values: Array | None) -> bool:
    return values is not None and bool(np.array_equal(values, values.astype(np.float32)))
