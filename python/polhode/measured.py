"""What was measured of a rotating body, for :func:`polhode.fit`. NaN samples are left out and counted."""

from __future__ import annotations

import abc
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from ._attitude.arrays import to_numbers
from ._core import InvalidInput
from ._sensitivity import rotations

Array = npt.NDArray[np.float64]

__all__ = ["Attitudes", "Axis", "Direction", "Measurement", "Rates", "Scalar"]


class Measurement(abc.ABC):
    """Samples of one sensor.

    Parameters
    ----------
    t : array_like, shape (n,)
        Times [s]; 0 is the start of the motion that is fitted.
    y : array_like, shape (n, width) or (n,)
        The samples. Those with a NaN are left out; `left_out` is their number.
    sigma : array_like
        Standard deviation of the noise: one number; (width,) for each component; (n,) or (n, 1) for each sample; (n,
        width); or a covariance, (width, width) or (n, width, width). Three numbers of a sensor with three components
        are one for each component.
    """

    width = 3      # numbers of y a sample
    residuals = 3  # numbers of a residual
    bias = 0       # parameters of the sensor itself

    def __init__(self, t: npt.ArrayLike, y: npt.ArrayLike, sigma: npt.ArrayLike) -> None:
        times, values = to_numbers(t, "t"), to_numbers(y, "y")
        if times.ndim != 1:
            raise InvalidInput(f"t: must be of shape (n,), got {times.shape}")
        shape = (times.size,) if self.width == 1 else (times.size, self.width)
        if values.shape != shape:
            raise InvalidInput(f"y: must be of shape {shape}, one row for each time, got {values.shape}")
        deviation = to_numbers(sigma, "sigma")
        whitener = _to_whitener(deviation, times.size, self.residuals)
        good = np.isfinite(times) & np.isfinite(values.reshape(times.size, -1)).all(axis=1)
        good &= np.isfinite(whitener).all(axis=(1, 2))
        order = np.flatnonzero(good)[np.argsort(times[good], kind="stable")]
        self.left_out = int(times.size - order.size)
        self.t: Array = times[order]
        self.y: Array = values[order]
        self.whitener: Array = whitener[order]
        self.correlated = deviation.ndim >= 2 and deviation.shape[-2:] == (self.residuals, self.residuals) != (1, 1)

    def __len__(self) -> int:
        return int(self.t.size)

    def part(self, until: float) -> Measurement:
        """Return the samples with abs(t) <= until."""
        return self.taken(np.abs(self.t) <= until)

    def taken(self, chosen: Any) -> Measurement:
        """Return the samples of a mask or of indices."""
        other = object.__new__(type(self))
        other.__dict__.update(self.__dict__)
        other.t, other.y, other.whitener = self.t[chosen], self.y[chosen], self.whitener[chosen]
        return other

    def whiten(self, values: Array) -> Array:
        """Divide residuals (n, m) or rows (n, m, k) by sigma."""
        if not self.correlated:
            weights = np.einsum("nii->ni", self.whitener)
            out: Array = values * (weights if values.ndim == 2 else weights[:, :, None])
            return out
        if values.ndim == 2:
            return np.asarray(np.einsum("nij,nj->ni", self.whitener, values))
        return np.asarray(self.whitener @ values)

    @property
    def independent(self) -> int:
        """How many independent numbers were measured."""
        return len(self) * self.residuals

    @abc.abstractmethod
    def residual(self, omega: Array, attitude: Array, bias: Array) -> Array:
        """Return model minus data, shape (n, residuals)."""

    @abc.abstractmethod
    def rows(self, omega: Array, attitude: Array, d_omega: Array, d_attitude: Array) -> Array:
        """Return the derivatives (n, residuals, k) from those of omega and of small rotations in space."""


def _to_whitener(sigma: Array, n: int, width: int) -> Array:
    covariance = (sigma.shape == (width, width) and width > 1) or sigma.shape == (n, width, width)
    if covariance:
        try:
            inverse: Array = np.linalg.inv(np.linalg.cholesky(sigma))
        except np.linalg.LinAlgError:
            raise InvalidInput("sigma: a covariance must be symmetric and positive definite") from None
        return np.broadcast_to(inverse, (n, width, width))
    if (sigma <= 0).any():
        raise InvalidInput(f"sigma: must be positive, got {sigma.min()}")
    if sigma.shape == (n,) and sigma.shape != (width,):
        sigma = sigma[:, None]
    try:
        each = np.broadcast_to(sigma, (n, width))
    except ValueError:
        raise InvalidInput(f"sigma: must be a number, or of shape ({width},), ({n},), ({n}, {width}), ({width}, "
                           f"{width}) or ({n}, {width}, {width}), got {sigma.shape}") from None
    out: Array = np.eye(width) / each[:, :, None]
    return out


class Rates(Measurement):
    """Angular velocity in body axes [rad/s], as a gyroscope measures it: y of shape (n, 3).

    With `bias`, a constant offset of the gyroscope is fitted too. Its scale and a time offset are not.
    """

    def __init__(self, t: npt.ArrayLike, y: npt.ArrayLike, sigma: npt.ArrayLike, bias: bool = False) -> None:
        super().__init__(t, y, sigma)
        self.bias = 3 if bias else 0

    def residual(self, omega: Array, attitude: Array, bias: Array) -> Array:
        """Return omega (+ bias) - y."""
        return omega - self.y + bias if self.bias else omega - self.y

    def rows(self, omega: Array, attitude: Array, d_omega: Array, d_attitude: Array) -> Array:
        """Return the derivatives of omega."""
        return d_omega


class Attitudes(Measurement):
    """Attitudes, body to space: y of shape (n, 4), (x, y, z, w), or a Rotation; sigma of the rotation vector [rad]."""

    width = 4

    def __init__(self, t: npt.ArrayLike, y: Any, sigma: npt.ArrayLike) -> None:
        quaternions = to_numbers(y.as_quat() if hasattr(y, "as_quat") else y, "y")
        super().__init__(t, quaternions, sigma)
        size = np.linalg.norm(self.y, axis=1, keepdims=True)
        if len(self) and not (np.abs(size - 1) < 1e-3).all():
            raise InvalidInput(f"y: attitudes must be unit quaternions, got one of norm {size.min()}")
        self.y = self.y / size

    def residual(self, omega: Array, attitude: Array, bias: Array) -> Array:
        """Return the rotation vector from the measured attitude to that of the model, in body axes."""
        return rotations.log(rotations.product(rotations.conjugate(self.y), attitude))

    def rows(self, omega: Array, attitude: Array, d_omega: Array, d_attitude: Array) -> Array:
        """Return the derivatives of the rotation vector: the inverse right Jacobian times small body rotations."""
        vector = rotations.log(rotations.product(rotations.conjugate(self.y), attitude))
        back = rotations.to_matrix(attitude).transpose(0, 2, 1)
        return rotations.inverse_right_jacobian(vector) @ (back @ d_attitude)


class _Pairs(Measurement):
    """Unit vectors y, and a known one."""

    def __init__(self, t: npt.ArrayLike, y: npt.ArrayLike, sigma: npt.ArrayLike, known: npt.ArrayLike,
                 name: str) -> None:
        super().__init__(t, y, sigma)
        vector = to_numbers(known, name)
        if vector.shape != (3,) or not np.isfinite(vector).all() or not vector.any():
            raise InvalidInput(f"{name}: must be three numbers, not all zero, got {known!r}")
        self.known: Array = vector

    @property
    def independent(self) -> int:
        """Two numbers a sample where y is normalised, else three."""
        unit = len(self) and (np.abs(np.linalg.norm(self.y, axis=1) - 1) < 1e-9).all()
        return len(self) * (2 if unit else 3)


class Axis(_Pairs):
    """A body axis seen in space: y of shape (n, 3) is R axis, with `axis` in body axes."""

    def __init__(self, t: npt.ArrayLike, y: npt.ArrayLike, sigma: npt.ArrayLike, axis: npt.ArrayLike) -> None:
        super().__init__(t, y, sigma, axis, "axis")

    def residual(self, omega: Array, attitude: Array, bias: Array) -> Array:
        """Return R axis - y."""
        return rotations.rotate(attitude, self.known) - self.y

    def rows(self, omega: Array, attitude: Array, d_omega: Array, d_attitude: Array) -> Array:
        """Return d theta_W x R axis."""
        return -rotations.cross_matrix(rotations.rotate(attitude, self.known)) @ d_attitude


class Direction(_Pairs):
    """A known space vector seen in the body, the Sun or the magnetic field: y of shape (n, 3) is R^T direction."""

    def __init__(self, t: npt.ArrayLike, y: npt.ArrayLike, sigma: npt.ArrayLike, direction: npt.ArrayLike) -> None:
        super().__init__(t, y, sigma, direction, "direction")

    def residual(self, omega: Array, attitude: Array, bias: Array) -> Array:
        """Return R^T direction - y."""
        return rotations.rotate(rotations.conjugate(attitude), self.known) - self.y

    def rows(self, omega: Array, attitude: Array, d_omega: Array, d_attitude: Array) -> Array:
        """Return (R^T direction) x d theta_B."""
        seen = rotations.rotate(rotations.conjugate(attitude), self.known)
        return rotations.cross_matrix(seen) @ (rotations.to_matrix(attitude).transpose(0, 2, 1) @ d_attitude)


class Scalar(Measurement):
    """A number that depends on the attitude, as a light curve does: y of shape (n,).

    Parameters
    ----------
    t, y, sigma
        As for the others.
    fun : callable
        fun(attitude) for attitudes of shape (n, 4), giving (n,).
    jac : callable, optional
        jac(attitude), shape (n, 3): the derivative with respect to a small rotation in space axes. By default central
        differences of `fun`.
    """

    width = residuals = 1

    def __init__(self, t: npt.ArrayLike, y: npt.ArrayLike, sigma: npt.ArrayLike, fun: Callable[[Array], npt.ArrayLike],
                 jac: Callable[[Array], npt.ArrayLike] | None = None) -> None:
        super().__init__(t, y, sigma)
        self.fun, self.jac = fun, jac

    def _values(self, attitude: Array) -> Array:
        values = np.asarray(self.fun(attitude), dtype=float)
        if values.shape != (len(attitude),):
            raise InvalidInput(f"fun: must give shape {(len(attitude),)}, got {values.shape}")
        return values

    def residual(self, omega: Array, attitude: Array, bias: Array) -> Array:
        """Return fun - y."""
        return (self._values(attitude) - self.y)[:, None]

    def rows(self, omega: Array, attitude: Array, d_omega: Array, d_attitude: Array) -> Array:
        """Return the derivative of fun."""
        if self.jac is not None:
            gradient = np.asarray(self.jac(attitude), dtype=float)
        else:
            step = 1e-5
            gradient = np.stack([
                (self._values(rotations.product(rotations.exp(step * axis), attitude))
                 - self._values(rotations.product(rotations.exp(-step * axis), attitude))) / (2 * step)
                for axis in np.eye(3)], axis=1)
        return gradient[:, None, :] @ d_attitude
