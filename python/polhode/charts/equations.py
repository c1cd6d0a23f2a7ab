"""Euler's equations with a quaternion, written once, for every program that wants a right-hand side of its own.

`derivatives` works on anything that adds and multiplies: floats, another program's expressions, or `Symbol`, which
writes each step down. `source` gives those steps as straight-line text that both Python and C++ read, with a scene's
numbers in place and without the terms that are zero: what a careful user would write by hand for that one scene.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from .. import torques
from .._scene.scene import Scene
from .candidate import refuses_times

Numbers = Sequence[Any]
Function = Callable[[Any], Any]


def _dot(a: Numbers, b: Numbers) -> Any:
    """The sum of products, without those that are zero."""
    total: Any = 0.0
    for x, y in zip(a, b):
        if isinstance(x, float) and x == 0 or isinstance(y, float) and y == 0:
            continue
        term = y if isinstance(x, float) and x == 1 else x if isinstance(y, float) and y == 1 else x * y
        total = term if isinstance(total, float) and total == 0 else total + term
    return total


def _cross(a: Numbers, b: Numbers) -> list[Any]:
    return [_difference(_dot([a[i]], [b[j]]), _dot([a[j]], [b[i]])) for i, j in ((1, 2), (2, 0), (0, 1))]


def _difference(a: Any, b: Any) -> Any:
    return a if isinstance(b, float) and b == 0 else -1.0 * b if isinstance(a, float) and a == 0 else a - b


def _rows(q: Numbers) -> list[list[Any]]:
    """The rows of R_WB for a quaternion (x, y, z, w)."""
    x, y, z, s = q
    xx, yy, zz, xy, xz, yz, sx, sy, sz = x * x, y * y, z * z, x * y, x * z, y * z, s * x, s * y, s * z
    return [[1.0 - 2.0 * (yy + zz), 2.0 * (xy - sz), 2.0 * (xz + sy)],
            [2.0 * (xy + sz), 1.0 - 2.0 * (xx + zz), 2.0 * (yz - sx)],
            [2.0 * (xz - sy), 2.0 * (yz + sx), 1.0 - 2.0 * (xx + yy)]]


def _constant(torque: Any, scene: Scene, t: Any, w: Numbers, q: Numbers, cos: Function, sin: Function) -> list[Any]:
    values = [float(v) for v in torque.torque]
    if torque.frame == "body":
        return list(values)
    return [_dot(values, column) for column in zip(*_rows(q))]


def _gravity(torque: Any, scene: Scene, t: Any, w: Numbers, q: Numbers, cos: Function, sin: Function) -> list[Any]:
    arm = [-float(torque.weight) * float(v) for v in torque.arm]
    return _cross(arm, _rows(q)[2])


def _gradient(torque: Any, scene: Scene, t: Any, w: Numbers, q: Numbers, cos: Function, sin: Function) -> list[Any]:
    n, phase = float(torque.mean_motion), float(torque.phase)
    angle = n * t + phase if phase else n * t
    c, s = cos(angle), sin(angle)
    rows = _rows(q)
    u = [c * rows[0][m] + s * rows[1][m] for m in range(3)]
    inertia = (3.0 * n * n * scene.inertia.matrix).tolist()
    return _cross(u, [_dot(row, u) for row in inertia])


def _damping(torque: Any, scene: Scene, t: Any, w: Numbers, q: Numbers, cos: Function, sin: Function) -> list[Any]:
    return [_dot(row, w) for row in (-np.asarray(torque.matrix)).tolist()]


def _angular_damping(torque: Any, scene: Scene, t: Any, w: Numbers, q: Numbers, cos: Function,
                     sin: Function) -> list[Any]:
    return [_dot(row, w) for row in (-float(torque.rate) * scene.inertia.matrix).tolist()]


_TORQUES: dict[type, Callable[..., list[Any]]] = {
    torques.Constant: _constant, torques.Gravity: _gravity, torques.GravityGradient: _gradient,
    torques.Damping: _damping, torques.AngularDamping: _angular_damping,
}


def unwritten(scene: Scene) -> str:
    """Why a scene has no right-hand side here, or ""."""
    for torque in scene.torques:
        if type(torque) not in _TORQUES:
            return f"no right-hand side outside polhode for the torque {type(torque).__name__}"
    if any(rotor.during is not None for rotor in scene.rotors):
        return "no right-hand side outside polhode for rotors that start or stop"
    return ""


def damps(scene: Scene) -> bool:
    """Whether something may make a scene stiff."""
    return any(isinstance(torque, torques.Damping | torques.AngularDamping) for torque in scene.torques)


def refuses(scene: Scene, implicit: bool = False) -> str:
    """Why a program that is fed these equations does not take a scene, or ""."""
    if implicit and not damps(scene):
        return "implicit: for scenes that damp"
    return unwritten(scene) or refuses_times(scene)


def _rotating(w: Numbers, q: Numbers) -> list[Any]:
    """The derivative of the quaternion."""
    x, y_, z, s = q
    a, b, c = (0.5 * v for v in w)
    return [s * a + y_ * c - z * b, s * b + z * a - x * c, s * c + x * b - y_ * a,
            -1.0 * (x * a + y_ * b + z * c)]


class Separatrix:
    """The variables u = omega_3 - s omega_1, omega_2 and v = omega_3 + s omega_1 of a triaxial body: docs/ode.md.

    Their part without a torque is u' = r omega_2 u, v' = -r omega_2 v: next to the separatrix each keeps its digits.
    """

    def __init__(self, scene: Scene) -> None:
        moments = np.diag(scene.carrier_inertia.matrix)
        self.axes = [int(k) for k in np.argsort(moments)]
        a, b, c = (float(moments[k]) for k in self.axes)
        even = self.axes in ([0, 1, 2], [1, 2, 0], [2, 0, 1])
        sign = 1.0 if even else -1.0
        below, above = b - a, c - b
        self.scale = math.sqrt(a * below / (c * above))
        self.rate = sign * math.sqrt(below * above / (a * c))
        self.middle = sign * (c - a) / (4.0 * b * self.scale)
        self.moments = a, b, c

    @staticmethod
    def refuses(scene: Scene, implicit: bool = False) -> str:
        """Why a scene has no such variables, or ""."""
        matrix = scene.carrier_inertia.matrix
        if scene.inertia.symmetry != "triaxial" or (matrix != np.diag(np.diag(matrix))).any():
            return "u, v: for triaxial bodies in principal axes"
        if scene.rotor_momentum.any():
            return "u, v: without rotors"
        return refuses(scene, implicit)

    def start(self, scene: Scene) -> Any:
        """The first state: u, omega_2, v and the quaternion."""
        a, b, c = scene.omega[self.axes]
        return np.concatenate([[c - self.scale * a, b, c + self.scale * a], scene.attitude])

    def rates(self, y: Any) -> Any:
        """The rates about the body axes of states, shape (n, 3)."""
        found = np.empty((len(y), 3))
        found[:, self.axes] = np.stack([(y[:, 2] - y[:, 0]) / (2 * self.scale), y[:, 1], (y[:, 0] + y[:, 2]) / 2], 1)
        return found

    def derivatives(self, scene: Scene, t: Any, y: Numbers, cos: Function = math.cos,
                    sin: Function = math.sin) -> list[Any]:
        """Return the seven derivatives."""
        u, b, v = y[:3]
        w: list[Any] = [0.0, 0.0, 0.0]
        for axis, value in zip(self.axes, ((0.5 / self.scale) * (v - u), b, 0.5 * (u + v))):
            w[axis] = value
        change = [self.rate * b * u, self.middle * ((v - u) * (v + u)), -self.rate * b * v]
        for torque in scene.torques:
            tau = _TORQUES[type(torque)](torque, scene, t, w, y[3:], cos, sin)
            one, two, three = (_dot([1.0 / m], [tau[k]]) for m, k in zip(self.moments, self.axes))
            push = _dot([self.scale], [one])
            change = [_dot([1.0, 1.0], pair)
                      for pair in zip(change, (_difference(three, push), two, _dot([1.0, 1.0], [three, push])))]
        return [*change, *_rotating(w, y[3:])]


def derivatives(scene: Scene, t: Any, y: Numbers, cos: Function = math.cos, sin: Function = math.sin) -> list[Any]:
    """Return the seven derivatives of y = (omega, quaternion)."""
    w, q = y[:3], y[3:]
    inertia = scene.carrier_inertia.matrix
    if (inertia == np.diag(np.diag(inertia))).all():
        a, b, c = np.diag(inertia).tolist()
        tau = [_dot([b - c], [w[1] * w[2]]), _dot([c - a], [w[2] * w[0]]), _dot([a - b], [w[0] * w[1]])]
        inverse = np.diag(1 / np.diag(inertia)).tolist()
    else:
        tau = _cross([_dot(row, w) for row in inertia.tolist()], w)
        inverse = np.linalg.inv(inertia).tolist()
    for torque in scene.torques:
        more = _TORQUES[type(torque)](torque, scene, t, w, q, cos, sin)
        tau = [_dot([1.0, 1.0], pair) for pair in zip(tau, more)]
    if scene.rotor_momentum.any():
        tau = [_dot([1.0, 1.0], pair) for pair in zip(tau, _cross(scene.rotor_momentum.tolist(), w))]
    return [*(_dot(row, tau) for row in inverse), *_rotating(w, q)]


class Symbol:
    """A value with a name, whose arithmetic is written down as lines of text; equal steps are written once."""

    def __init__(self, name: str, lines: dict[str, str]) -> None:
        self.name, self._lines = name, lines

    def _write(self, text: str) -> Symbol:
        return Symbol(self._lines.setdefault(text, f"v{len(self._lines)}"), self._lines)

    def _with(self, other: Any, sign: str, swapped: bool = False) -> Symbol:
        text = other.name if isinstance(other, Symbol) else f"({other!r})"
        first, second = (text, self.name) if swapped else (self.name, text)
        return self._write(f"{first} {sign} {second}")

    def __add__(self, other: Any) -> Symbol:
        return self._with(other, "+")

    def __radd__(self, other: Any) -> Symbol:
        return self._with(other, "+", True)

    def __sub__(self, other: Any) -> Symbol:
        return self._with(other, "-")

    def __rsub__(self, other: Any) -> Symbol:
        return self._with(other, "-", True)

    def __mul__(self, other: Any) -> Symbol:
        return self._with(other, "*")

    def __rmul__(self, other: Any) -> Symbol:
        return self._with(other, "*", True)

    def called(self, function: str) -> Symbol:
        """A function of this value."""
        return self._write(f"{function}({self.name})")


STATE = ("a", "b", "c", "x", "y", "z", "s")


def source(scene: Scene, form: Separatrix | None = None) -> tuple[list[tuple[str, str]], list[str]]:
    """Return the steps, as (name, text), from t and the names in `STATE` to the seven derivatives, and their names.

    With a `form` the first three of the state are its variables instead of the rates.
    """
    lines: dict[str, str] = {}
    state = [Symbol(name, lines) for name in STATE]
    write = derivatives if form is None else form.derivatives
    found = write(scene, Symbol("t", lines), state, lambda v: v.called("cos"), lambda v: v.called("sin"))
    names = [value.name if isinstance(value, Symbol) else repr(float(value)) for value in found]
    used, kept = set(names), []
    for text, name in reversed(lines.items()):   # unused names are left out
        if name in used:
            kept.append((name, text))
            used.update(re.findall(r"\bv\d+\b", text))
    return kept[::-1], names


def for_numba(scene: Scene, arguments: str) -> Any:
    """Return a function of these arguments, which fills f from t and u, in words that Numba compiles."""
    steps, names = source(scene)
    lines = [f"{name} = u[{i}]" for i, name in enumerate(STATE)] + [f"{name} = {text}" for name, text in steps]
    lines += [f"f[{i}] = {name}" for i, name in enumerate(names)]
    space: dict[str, Any] = {"cos": math.cos, "sin": math.sin}
    exec(f"def function({arguments}):\n " + "\n ".join(lines), space)   # made of floats and the names above alone
    return space["function"]


def in_floats(scene: Scene) -> Callable[[float, Any], list[float]]:
    """Return f(t, y) -> list, compiled by Python from `source`: thirty times faster than with arrays of three."""
    steps, names = source(scene)
    body = "\n ".join(f"{name} = {text}" for name, text in steps)
    text = f"def f(t, state):\n {', '.join(STATE)} = state.tolist()\n {body}\n return [{', '.join(names)}]\n"
    space: dict[str, Any] = {"cos": math.cos, "sin": math.sin}
    exec(text, space)   # made of floats and the names above alone
    function: Callable[[float, Any], list[float]] = space["f"]
    return function
