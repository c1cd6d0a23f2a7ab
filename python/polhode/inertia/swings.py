"""Moments of inertia from the period of a swing, with their uncertainty."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from typing import Any

from .._attitude.arrays import to_numbers
from .._core import InvalidInput
from ..elliptic import K

GRAVITY = 9.80665   # standard gravity, exact [m/s^2]


@dataclasses.dataclass(frozen=True)
class SwingMoment:
    """A moment of inertia from a swing.

    Attributes
    ----------
    moment : float
        About the axis through the centre of mass that is parallel to the axis of the swing [kg m^2].
    stderr : float
        Its standard deviation from those of the arguments, to first order.
    shares : dict
        The part of the variance that comes from each argument; they add up to 1.
    """

    moment: float
    stderr: float
    shares: dict[str, float]


def from_pendulum(period: Any, mass: Any, distance: Any, gravity: Any = GRAVITY, amplitude: Any = 0.0) -> SwingMoment:
    """Return the moment about the centre of mass of a body that swings about a level axis.

    The period is T = 4 K(sin^2(a / 2)) sqrt((I + m d^2) / (m g d)), for every amplitude a below half a turn.

    Parameters
    ----------
    period : float or (float, float)
        Of the whole swing, there and back [s], with its standard deviation. So for the others.
    mass : float or (float, float)
        [kg]
    distance : float or (float, float)
        From the axis to the centre of mass [m].
    gravity : float or (float, float)
        [m/s^2]
    amplitude : float or (float, float)
        The largest angle from the vertical [rad].

    Returns
    -------
    SwingMoment
        About the parallel axis through the centre of mass.

    Raises
    ------
    InvalidInput
        Numbers that are not positive, and a period that is shorter than that of a point of this mass.
    """
    def moment(T: float, m: float, d: float, g: float, a: float) -> float:
        return m * g * d * (T / (4 * _quarter(a))) ** 2 - m * d * d

    found = _propagate(moment, {"period": period, "mass": mass, "distance": distance, "gravity": gravity,
                                "amplitude": amplitude})
    if not found.moment > 0:
        raise InvalidInput("period: must be longer than that of a point at this distance, "
                           f"got a moment of {found.moment:.6g} kg m^2 about the centre of mass")
    return found


def from_bifilar(period: Any, mass: Any, length: Any, spacing: Any, gravity: Any = GRAVITY, amplitude: Any = 0.0,
                 ) -> SwingMoment:
    """Return the moment about the vertical of a body that hangs on two equal threads and turns about the vertical.

    The threads are parallel, and the centre of mass is in the middle between them. The period is
    T = 8 K(sin^2(a / 2)) sqrt(I length / (m g)) / spacing, to first order in (spacing a / length)^2.

    Parameters
    ----------
    period : float or (float, float)
        Of the whole swing, there and back [s], with its standard deviation. So for the others.
    mass : float or (float, float)
        [kg]
    length, spacing : float or (float, float)
        Of the threads, and between them [m].
    gravity : float or (float, float)
        [m/s^2]
    amplitude : float or (float, float)
        The largest angle from rest [rad].

    Returns
    -------
    SwingMoment
        About the vertical through the centre of mass.

    Raises
    ------
    InvalidInput
        Numbers that are not positive.
    """
    def moment(T: float, m: float, length: float, spacing: float, g: float, a: float) -> float:
        return m * g / length * (spacing * T / (8 * _quarter(a))) ** 2

    return _propagate(moment, {"period": period, "mass": mass, "length": length, "spacing": spacing,
                               "gravity": gravity, "amplitude": amplitude})


def _quarter(amplitude: float) -> float:
    """Return K(sin^2(amplitude / 2)): a quarter of a swing, in units of 1 / the frequency of small ones."""
    return float(K(math.sin(0.5 * amplitude) ** 2, math.cos(0.5 * amplitude) ** 2))


def _propagate(moment: Callable[..., float], given: dict[str, Any]) -> SwingMoment:
    values, sigmas = {}, {}
    for name, pair in given.items():
        numbers = to_numbers(pair, name).reshape(-1)
        if numbers.size not in (1, 2):
            raise InvalidInput(f"{name}: must be a number, or a number and its standard deviation, got {pair!r}")
        values[name], sigmas[name] = float(numbers[0]), float(numbers[1]) if numbers.size == 2 else 0.0
        sigma = sigmas[name]
        good = 0 <= values[name] < math.pi if name == "amplitude" else 0 < values[name] < math.inf
        if not good or not 0 <= sigma < math.inf:
            limits = "from 0 to below pi" if name == "amplitude" else "positive"
            raise InvalidInput(f"{name}: must be {limits} and finite, with a standard deviation >= 0, got {pair!r}")
    parts_of = {}
    for name, sigma in sigmas.items():
        step = 1e-6 * max(values[name], 1.0 if name == "amplitude" else 0.0)
        low = {**values, name: max(values[name] - step, 0.0) if name == "amplitude" else values[name] - step}
        high = {**values, name: values[name] + step}
        slope = (moment(*high.values()) - moment(*low.values())) / (high[name] - low[name])
        parts_of[name] = (slope * sigma) ** 2
    variance = math.fsum(parts_of.values())
    shares = {name: part / variance if variance else 0.0 for name, part in parts_of.items()}
    return SwingMoment(moment(*values.values()), math.sqrt(variance), shares)
