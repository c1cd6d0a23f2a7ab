"""Samples of one sensor with their noise."""

from __future__ import annotations

import abc
from typing import Any

import numpy as np
import numpy.typing as npt

from .._attitude.arrays import to_numbers
from .._core import InvalidInput

Array = npt.NDArray[np.float64]


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
    own: tuple[str, ...] = ()   # names of parameters of the sensor itself
    accelerates = False         # whether it sees the angular acceleration beside omega

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

    @property
    def bias(self) -> int:
        """How many parameters the sensor itself has."""
        return len(self.own)

    @abc.abstractmethod
    def residual(self, omega: Array, attitude: Array, own: Array) -> Array:
        """Return model minus data, shape (n, residuals). `own` are the parameters of the sensor.

        Where the sensor `accelerates`, omega has six columns: the angular velocity and the angular acceleration.
        """

    @abc.abstractmethod
    def rows(self, omega: Array, attitude: Array, d_omega: Array, d_attitude: Array, own: Array) -> Array:
        """Return the derivatives (n, residuals, k) from those of omega and of small rotations in space."""

    def own_rows(self, omega: Array) -> Array:
        """Return the derivatives (n, residuals, bias) by the parameters of the sensor, in which it is linear."""
        return np.zeros((len(self), self.residuals, 0))


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
