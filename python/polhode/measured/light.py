"""One number a sample that depends on the attitude, as the brightness of a body does."""

from __future__ import annotations

import abc
import inspect
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from .._attitude.arrays import is_one_of, to_any, to_numbers
from .._core import InvalidInput
from .._sensitivity import photometry, rotations
from .._sensitivity.nights import Nights
from .base import Array, Measurement


class _Number(Measurement):
    """One number a sample that depends on the attitude."""

    width = residuals = 1

    @abc.abstractmethod
    def costs(self, attitude: Array) -> Array:
        """Return half of chi2, (...,), of attitudes (..., n, 4) at the samples."""


    def rough(self) -> Measurement:
        """Return the same samples of a cheaper model, for a search."""
        return self


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

    def values_of(self, attitude: Array) -> Array:
        """Return the values, (m,), of attitudes (m, 4) at any of the samples."""
        places = np.arange(len(attitude)) % len(self)
        given = (attitude, self.t[places], self.index[places])[: self._taken_by_fun]
        return np.asarray(self.fun(*given), dtype=float)

    def costs(self, attitude: Array) -> Array:
        """Return half of chi2, (...,), of attitudes (..., n, 4) at the samples."""
        return np.asarray(0.5 * (((self._values(attitude) - self.y) * self.whitener[:, 0, 0]) ** 2).sum(axis=-1))

    def residual(self, omega: Array, attitude: Array, own: Array) -> Array:
        """Return fun - y."""
        return (self._values(attitude) - self.y)[:, None]

    def rows(self, omega: Array, attitude: Array, d_omega: Array, d_attitude: Array, own: Array) -> Array:
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
    def semi_axes(self) -> Array | None:
        """The semi-axes of an ellipsoid along the body axes; None for triangles."""
        return self.body.C**-0.5 if isinstance(self.body, photometry.Ellipsoid) else None

    def rough(self) -> Measurement:
        """Return the same samples of a cheaper model, for a search."""
        other = self.taken(slice(None))
        assert isinstance(other, Brightness)
        if isinstance(self.body, photometry.Ellipsoid):
            other.body = self.body.rough()
        return other

    @property
    def nights(self) -> Nights:
        """The groups of samples with scales and offsets of their own."""
        return Nights(self.y, self.whitener[:, 0, 0], self.night, self.scale, self.offset)

    @property
    def independent(self) -> int:
        """The samples less the scales and offsets, never below 0 in a night."""
        return self.nights.independent

    def _seen(self, attitude: Array) -> tuple[Array, Array]:
        """Return the directions of the Sun and the observer in body axes."""
        back = rotations.to_matrix(attitude).swapaxes(-1, -2)
        sun, observer = ((back @ v[:, :, None])[..., 0] for v in (self.sun, self.observer))
        return sun, observer

    def _light(self, attitude: Array) -> Array:
        return self.body.light(*self._seen(attitude))

    def model(self, attitude: npt.ArrayLike) -> Array:
        """Return the light, (n,), of attitudes (n, 4) at the samples, with scale 1 and offset 0."""
        given = to_numbers(attitude, "attitude")
        if given.shape != (len(self), 4):
            raise InvalidInput(f"attitude: must be of shape {(len(self), 4)}, got {given.shape}")
        return self._light(given)

    def costs(self, attitude: Array) -> Array:
        """Return half of chi2, (...,), of attitudes (..., n, 4) at the samples."""
        residual = self.nights.matched(self._light(attitude))[2]
        return np.asarray(0.5 * (residual * residual).sum(axis=-1))

    def residual(self, omega: Array, attitude: Array, own: Array) -> Array:
        """Return scale light + offset - y with the best scale and offset of each night."""
        return np.asarray(self.nights.matched(self._light(attitude))[2] / self.whitener[:, 0, 0])[:, None]

    def rows(self, omega: Array, attitude: Array, d_omega: Array, d_attitude: Array, own: Array) -> Array:
        """Return the derivatives, those of the best scales and offsets included."""
        sun, observer = self._seen(attitude)
        light, by_sun, by_observer = self.body.gradients(sun, observer)
        gradient = rotations.rotate(attitude, np.cross(by_sun, sun) + np.cross(by_observer, observer))
        found = self.nights.rows(light, (gradient[:, None, :] @ d_attitude)[:, 0])
        return np.asarray(found / self.whitener[:, 0, 0, None])[:, None, :]
