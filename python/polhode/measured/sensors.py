"""Sensors of the motion itself: rates, accelerations, attitudes, axes and directions."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .._attitude.arrays import to_numbers
from .._core import InvalidInput
from .._sensitivity import rotations
from .base import Array, Measurement

OFF_DIAGONAL = [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)]


class Rates(Measurement):
    """Angular velocity in body axes [rad/s], as a gyroscope measures it: y of shape (n, 3).

    The model is y = (1 + E) omega + bias. A tumbling body with three different moments shows all of E, since Euler's
    equations hold for one scale and one set of axes alone. A steady rotation does not. What the data do not show is
    named by `unobservable`. A time offset is not fitted.

    Parameters
    ----------
    t, y, sigma
        As for the others.
    bias : bool
        Whether a constant offset is fitted: bias_x to bias_z [rad/s].
    scale : bool
        Whether the diagonal of E is fitted: scale_x to scale_z.
    misalignment : bool
        Whether the rest of E is fitted: misalignment_xy is what the axis x of the gyroscope sees of omega_y.
    """

    def __init__(self, t: npt.ArrayLike, y: npt.ArrayLike, sigma: npt.ArrayLike, bias: bool = False,
                 scale: bool = False, misalignment: bool = False) -> None:
        super().__init__(t, y, sigma)
        self._offset, self._scale, self._misalignment = bool(bias), bool(scale), bool(misalignment)
        self.own = ((("bias_x", "bias_y", "bias_z") if bias else ())
                    + (("scale_x", "scale_y", "scale_z") if scale else ())
                    + tuple(f"misalignment_{'xyz'[i]}{'xyz'[j]}" for i, j in (OFF_DIAGONAL if misalignment else ())))

    def _parts(self, own: Array) -> tuple[Array, Array]:
        """Return 1 + E and the bias."""
        matrix, offset, first = np.eye(3), np.zeros(3), 0
        if self._offset:
            offset, first = own[:3], 3
        if self._scale:
            matrix = matrix + np.diag(own[first : first + 3])
            first += 3
        for k, place in enumerate(OFF_DIAGONAL if self._misalignment else ()):
            matrix[place] = own[first + k]
        return matrix, offset

    def residual(self, omega: Array, attitude: Array, own: Array) -> Array:
        """Return (1 + E) omega + bias - y."""
        if not self.own:
            return omega - self.y
        matrix, offset = self._parts(own)
        return np.asarray(omega @ matrix.T + offset - self.y)

    def rows(self, omega: Array, attitude: Array, d_omega: Array, d_attitude: Array, own: Array) -> Array:
        """Return (1 + E) times the derivatives of omega."""
        return self._parts(own)[0] @ d_omega if self._scale or self._misalignment else d_omega

    def own_rows(self, omega: Array) -> Array:
        """Return the derivatives by the bias and by E."""
        parts = [np.broadcast_to(np.eye(3), (len(omega), 3, 3))] if self._offset else []
        if self._scale:
            parts.append(np.eye(3) * omega[:, None, :])
        if self._misalignment:
            rest = np.zeros((len(omega), 3, 6))
            for k, (i, j) in enumerate(OFF_DIAGONAL):
                rest[:, i, k] = omega[:, j]
            parts.append(rest)
        return np.concatenate(parts, axis=2)


class Acceleration(Measurement):
    """Specific force of an accelerometer in free fall [m/s^2], body axes: y of shape (n, 3).

    The model is y = alpha x r + omega x (omega x r), with the angular acceleration alpha of Euler's equations and the
    arm r from the centre of mass. In free fall the centre of mass accelerates as gravity does, so neither is seen. With
    rates beside it, the arm and the moments are observed. Alone it does not tell a motion from one that is turned,
    together with the arm, by half a turn about a principal axis.

    Parameters
    ----------
    t, y, sigma
        As for the others.
    arm : array_like, shape (3,), optional
        From the centre of mass to the accelerometer, body axes [m]. By default it is fitted: arm_x to arm_z.
    """

    accelerates = True

    def __init__(self, t: npt.ArrayLike, y: npt.ArrayLike, sigma: npt.ArrayLike, arm: npt.ArrayLike | None = None,
                 ) -> None:
        super().__init__(t, y, sigma)
        self.arm: Array | None = None
        if arm is None:
            self.own = ("arm_x", "arm_y", "arm_z")
            return
        self.arm = to_numbers(arm, "arm")
        if self.arm.shape != (3,) or not np.isfinite(self.arm).all():
            raise InvalidInput(f"arm: must be three finite numbers, got {arm!r}")

    def _matrix(self, omega: Array) -> Array:
        """Return A with A r the acceleration: [alpha]x + [omega]x [omega]x."""
        w = rotations.cross_matrix(omega[:, :3])
        return np.asarray(rotations.cross_matrix(omega[:, 3:]) + w @ w)

    def residual(self, omega: Array, attitude: Array, own: Array) -> Array:
        """Return alpha x r + omega x (omega x r) - y."""
        return np.asarray(self._matrix(omega) @ (own if self.arm is None else self.arm) - self.y)

    def rows(self, omega: Array, attitude: Array, d_omega: Array, d_attitude: Array, own: Array) -> Array:
        """Return the derivatives: d alpha x r + d omega x (omega x r) + omega x (d omega x r)."""
        r = own if self.arm is None else self.arm
        w = omega[:, :3]
        by_alpha = -rotations.cross_matrix(r)
        by_omega = -rotations.cross_matrix(np.cross(w, r)) - rotations.cross_matrix(w) @ rotations.cross_matrix(r)
        return np.asarray(by_alpha @ d_omega[:, 3:] + by_omega @ d_omega[:, :3])

    def own_rows(self, omega: Array) -> Array:
        """Return the derivatives by the arm."""
        return self._matrix(omega)


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

    def residual(self, omega: Array, attitude: Array, own: Array) -> Array:
        """Return the rotation vector from the measured attitude to that of the model, in body axes."""
        return rotations.log(rotations.product(rotations.conjugate(self.y), attitude))

    def rows(self, omega: Array, attitude: Array, d_omega: Array, d_attitude: Array, own: Array) -> Array:
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

    def residual(self, omega: Array, attitude: Array, own: Array) -> Array:
        """Return R axis - y."""
        return rotations.rotate(attitude, self.known) - self.y

    def rows(self, omega: Array, attitude: Array, d_omega: Array, d_attitude: Array, own: Array) -> Array:
        """Return d theta_W x R axis."""
        return -rotations.cross_matrix(rotations.rotate(attitude, self.known)) @ d_attitude


class Direction(_Pairs):
    """A known space vector seen in the body, the Sun or the magnetic field: y of shape (n, 3) is R^T direction."""

    def __init__(self, t: npt.ArrayLike, y: npt.ArrayLike, sigma: npt.ArrayLike, direction: npt.ArrayLike) -> None:
        super().__init__(t, y, sigma, direction, "direction")

    def residual(self, omega: Array, attitude: Array, own: Array) -> Array:
        """Return R^T direction - y."""
        return rotations.rotate(rotations.conjugate(attitude), self.known) - self.y

    def rows(self, omega: Array, attitude: Array, d_omega: Array, d_attitude: Array, own: Array) -> Array:
        """Return (R^T direction) x d theta_B."""
        seen = rotations.rotate(rotations.conjugate(attitude), self.known)
        return rotations.cross_matrix(seen) @ (rotations.to_matrix(attitude).transpose(0, 2, 1) @ d_attitude)
