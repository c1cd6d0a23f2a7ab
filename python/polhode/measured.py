"""What was measured of a rotating body, for :func:`polhode.fit`. NaN samples are left out and counted."""

from __future__ import annotations

import abc
import inspect
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from ._attitude.arrays import is_one_of, to_any, to_numbers
from ._core import InvalidInput
from ._sensitivity import photometry, rotations
from ._sensitivity.nights import Nights

Array = npt.NDArray[np.float64]

__all__ = ["Attitudes", "Axis", "Brightness", "Direction", "Measurement", "Rates", "Scalar"]


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
        self.index: npt.NDArray[np.intp] = order   # places in the arrays that were given
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
        other.index = self.index[chosen]
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


class _Number(Measurement):
    """One number a sample that depends on the attitude."""

    width = residuals = 1

    @abc.abstractmethod
    def costs(self, attitude: Array) -> Array:
        """Return half of chi2, (...,), of attitudes (..., n, 4) at the samples."""


class Scalar(_Number):
    """A number that depends on the attitude, as a light curve does: y of shape (n,).

    Parameters
    ----------
    t, y, sigma
        As for the others.
    fun : callable
        fun(attitude), or fun(attitude, t), or fun(attitude, t, index) where it takes them: attitudes (n, 4), times (n,)
        and the places of the samples in `t` (n,), giving (n,).
    jac : callable, optional
        With the same arguments, giving (n, 3): the derivative with respect to a small rotation in space axes. By
        default central differences of `fun`.
    """

    def __init__(self, t: npt.ArrayLike, y: npt.ArrayLike, sigma: npt.ArrayLike, fun: Callable[..., npt.ArrayLike],
                 jac: Callable[..., npt.ArrayLike] | None = None) -> None:
        super().__init__(t, y, sigma)
        self.fun, self.jac = fun, jac
        self._taken_by_fun = _arguments(fun, "fun")
        self._taken_by_jac = 1 if jac is None else _arguments(jac, "jac")

    def _values(self, attitude: Array) -> Array:
        shape, copies = attitude.shape[:-1], attitude.size // (4 * max(len(self), 1))
        given = (attitude.reshape(-1, 4), np.tile(self.t, copies), np.tile(self.index, copies))[: self._taken_by_fun]
        values = np.asarray(self.fun(*given), dtype=float)
        if values.shape != (len(given[0]),):
            raise InvalidInput(f"fun: must give shape {(len(given[0]),)}, got {values.shape}")
        return values.reshape(shape)

    def costs(self, attitude: Array) -> Array:
        """Return half of chi2, (...,), of attitudes (..., n, 4) at the samples."""
        return np.asarray(0.5 * (((self._values(attitude) - self.y) * self.whitener[:, 0, 0]) ** 2).sum(axis=-1))

    def residual(self, omega: Array, attitude: Array, bias: Array) -> Array:
        """Return fun - y."""
        return (self._values(attitude) - self.y)[:, None]

    def rows(self, omega: Array, attitude: Array, d_omega: Array, d_attitude: Array) -> Array:
        """Return the derivative of fun."""
        if self.jac is not None:
            gradient = np.asarray(self.jac(*(attitude, self.t, self.index)[: self._taken_by_jac]), dtype=float)
            if gradient.shape != (len(self), 3):
                raise InvalidInput(f"jac: must give shape {(len(self), 3)}, got {gradient.shape}")
        else:
            step = 1e-5
            gradient = np.stack([
                (self._values(rotations.product(rotations.exp(step * axis), attitude))
                 - self._values(rotations.product(rotations.exp(-step * axis), attitude))) / (2 * step)
                for axis in np.eye(3)], axis=1)
        return gradient[:, None, :] @ d_attitude


def _arguments(fun: Callable[..., npt.ArrayLike], name: str) -> int:
    """Return how many of attitude, t and index a function takes: its parameters without a default."""
    if not callable(fun):
        raise InvalidInput(f"{name}: must be a function of the attitude, got {type(fun).__name__}")
    try:
        parameters = inspect.signature(fun).parameters.values()
    except (TypeError, ValueError):   # of a function without a signature
        return 1
    if any(p.kind is p.VAR_POSITIONAL for p in parameters):
        return 3
    count = sum(p.default is p.empty and p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD) for p in parameters)
    if count > 3:
        raise InvalidInput(f"{name}: must take attitude, t and index at most, got a function of {count} arguments")
    return max(count, 1)


class Brightness(_Number):
    """The brightness of a convex body, a light curve: y of shape (n,), in units of flux, not magnitudes.

    The model is scale * light + offset. Scale and offset are fitted by linear least squares within each night, and they
    are no parameters of the result (variable projection: Golub and Pereyra 1973). The scale is never negative.

    Parameters
    ----------
    t, y, sigma
        As for the others.
    body : tuple
        (a, b, c), the semi-axes of an ellipsoid along the body axes; or (vertices, faces), a convex body of triangles
        that are counterclockwise from outside, in body axes.
    sun, observer : array_like, shape (3,) or (n, 3)
        Directions from the body to the Sun and to the observer, in space axes; constant, or one a sample.
    law : {'lambert', 'lommel-seeliger', 'geometric'}
        The light of a face with the cosines m of the Sun and n of the observer: m n, m n / (m + n), or n.
    night : array_like, shape (n,), optional
        A label of each sample: samples of one label have one scale and one offset. By default all have the same.
    scale, offset : bool
        Whether they are fitted. Else the scale is 1 and the offset 0.
    """

    def __init__(self, t: npt.ArrayLike, y: npt.ArrayLike, sigma: npt.ArrayLike, body: Any, sun: npt.ArrayLike,
                 observer: npt.ArrayLike, law: str = "lambert", night: npt.ArrayLike | None = None,
                 scale: bool = True, offset: bool = False) -> None:
        super().__init__(t, y, sigma)
        if not is_one_of(law, photometry.LAWS):
            raise InvalidInput(f"law: must be one of {', '.join(photometry.LAWS)}, got {law!r}")
        if not isinstance(scale, (bool, np.bool_)) or not isinstance(offset, (bool, np.bool_)):
            raise InvalidInput(f"scale, offset: must be True or False, got {scale!r}, {offset!r}")
        self.body, self.law, self.scale, self.offset = photometry.make_reflector(body, law), law, scale, offset
        count = len(self) + self.left_out
        self.sun, self.observer = self._directions(sun, "sun", count), self._directions(observer, "observer", count)
        labels = np.zeros(count) if night is None else to_any(night, "night", "fiubU")
        if labels.shape != (count,):
            raise InvalidInput(f"night: must be of shape {(count,)}, one label for each time, got {labels.shape}")
        self.night: npt.NDArray[np.intp] = np.unique(labels[self.index], return_inverse=True)[1].reshape(-1)

    def _directions(self, value: npt.ArrayLike, name: str, count: int) -> Array:
        found = to_numbers(value, name)
        if found.shape not in ((3,), (count, 3)):
            raise InvalidInput(f"{name}: must be of shape (3,) or {(count, 3)}, got {found.shape}")
        found = np.broadcast_to(found, (count, 3))[self.index]
        size = np.linalg.norm(found, axis=1, keepdims=True)
        if not (np.isfinite(size) & (size > 0)).all():
            raise InvalidInput(f"{name}: must hold directions, finite and not zero")
        return np.asarray(found / size)

    def taken(self, chosen: Any) -> Measurement:
        """Return the samples of a mask or of indices."""
        other = super().taken(chosen)
        assert isinstance(other, Brightness)
        other.sun, other.observer = self.sun[chosen], self.observer[chosen]
        other.night = np.unique(self.night[chosen], return_inverse=True)[1].reshape(-1)
        return other

    @property
    def nights(self) -> Nights:
        """The groups of samples with scales and offsets of their own."""
        return Nights(self.y, self.whitener[:, 0, 0], self.night, self.scale, self.offset)

    @property
    def independent(self) -> int:
        """The samples less the scales and offsets, never below 0 in a night."""
        return self.nights.independent

    def _light(self, attitude: Array) -> tuple[Array, Array, Array]:
        """Return the light and the directions in body axes."""
        back = rotations.to_matrix(attitude).swapaxes(-1, -2)
        sun, observer = ((back @ v[:, :, None])[..., 0] for v in (self.sun, self.observer))
        return self.body.light(sun, observer), sun, observer

    def model(self, attitude: npt.ArrayLike) -> Array:
        """Return the light, (n,), of attitudes (n, 4) at the samples, with scale 1 and offset 0."""
        given = to_numbers(attitude, "attitude")
        if given.shape != (len(self), 4):
            raise InvalidInput(f"attitude: must be of shape {(len(self), 4)}, got {given.shape}")
        return self._light(given)[0]

    def costs(self, attitude: Array) -> Array:
        """Return half of chi2, (...,), of attitudes (..., n, 4) at the samples."""
        residual = self.nights.matched(self._light(attitude)[0])[2]
        return np.asarray(0.5 * (residual * residual).sum(axis=-1))

    def residual(self, omega: Array, attitude: Array, bias: Array) -> Array:
        """Return scale light + offset - y with the best scale and offset of each night."""
        return np.asarray(self.nights.matched(self._light(attitude)[0])[2] / self.whitener[:, 0, 0])[:, None]

    def rows(self, omega: Array, attitude: Array, d_omega: Array, d_attitude: Array) -> Array:
        """Return the derivatives, those of the best scales and offsets included."""
        light, sun, observer = self._light(attitude)
        by_sun, by_observer = self.body.gradients(sun, observer)
        gradient = rotations.rotate(attitude, np.cross(by_sun, sun) + np.cross(by_observer, observer))
        found = self.nights.rows(light, (gradient[:, None, :] @ d_attitude)[:, 0])
        return np.asarray(found / self.whitener[:, 0, 0, None])[:, None, :]
