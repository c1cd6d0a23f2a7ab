"""The residuals of a free body and their derivatives, as functions of the parameters of a fit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from .._core import FreeMotion, InertiaTensor
from . import rotations
from .rotations import Array

if TYPE_CHECKING:
    from ..measured import Measurement

GROUPS = {"attitude": ("attitude_x", "attitude_y", "attitude_z"), "omega": ("omega_x", "omega_y", "omega_z"),
          "inertia": ("log_p1_p3", "log_p2_p3"), "axes": ("axes_x", "axes_y", "axes_z")}


class State:
    """The parameters of a free body: start attitude, omega(0) and two ratios of second moments, and the axes.

    The second moments P of mass give the moments J = (P2 + P3, P3 + P1, P1 + P2), P3 = 1. Any two numbers log(P1 / P3)
    and log(P2 / P3) are those of a body that exists. The scale of J does not change a free motion.
    """

    free = True    # no torques, no rotors

    def __init__(self, attitude: Array, omega: Array, ratios: Array, axes: Array, bias: Array) -> None:
        self.attitude, self.omega, self.ratios, self.axes, self.bias = attitude, omega, ratios, axes, bias

    @property
    def moments(self) -> Array:
        """Principal moments, P3 = 1."""
        a, b = np.exp(np.clip(self.ratios, -80, 80))
        return np.array([b + 1, a + 1, a + b])

    def displaced(self, step: Array, slices: dict[str, slice]) -> State:
        """Return the state after a step of the parameters; small rotations are applied on the left."""
        def part(name: str, width: int) -> Array:
            return step[slices[name]] if name in slices else np.zeros(width)

        def displaced(q: Array, vector: Array) -> Array:
            if not vector.any():
                return q
            new = rotations.product(rotations.exp(vector), q)
            out: Array = new / np.linalg.norm(new)
            return out

        return State(displaced(self.attitude, part("attitude", 3)), self.omega + part("omega", 3),
                     np.clip(self.ratios + part("inertia", 2), -30, 30), displaced(self.axes, part("axes", 3)),
                     self.bias + part("bias", self.bias.size))

    def values(self) -> dict[str, Array]:
        """Return the parameters as numbers, by group."""
        return {"attitude": rotations.log(self.attitude), "omega": self.omega, "inertia": self.ratios,
                "axes": rotations.log(self.axes), "bias": self.bias}

    def motion(self) -> FreeMotion:
        """The motion in principal axes."""
        inertia = InertiaTensor.from_moments(self.moments, physical=False)
        if not self.oblique:
            return FreeMotion(inertia, self.omega, self.attitude)
        back = rotations.conjugate(self.axes)
        attitude = rotations.product(self.attitude, self.axes)
        return FreeMotion(inertia, rotations.rotate(back, self.omega), attitude / np.linalg.norm(attitude))

    @property
    def oblique(self) -> bool:
        """Whether the given axes are not principal."""
        return bool(self.axes[:3].any())

    def to_body(self, omega: Array, attitude: Array) -> tuple[Array, Array]:
        """Return states in the given axes from those in principal axes."""
        if not self.oblique:
            return omega, attitude
        return rotations.rotate(self.axes, omega), rotations.product(attitude, rotations.conjugate(self.axes))


def ratios_of(moments: Array, least: float = 1e-9) -> Array:
    """Return log(P1 / P3) and log(P2 / P3), the second moments kept above `least` of the largest."""
    P = 0.5 * moments.sum() - moments
    P = np.maximum(P, least * P.max())
    out: Array = np.log(P[:2] / P[2])
    return out


def own_names(data: Sequence[Measurement]) -> list[str]:
    """Return the names of the parameters of the sensors, with the sensor's number where several have the same."""
    stems = [measurement.own for measurement in data if measurement.own]
    every = [name for names in stems for name in names]
    if len(set(every)) == len(every):
        return every
    out = []
    for k, names in enumerate(stems):
        for name in names:
            stem, part = name.rsplit("_", 1)
            out.append(f"{stem}_{k}_{part}")
    return out


class Problem:
    """Residuals over sigma of all measurements, and their Jacobian, for `groups` of a state's parameters.

    Attributes
    ----------
    names : tuple of str
        The parameters.
    base : State
        Where the parameters of `fun` and `jac` start: attitude and axes are small rotations from it.
    """

    def __init__(self, data: Sequence[Measurement], groups: Sequence[str], base: State,
                 known: Mapping[str, Sequence[str]] = GROUPS) -> None:
        self.data, self.groups, self.base = list(data), tuple(groups), base
        self.slices: dict[str, slice] = {}
        names: list[str] = []
        for group in self.groups:
            self.slices[group] = slice(len(names), len(names) + len(known[group]))
            names += known[group]
        own = own_names(self.data)
        if own:
            self.slices["bias"] = slice(len(names), len(names) + len(own))
            names += own
        self.names = tuple(names)
        times = [measurement.t for measurement in self.data]
        self.ends = np.cumsum([0, *(len(t) for t in times)])
        self.t = np.concatenate(times) if times else np.zeros(0)
        wanted = {"omega", *(["inertia"] if "inertia" in groups else []), *(["axes"] if "axes" in groups else [])}
        self.wrt = tuple(sorted(wanted))

    def _each(self, state: State, omega: Array, attitude: Array) -> list[Array]:
        parts, bias = [], 0
        for k, measurement in enumerate(self.data):
            here = slice(self.ends[k], self.ends[k + 1])
            own = state.bias[bias : bias + measurement.bias]
            seen = self.with_acceleration(state, omega[here]) if measurement.accelerates else omega[here]
            parts.append(measurement.whiten(measurement.residual(seen, attitude[here], own)).ravel())
            bias += measurement.bias
        return parts

    def with_acceleration(self, state: State, omega: Array) -> Array:
        """Return omega and the angular acceleration of Euler's equations, (n, 6)."""
        J = state.moments
        return np.concatenate([omega, np.cross(J * omega, omega) / J], axis=1)

    def _with_its_derivatives(self, state: State, omega: Array, d_omega: Array) -> Array:
        """Return the derivatives of both, (n, 6, k)."""
        J = state.moments
        d_momentum = J[:, None] * d_omega
        if "inertia" in self.slices:
            a, b = np.exp(np.clip(state.ratios, -80, 80))
            d_moments = np.array([[0, b], [a, 0], [a, b]])
            d_momentum[..., self.slices["inertia"]] += omega[:, :, None] * d_moments
        d_alpha = (np.cross(d_momentum, omega[:, :, None], axis=1)
                   + np.cross((J * omega)[:, :, None], d_omega, axis=1))
        if "inertia" in self.slices:
            alpha = np.cross(J * omega, omega) / J
            d_alpha[..., self.slices["inertia"]] -= alpha[:, :, None] * d_moments
        return np.concatenate([d_omega, d_alpha / J[:, None]], axis=1)

    def residuals(self, state: State) -> Array:
        """Residuals over sigma."""
        return np.concatenate(self._each(state, *state.to_body(*state.motion().at(self.t))))

    def columns(self, state: State) -> tuple[Array, Array, Array, Array]:
        """(omega, attitude, d omega, d theta) of the parameters of the motion, small rotations in space axes."""
        s = state.motion().sensitivity(self.t, self.wrt)
        E = rotations.to_matrix(state.axes)
        n, width = self.t.size, len(self.names)
        d_omega, d_attitude = np.zeros((n, 3, width)), np.zeros((n, 3, width))

        def put(group: str, transform: Array) -> None:
            first = 3 * self.wrt.index(group)
            part = s.d_omega[..., first : first + 3] @ transform
            d_omega[..., self.slices[group]] = E @ part if state.oblique else part
            d_attitude[..., self.slices[group]] = s.d_attitude[..., first : first + 3] @ transform

        if "attitude" in self.slices:
            d_attitude[..., self.slices["attitude"]] = np.eye(3)
        if "omega" in self.slices:
            put("omega", E.T)
        if "inertia" in self.slices:
            a, b = np.exp(np.clip(state.ratios, -80, 80))
            put("inertia", np.array([[0, b], [a, 0], [a, b]]))
        if "axes" in self.slices:
            put("axes", E.T)
        return *state.to_body(s.omega, s.attitude), d_omega, d_attitude

    def residuals_and_jacobian(self, state: State) -> tuple[Array, Array]:
        """Residuals over sigma, and their derivatives by a step of the parameters."""
        omega, attitude, d_omega, d_attitude = self.columns(state)
        rows, bias, first = [], 0, self.slices["bias"].start if "bias" in self.slices else 0
        for k, measurement in enumerate(self.data):
            here = slice(self.ends[k], self.ends[k + 1])
            seen, d_seen = omega[here], d_omega[here]
            if measurement.accelerates:
                seen, d_seen = self.with_acceleration(state, seen), self._with_its_derivatives(state, seen, d_seen)
            own = state.bias[bias : bias + measurement.bias]
            part = measurement.rows(seen, attitude[here], d_seen, d_attitude[here], own)
            if measurement.bias:
                part = part.copy()
                part[:, :, first + bias : first + bias + measurement.bias] = measurement.own_rows(seen)
                bias += measurement.bias
            rows.append(measurement.whiten(part).reshape(-1, len(self.names)))
        return np.concatenate(self._each(state, omega, attitude)), np.concatenate(rows)

    def fun(self, x: Array) -> Array:
        """Residuals at a step `x` from the base, for SciPy's `least_squares`."""
        return self.residuals(self.base.displaced(np.asarray(x, dtype=float), self.slices))

    def jac(self, x: Array) -> Array:
        """The derivative of `fun`."""
        x = np.asarray(x, dtype=float)
        _, jacobian = self.residuals_and_jacobian(self.base.displaced(x, self.slices))
        for group in ("attitude", "axes"):   # a step of the rotation vector rotates by its left Jacobian
            if group in self.slices:
                here = self.slices[group]
                jacobian[:, here] = jacobian[:, here] @ np.linalg.inv(rotations.inverse_right_jacobian(x[here]).T)
        return jacobian

    def with_data(self, data: Sequence[Measurement], base: State | None = None) -> Problem:
        """Return the same problem with other samples, or from another state."""
        return Problem(data, self.groups, self.base if base is None else base)
