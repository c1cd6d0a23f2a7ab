"""Steps of common integrators on many states at once, as causes of errors; each with its order."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .law import Field, extrapolated
from .states import Array, State, multiply, turn

Step = Callable[[Field, Array, Array, Array], Array]


def _slope(field: Field, t: Array, y: Array) -> Array:
    return np.concatenate(field(t, y[:, :3], y[:, 3:]), axis=1)


def _euler(field: Field, t: Array, h: Array, y: Array) -> Array:
    return y + h[:, None] * _slope(field, t, y)


def _semi_implicit(field: Field, t: Array, h: Array, y: Array) -> Array:
    """The rates first, then the attitude with the new rates."""
    rates = y[:, :3] + h[:, None] * field(t, y[:, :3], y[:, 3:])[0]
    return np.concatenate([rates, y[:, 3:] + h[:, None] * field(t, rates, y[:, 3:])[1]], axis=1)


def _heun(field: Field, t: Array, h: Array, y: Array) -> Array:
    first = _slope(field, t, y)
    return y + 0.5 * h[:, None] * (first + _slope(field, t + h, y + h[:, None] * first))


def _midpoint(field: Field, t: Array, h: Array, y: Array) -> Array:
    return y + h[:, None] * _slope(field, t + h / 2, y + 0.5 * h[:, None] * _slope(field, t, y))


def _implicit_midpoint(field: Field, t: Array, h: Array, y: Array) -> Array:
    end = _midpoint(field, t, h, y)
    for _ in range(60):
        new = y + h[:, None] * _slope(field, t + h / 2, 0.5 * (y + end))
        change, end = np.max(np.abs(new - end), initial=0.0), new
        if change < 1e-15 * np.max(np.abs(end), initial=1.0):
            break
    return end


def _rk3(field: Field, t: Array, h: Array, y: Array) -> Array:
    """Kutta's third-order rule."""
    s = h[:, None]
    a = _slope(field, t, y)
    b = _slope(field, t + h / 2, y + 0.5 * s * a)
    c = _slope(field, t + h, y + s * (2 * b - a))
    return y + s * (a + 4 * b + c) / 6


def _rk4(field: Field, t: Array, h: Array, y: Array) -> Array:
    s = h[:, None]
    a = _slope(field, t, y)
    b = _slope(field, t + h / 2, y + 0.5 * s * a)
    c = _slope(field, t + h / 2, y + 0.5 * s * b)
    d = _slope(field, t + h, y + s * c)
    return y + s * (a + 2 * b + 2 * c + d) / 6


STEPS: dict[str, tuple[Step | None, int]] = {
    "Euler": (_euler, 1),
    "semi-implicit Euler": (_semi_implicit, 1),
    "Heun": (_heun, 2),
    "midpoint": (_midpoint, 2),
    "implicit midpoint": (_implicit_midpoint, 2),
    "RK3": (_rk3, 3),
    "RK4": (_rk4, 4),
    "AB2": (None, 2),
}
ATTITUDES = {"old rate": (0.0, 1), "new rate": (1.0, 1), "mean rate": (0.5, 2)}


def run(name: str, field: Field, t: Array, dt: Array, state: State, count: int) -> State:
    """Go over each state's own step in `count` equal steps of a method."""
    y, h = np.concatenate(state, axis=1), dt / count
    step = STEPS[name][0]
    if step is None:  # Adams and Bashforth's second-order rule, with the exact state before the first step
        before = np.concatenate(extrapolated(field, t, -h, state), axis=1)
        old = _slope(field, t - h, before)
        for k in range(count):
            new = _slope(field, t + k * h, y)
            y, old = _unit(y + 0.5 * h[:, None] * (3 * new - old)), new
    else:
        for k in range(count):
            y = _unit(step(field, t + k * h, h, y))
    return y[:, :3], y[:, 3:]


def _unit(y: Array) -> Array:
    y[:, 3:] /= np.linalg.norm(y[:, 3:], axis=1, keepdims=True)
    return y


def turned(place: float, rates: list[Array], dt: Array, attitude: Array) -> Array:
    """Return attitudes that were turned by held rates: the old (place 0), the new (1), or their mean (1/2).

    `rates` are the exact ones at the ends of equal steps, one more than there are steps.
    """
    h = (dt / (len(rates) - 1))[:, None]
    for old, new in zip(rates[:-1], rates[1:], strict=True):
        attitude = multiply(attitude, turn(h * ((1 - place) * old + place * new)))
    return attitude
