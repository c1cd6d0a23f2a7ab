"""The residuals of a body with torques and their derivatives, as functions of the parameters of a fit."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from .. import _core
from .._core import InertiaTensor
from .._scene.scene import Scene
from . import rotations
from .driven import differentiate
from .parameters import get, names_of, put
from .problem import Problem, State
from .rotations import Array

if TYPE_CHECKING:
    from ..measured import Measurement

ACCURACY = 1e-11   # of motion and columns: directions that are not observable have singular values of this size
SECONDS = ("log_p1", "log_p2", "log_p3")


class DrivenState(State):
    """The parameters of a body in a scene.

    The start, the logarithms of the second moments of mass about the principal axes, and numbers of torques and rotors
    by their groups. The scale of J counts here: torques do not grow with it.
    """

    free = False

    def __init__(self, scene: Scene, attitude: Array, omega: Array, seconds: Array, numbers: dict[str, Array],
                 bias: Array) -> None:
        super().__init__(attitude, omega, seconds[:2] - seconds[2], np.array([0.0, 0, 0, 1]), bias)
        self.scene, self.seconds, self.numbers = scene, seconds, numbers
        self.most_steps = 10_000_000   # of one run: a trial far from the data may be stiff

    @classmethod
    def of(cls, scene: Scene, groups: Sequence[str], bias: Array) -> DrivenState:
        """Return the state that a scene has."""
        moments = principal(scene)[0]
        P = np.maximum(0.5 * moments.sum() - moments, 1e-9 * moments.max())
        numbers = {group: get(scene, group) for group in groups if "." in group}
        return cls(scene, np.asarray(scene.attitude), np.asarray(scene.omega, dtype=float), np.log(P), numbers, bias)

    @property
    def moments(self) -> Array:
        """Principal moments, in the order of the columns of 'inertia' [kg m^2]."""
        P = np.exp(self.seconds)
        out: Array = P.sum() - P
        return out

    def values(self) -> dict[str, Array]:
        """Return the parameters as numbers, by group."""
        return {"attitude": rotations.log(self.attitude), "omega": self.omega, "inertia": self.seconds, **self.numbers,
                "bias": self.bias}

    def displaced(self, step: Array, slices: dict[str, slice]) -> DrivenState:
        """Return the state after a step of the parameters; the small rotation of the start is applied on the left."""
        attitude, omega, seconds, bias = self.attitude, self.omega, self.seconds, self.bias
        numbers = dict(self.numbers)
        for group, here in slices.items():
            if group == "attitude":
                attitude = rotations.product(rotations.exp(step[here]), attitude)
                attitude = attitude / np.linalg.norm(attitude)
            elif group == "omega":
                omega = omega + step[here]
            elif group == "inertia":
                seconds = seconds + np.clip(step[here], -5, 5)
            elif group == "bias":
                bias = bias + step[here]
            else:
                numbers[group] = numbers[group] + step[here]
        other = DrivenState(self.scene, attitude, omega, seconds, numbers, bias)
        other.most_steps = self.most_steps
        return other

    def limit_steps(self, times: Array) -> None:
        """Allow twenty times the steps that this state takes."""
        scene = self.make_scene(np.unique(times), False)
        made = _core.sensitivity(scene, ["omega"], ACCURACY, False, "space", self.most_steps)
        self.most_steps = 1000 + 20 * made.steps

    def make_scene(self, times: Array, inertia: bool) -> Scene:
        """Return the scene with these parameters. `inertia`: the moments are among them."""
        scene = self.scene
        for group, value in self.numbers.items():
            scene = put(scene, group, value)
        changes = {"omega": self.omega, "attitude": self.attitude, "times": times, "want": ("omega", "attitude")}
        if inertia:
            _, E = principal(scene)
            tensor = E @ np.diag(self.moments) @ E.T
            changes["inertia"] = self.moments if (E == np.eye(3)).all() else InertiaTensor(tensor, physical=False)
        return scene.replace(**changes)


def principal(scene: Scene) -> tuple[Array, Array]:
    """Return principal moments and axes: the given ones where the axes are principal, else ascending."""
    matrix = np.asarray(scene.inertia.matrix)
    if not (matrix - np.diag(np.diag(matrix))).any():
        return np.diag(matrix).copy(), np.eye(3)
    found = scene.inertia.principal()
    return np.asarray(found.moments), np.asarray(found.axes)


class DrivenProblem(Problem):
    """Residuals over sigma of all measurements for `groups` of the numbers of a scene, and their Jacobian."""

    base: DrivenState

    def __init__(self, data: Sequence[Measurement], groups: Sequence[str], base: DrivenState) -> None:
        wide = {"attitude": [f"attitude_{c}" for c in "xyz"], "omega": [f"omega_{c}" for c in "xyz"],
                "inertia": list(SECONDS)}
        for group in base.numbers:
            wide[group] = names_of(base.scene, group)
        super().__init__(data, groups, base, wide)

    def _motion(self, state: State, names: Sequence[str]) -> tuple[Array, Array, Array, Array]:
        """(omega, attitude, d omega, d theta) at the times, which may repeat and have any order."""
        assert isinstance(state, DrivenState)
        times, back = np.unique(self.t, return_inverse=True)
        s = differentiate(state.make_scene(times, "inertia" in self.slices), names, ACCURACY,
                          max_steps=state.most_steps, certify=False)
        return s.omega[back], s.attitude[back], s.d_omega[back], s.d_attitude[back]

    def residuals(self, state: State) -> Array:
        """Residuals over sigma."""
        omega, attitude, _, _ = self._motion(state, ["omega"])
        return np.concatenate(self._each(state, omega, attitude))

    def columns(self, state: State) -> tuple[Array, Array, Array, Array]:
        """(omega, attitude, d omega, d theta) of the parameters of the motion, small rotations in space axes."""
        wanted = [group for group in self.groups]
        omega, attitude, dw, dq = self._motion(state, wanted)
        n = self.t.size
        d_omega, d_attitude = np.zeros((n, 3, len(self.names))), np.zeros((n, 3, len(self.names)))
        first = 0
        for group in wanted:
            here = self.slices[group]
            width = here.stop - here.start
            a, b = dw[..., first : first + width], dq[..., first : first + width]
            if group == "inertia":   # J = sum(P) - P
                P = np.exp(state.seconds)   # type: ignore[attr-defined]
                chain = (1 - np.eye(3)) * P
                a, b = a @ chain, b @ chain
            d_omega[..., here], d_attitude[..., here] = a, b
            first += width
        return omega, attitude, d_omega, d_attitude

    def with_data(self, data: Sequence[Measurement], base: State | None = None) -> DrivenProblem:
        """Return the same problem with other samples, or from another state."""
        other = self.base if base is None else base
        assert isinstance(other, DrivenState)
        return DrivenProblem(data, self.groups, other)
