"""Torques that act in the light of a sun alone: their windows follow from an orbit and the span of a scene."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from .._attitude.arrays import to_number
from .._core import InvalidInput
from .._core.torques import During, Formula
from .orbit import Orbit


class Sunlit(During):
    """A torque outside the shadow of a central body. A scene finds its windows when it is built."""

    _orbit: Orbit
    _sun: tuple[float, ...]
    _shadow: float

    @property
    def windows(self) -> Any:
        """None: the windows follow from the orbit and the span."""
        return None

    @property
    def sunlight(self) -> tuple[Orbit, tuple[float, ...], float]:
        """The orbit, the direction of the sun, and the radius of the shadow [m]."""
        return self._orbit, self._sun, self._shadow

    def over(self, first: float, last: float) -> During | Formula:
        """Return the torque with its windows between two times; windows may reach beyond them."""
        begin, lit = -math.inf, []
        for dark, bright in self._orbit.eclipses(self._sun, self._shadow, first, last).tolist():
            if begin < dark:
                lit.append((begin, dark))
            begin = bright
        if begin < math.inf:
            lit.append((begin, math.inf))
        inner: Formula = self.torque
        return inner if lit == [(-math.inf, math.inf)] else During(inner, lit)

    def with_torque(self, torque: Formula) -> Sunlit:
        """Return another torque in the same light."""
        return make_sunlit(torque, self._orbit, self._sun, self._shadow)

    def value(self, t: float, omega: Any, attitude: Any, inertia: Any = None, states: Any = None) -> Any:
        """Return the torque at one state, in the dark 0; see `During.value`."""
        found = self.torque.value(t, omega, attitude, inertia, states)
        r = self._orbit.at(t)[0]
        s = np.array(self._sun) / np.linalg.norm(self._sun)
        along = float(r @ s)
        return found * (along >= 0.0 or float(np.linalg.norm(r - along * s)) >= self._shadow)

    def __repr__(self) -> str:
        return f"polhode.torques.During({self.torque!r}, sunlight={self.sunlight!r})"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sunlit) and (self.torque, self.sunlight) == (other.torque, other.sunlight)

    def __hash__(self) -> int:
        return hash((self.torque, self.sunlight))

    def __reduce__(self) -> tuple[Any, ...]:
        return make_sunlit, (self.torque, *self.sunlight)


def make_sunlit(torque: Formula, orbit: Orbit, sun: Any, shadow: Any) -> Sunlit:
    """Return a torque that acts outside the shadow of the central body of an orbit.

    Raises
    ------
    InvalidInput
        For what is no orbit, and a radius that is not positive.
    """
    if not isinstance(orbit, Orbit):
        raise InvalidInput(f"SolarPressure.orbit: must be an Orbit, got {type(orbit).__name__}")
    radius = to_number(shadow, "SolarPressure.shadow")
    if not (0.0 < radius < math.inf):
        raise InvalidInput(f"SolarPressure.shadow: must be positive and finite, got {radius}")
    made = Sunlit(torque, (-math.inf, math.inf))
    made._orbit, made._sun, made._shadow = orbit, tuple(map(float, sun)), radius
    return made


def rewrap(during: During, torque: Any) -> During:
    """Return another torque in the same windows, or in the same light."""
    return during.with_torque(torque) if isinstance(during, Sunlit) else During(torque, during.windows)


def resolve(torques: tuple[Any, ...], times: Any, t0: Any) -> tuple[Any, ...]:
    """Return the torques with the windows of a scene's span."""
    if not any(isinstance(torque, Sunlit) for torque in torques):
        return torques
    all_times = np.append(np.asarray(times, dtype=float).ravel(), float(t0))
    if not np.isfinite(all_times).all():
        return torques   # the scene refuses them
    first, last = float(all_times.min()), float(all_times.max())
    return tuple(torque.over(first, last) if isinstance(torque, Sunlit) else torque for torque in torques)
