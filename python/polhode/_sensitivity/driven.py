"""Derivatives of the motion of a scene, with torques and rotors."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .. import _core
from .._attitude.arrays import is_one_of
from .._core import InvalidInput
from .._scene.scene import Scene
from .sensitivity import Sensitivity, to_names

CLOSED = {"omega", "attitude", "inertia", "axes"}


def differentiate(scene: Scene, names: str | Sequence[str], accuracy: float, side: str = "space",
                  max_steps: int = 10_000_000, certify: bool = True) -> Sensitivity:
    """Return the motion of a scene and its derivatives at the scene's times.

    A free body has closed forms. Any other body has its variational equations integrated.
    """
    if not is_one_of(side, ("space", "body")):
        raise InvalidInput(f"side: must be 'space' or 'body', got {side!r}")
    groups = to_names(names) if isinstance(names, (str, Sequence)) and names else ()
    if not groups or not all(isinstance(name, str) for name in groups):
        raise InvalidInput("sensitivity: must be names such as 'omega', 'inertia' or 'torques.0.weight', "
                           f"got {names!r}")
    if not scene.torques and not scene.rotors and set(groups) <= CLOSED:
        body = _core.FreeMotion(scene.inertia, scene.omega, scene.attitude)
        found: Sensitivity = body.sensitivity(scene.times - scene.t0, groups, side)
        return found
    made = _core.sensitivity(scene, list(groups), accuracy, certify, side, max_steps)
    d_states, first = {}, 0
    for name, start in scene.states.items():
        width = np.size(start)
        part = made.d_states[:, first : first + width]
        d_states[name] = part if np.ndim(start) else part[:, 0]
        first += width
    return Sensitivity(made.omega, made.attitude, made.d_omega, made.d_attitude, tuple(made.columns), side, made.error,
                       d_states)
