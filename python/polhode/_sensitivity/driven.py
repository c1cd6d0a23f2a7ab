"""Derivatives of the motion of a scene, with torques and rotors."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from .. import _core
from .._attitude.arrays import is_one_of
from .._core import InvalidInput
from .._orbit.sunlight import Sunlit
from .._scene.scene import Scene
from .sensitivity import Sensitivity, to_names


def differentiate(scene: Scene, names: str | Sequence[str], accuracy: float, side: str = "space",
                  max_steps: int = 10_000_000, certify: bool = True, body: int = 0) -> Sensitivity:
    """Return the motion of a scene and its derivatives at the scene's times.

    A free body has closed forms. Any other body has its variational equations integrated.
    """
    groups = check_groups(names, side)
    refuse_light(scene, groups)
    made = _core.sensitivity(scene, groups, accuracy, certify, side, max_steps, body=body)
    return Sensitivity(made.omega, made.attitude, made.d_omega, made.d_attitude, tuple(made.columns), side, made.error,
                       split_states(scene, made.d_states), made.uncertain)


def refuse_light(scene: Scene, groups: list[str]) -> None:
    """Refuse columns by windows that follow from an orbit."""
    for i, torque in enumerate(scene.torques):
        if isinstance(torque, Sunlit) and f"torques.{i}.windows" in groups:
            raise InvalidInput(f"sensitivity: must not be by 'torques.{i}.windows': the windows of torques.{i} follow "
                               "from its orbit")


def check_groups(names: str | Sequence[str], side: str) -> list[str]:
    """Return the names of groups, and check the side of small rotations."""
    if not is_one_of(side, ("space", "body")):
        raise InvalidInput(f"side: must be 'space' or 'body', got {side!r}")
    groups = to_names(names) if isinstance(names, (str, Sequence)) and names else ()
    if not groups or not all(isinstance(name, str) for name in groups):
        raise InvalidInput("sensitivity: must be names such as 'omega', 'inertia' or 'torques.0.weight', "
                           f"got {names!r}")
    return list(groups)


def split_states(scene: Scene, d_states: npt.NDArray[np.float64]) -> dict[str, npt.NDArray[np.float64]]:
    """Divide derivatives (..., numbers, columns) among the states of a scene's formulas, by name."""
    parts, first = {}, 0
    for name, start in scene.states.items():
        width = np.size(start)
        part = d_states[..., first : first + width, :]
        parts[name] = part if np.ndim(start) else part[..., 0, :]
        first += width
    return parts
