"""Steps of common integrators on many states at once, as causes of errors; each with its order."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np

from .law import Law, cross, extrapolated
from .states import Array, State, conjugate, exponential, multiply, to_body


@dataclasses.dataclass(frozen=True, eq=False)
class InSpace:
    """A law whose rates are in space axes."""

    law: Law

    def field(self, t: Array, omega: Array, attitude: Array) -> State:
        """Return the derivatives of rates and quaternions, as `Law.field` does."""
        unit = attitude / np.linalg.norm(attitude, axis=1, keepdims=True)
        slope, rates = self.law.field(t, to_body(unit, omega), attitude)
        return to_body(conjugate(unit), slope), rates


Field = Law | InSpace
Step = Callable[[Law, Array, Array, Array], Array]


def _slope(law: Field, t: Array, y: Array) -> Array:
    return np.concatenate(law.field(t, y[:, :3], y[:, 3:]), axis=1)


def _euler(law: Field, t: Array, h: Array, y: Array) -> Array:
    return y + h[:, None] * _slope(law, t, y)


def _semi_implicit(law: Law, t: Array, h: Array, y: Array) -> Array:
    """The rates first, then the attitude with the new rates."""
    rates = y[:, :3] + h[:, None] * law.field(t, y[:, :3], y[:, 3:])[0]
    return np.concatenate([rates, y[:, 3:] + h[:, None] * law.field(t, rates, y[:, 3:])[1]], axis=1)


def _heun(law: Field, t: Array, h: Array, y: Array) -> Array:
    first = _slope(law, t, y)
    return y + 0.5 * h[:, None] * (first + _slope(law, t + h, y + h[:, None] * first))


def _midpoint(law: Law, t: Array, h: Array, y: Array) -> Array:
    return y + h[:, None] * _slope(law, t + h / 2, y + 0.5 * h[:, None] * _slope(law, t, y))


def _implicit_midpoint(law: Law, t: Array, h: Array, y: Array) -> Array:
    end = _midpoint(law, t, h, y)
    for _ in range(60):
        new = y + h[:, None] * _slope(law, t + h / 2, 0.5 * (y + end))
        change, end = np.max(np.abs(new - end), initial=0.0), new
        if change < 1e-15 * np.max(np.abs(end), initial=1.0):
            break
    return end


def _rk3(law: Field, t: Array, h: Array, y: Array) -> Array:
    """Kutta's third-order rule."""
    s = h[:, None]
    a = _slope(law, t, y)
    b = _slope(law, t + h / 2, y + 0.5 * s * a)
    c = _slope(law, t + h, y + s * (2 * b - a))
    return y + s * (a + 4 * b + c) / 6


def _rk4(law: Law, t: Array, h: Array, y: Array) -> Array:
    s = h[:, None]
    a = _slope(law, t, y)
    b = _slope(law, t + h / 2, y + 0.5 * s * a)
    c = _slope(law, t + h / 2, y + 0.5 * s * b)
    d = _slope(law, t + h, y + s * c)
    return y + s * (a + 2 * b + 2 * c + d) / 6


def _rotated_euler(law: Law, t: Array, h: Array, y: Array) -> Array:
    """The rates by Euler's rule; the old rates turn the attitude."""
    slope = law.field(t, y[:, :3], y[:, 3:])[0]
    return np.concatenate([y[:, :3] + h[:, None] * slope, _rotate(h, y[:, :3], y)], axis=1)


def _rotated_by_mean(law: Law, t: Array, h: Array, y: Array) -> Array:
    """The rates by Euler's rule; the mean of the old and the new rates turns the attitude."""
    rates = y[:, :3] + h[:, None] * law.field(t, y[:, :3], y[:, 3:])[0]
    return np.concatenate([rates, _rotate(h, 0.5 * (y[:, :3] + rates), y)], axis=1)


def _in_space(rule: Callable[[Field, Array, Array, Array], Array]) -> Step:
    """Return the same rule for rates in space axes."""

    def step(law: Law, t: Array, h: Array, y: Array) -> Array:
        start = np.concatenate([to_body(conjugate(y[:, 3:]), y[:, :3]), y[:, 3:]], axis=1)
        end = rule(InSpace(law), t, h, start)
        unit = end[:, 3:] / np.linalg.norm(end[:, 3:], axis=1, keepdims=True)
        return np.concatenate([to_body(unit, end[:, :3]), unit], axis=1)

    return step


def _rotated_semi_implicit(law: Law, t: Array, h: Array, y: Array) -> Array:
    """The rates by Euler's rule; the new rates turn the attitude."""
    rates = y[:, :3] + h[:, None] * law.field(t, y[:, :3], y[:, 3:])[0]
    return np.concatenate([rates, _rotate(h, rates, y)], axis=1)


def _one_newton(law: Law, t: Array, h: Array, y: Array) -> Array:
    """Implicit Euler for the gyroscopic term by one Newton step from the old rates, which then turn the attitude.

    E. Catto, Numerical Methods, Game Developers Conference 2015.
    """
    omega = y[:, :3]
    slope = law.field(t, omega, y[:, 3:])[0] @ law.matrix
    jacobian = law.matrix + h[:, None, None] * (_cross_matrix(omega) @ law.matrix - _cross_matrix(omega @ law.matrix))
    rates = omega + np.linalg.solve(jacobian, (h[:, None] * slope)[..., None])[..., 0]
    return np.concatenate([rates, _rotate(h, rates, y)], axis=1)


def _same_momentum(law: Law, t: Array, h: Array, y: Array) -> Array:
    """The momentum by Euler's rule, brought back to its length; the new rates turn the attitude."""
    momentum = y[:, :3] @ law.matrix
    end = (y[:, :3] + h[:, None] * law.field(t, y[:, :3], y[:, 3:])[0]) @ law.matrix
    lengths = [np.linalg.norm(m, axis=1, keepdims=True) for m in (momentum, end)]
    rates = end * (lengths[0] / np.where(lengths[1] > 0, lengths[1], 1.0)) @ np.linalg.inv(law.matrix)
    return np.concatenate([rates, _rotate(h, rates, y)], axis=1)


def _rotated_midpoint(law: Law, t: Array, h: Array, y: Array) -> Array:
    """The implicit midpoint rule in the momentum, with Cayley's rotation: a free body keeps its momentum in space."""
    inverse = np.linalg.inv(law.matrix)
    start = 0.5 * h[:, None] * (y[:, :3] @ law.matrix)
    x = 0.5 * h[:, None] * y[:, :3]
    for _ in range(60):
        new = (start - cross(x, x @ law.matrix)) @ inverse
        change, x = float(np.max(np.abs(new - x), initial=0.0)), new
        if change < 1e-16 * float(np.max(np.abs(x), initial=0.0)):
            break
    rates = y[:, :3] - (4 / h[:, None]) * cross(x, x @ law.matrix) @ inverse
    return np.concatenate([rates, multiply(y[:, 3:], np.concatenate([x, np.ones((len(x), 1))], axis=1))], axis=1)


def _rotated_rk4(law: Law, t: Array, h: Array, y: Array) -> Array:
    """Kutta's rule of order 4 on the group of rotations.

    H. Munthe-Kaas, BIT 38 (1998) 92.
    """
    s, w1 = h[:, None], y[:, :3]

    def stage(at: Array, omega: Array, angle: Array) -> tuple[Array, Array]:
        """The slopes of the rates and of the rotation vector."""
        slope = law.field(at, omega, multiply(y[:, 3:], exponential(angle)))[0]
        change = cross(angle, omega)
        return slope, omega + 0.5 * change + cross(angle, change) / 12

    a1, k1 = stage(t, w1, np.zeros_like(w1))
    a2, k2 = stage(t + h / 2, w1 + 0.5 * s * a1, 0.5 * s * k1)
    a3, k3 = stage(t + h / 2, w1 + 0.5 * s * a2, 0.5 * s * k2)
    a4, k4 = stage(t + h, w1 + s * a3, s * k3)
    rates = w1 + s * (a1 + 2 * a2 + 2 * a3 + a4) / 6
    return np.concatenate([rates, _rotate(h, (k1 + 2 * k2 + 2 * k3 + k4) / 6, y)], axis=1)


def _rotate(h: Array, rates: Array, y: Array) -> Array:
    return multiply(y[:, 3:], exponential(h[:, None] * rates))


def _cross_matrix(v: Array) -> Array:
    """Return the matrices of the products v x."""
    zero = np.zeros(len(v))
    rows = [[zero, -v[:, 2], v[:, 1]], [v[:, 2], zero, -v[:, 0]], [-v[:, 1], v[:, 0], zero]]
    return np.moveaxis(np.array(rows), 2, 0)


STEPS: dict[str, tuple[Step | None, int]] = {
    "Euler": (_euler, 1),
    "semi-implicit Euler": (_semi_implicit, 1),
    "Heun": (_heun, 2),
    "midpoint": (_midpoint, 2),
    "implicit midpoint": (_implicit_midpoint, 2),
    "RK3": (_rk3, 3),
    "RK4": (_rk4, 4),
    "AB2": (None, 2),
    "Euler, turned": (_rotated_euler, 1),
    "semi-implicit Euler, turned": (_rotated_semi_implicit, 1),
    "implicit Euler, one Newton step": (_one_newton, 1),
    "Euler, momentum restored": (_same_momentum, 1),
    "midpoint of the momentum": (_rotated_midpoint, 2),
    "RK4, turned": (_rotated_rk4, 4),
    "Euler, turned by mean rates": (_rotated_by_mean, 1),
    "Euler in space axes": (_in_space(_euler), 1),
    "Heun in space axes": (_in_space(_heun), 2),
    "RK3 in space axes": (_in_space(_rk3), 3),
}
ATTITUDES = {"old rate": (0.0, 1), "new rate": (1.0, 1), "mean rate": (0.5, 2)}


def run(name: str, law: Law, t: Array, dt: Array, state: State, count: int) -> State:
    """Go over each state's own step in `count` equal steps of a method."""
    y, h = np.concatenate(state, axis=1), dt / count
    step = STEPS[name][0]
    if step is None:  # Adams and Bashforth's second-order rule, with the exact state before the first step
        before = np.concatenate(extrapolated(law.field, t, -h, state), axis=1)
        old = _slope(law, t - h, before)
        for k in range(count):
            new = _slope(law, t + k * h, y)
            y, old = _unit(y + 0.5 * h[:, None] * (3 * new - old)), new
    else:
        for k in range(count):
            y = _unit(step(law, t + k * h, h, y))
    return y[:, :3], y[:, 3:]


def _unit(y: Array) -> Array:
    y[:, 3:] /= np.linalg.norm(y[:, 3:], axis=1, keepdims=True)
    return y


def rotate_by_rates(place: float, rates: list[Array], dt: Array, attitude: Array) -> Array:
    """Return attitudes that were rotated by held rates: the old (place 0), the new (1), or their mean (1/2).

    `rates` are the exact ones at the ends of equal steps, one more than there are steps.
    """
    h = (dt / (len(rates) - 1))[:, None]
    for old, new in zip(rates[:-1], rates[1:], strict=True):
        attitude = multiply(attitude, exponential(h * ((1 - place) * old + place * new)))
    return attitude
