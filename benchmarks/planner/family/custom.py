"""Torques of a user's own, as Python functions whose exact form the truth knows."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Brake:
    """Linear damping: -c w."""

    c: float

    def __call__(self, t, omega, attitude):
        return -self.c * np.asarray(omega)

    def scaled(self, inertia, time):
        return Brake(self.c * inertia / time)


@dataclass(frozen=True)
class Wheel:
    """A wheel of constant momentum h in body axes: -w x h."""

    h: tuple

    def __call__(self, t, omega, attitude):
        return -np.cross(omega, self.h)

    def scaled(self, inertia, time):
        return Wheel(tuple(h * inertia / time for h in self.h))


@dataclass(frozen=True)
class Drag:
    """Cubic drag: -c |w|^2 w."""

    c: float

    def __call__(self, t, omega, attitude):
        omega = np.asarray(omega)
        return -self.c * (omega @ omega) * omega

    def scaled(self, inertia, time):
        return Drag(self.c * inertia * time)


@dataclass(frozen=True)
class Magnet:
    """A dipole m of the body in a field that turns about space z: m x R^T (b cos nt, b sin nt, bz)."""

    m: tuple
    b: float
    bz: float
    n: float

    def __call__(self, t, omega, attitude):
        x, y, z, s = attitude
        field = np.array([self.b * np.cos(self.n * t), self.b * np.sin(self.n * t), self.bz])
        v = -np.array([x, y, z])
        across = 2 * np.cross(v, field)
        return np.cross(self.m, field + s * across + np.cross(v, across))

    def scaled(self, inertia, time):
        return Magnet(tuple(m * inertia / time ** 2 for m in self.m), self.b, self.bz, self.n / time)
